#include "io/reporter.h"

namespace montelux {

void Reporter::add(Diagnostic diagnostic) {
  // All of these are combined into one line.
  if (!diagnostic.group.summary.empty()) return out_->add(std::move(diagnostic));
  std::string file = diagnostic.where.file ? *diagnostic.where.file : std::string();
  Count& count = counts_[{std::move(file), diagnostic.severity}];
  if (count.reported == 0) count.first = diagnostic.where;
  if (count.reported == max_per_file) {
    ++count.left_out;
    return;
  }
  ++count.reported;
  out_->add(std::move(diagnostic));
}

void Reporter::error(const SourceLocation& where, std::string message, std::string hint) {
  add({Severity::error, where, std::move(message), std::move(hint)});
}
void Reporter::warning(const SourceLocation& where, std::string message, std::string hint) {
  add({Severity::warning, where, std::move(message), std::move(hint)});
}
void Reporter::note(const SourceLocation& where, std::string message, std::string hint) {
  add({Severity::note, where, std::move(message), std::move(hint)});
}
void Reporter::tolerable(const SourceLocation& where, std::string message, std::string hint) {
  if (lenient_) {
    const auto [at, is_new] = omission_numbers_.try_emplace(message, omissions_.size());
    if (is_new)
      omissions_.push_back({message, where});
    else
      ++omissions_[at->second].count;
  }
  add({lenient_ ? Severity::warning : Severity::error, where, std::move(message), std::move(hint)});
}

bool Reporter::is_first_at(const SourceLocation& where) {
  return where.line <= 0 || places_.insert({where.file.get(), where.line, where.column}).second;
}

void Reporter::finish() {
  for (const auto& [key, count] : counts_) {
    if (count.left_out == 0) continue;
    std::string_view what = key.second == Severity::error     ? "errors"
                            : key.second == Severity::warning ? "warnings"
                                                              : "notes";
    SourceLocation whole{count.first.file, 0, 0};
    out_->note(whole, "and " + std::to_string(count.left_out) + " more " + std::string(what) + " in this file");
  }
  counts_.clear();
}

}  // namespace montelux
