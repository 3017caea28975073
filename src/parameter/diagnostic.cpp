#include "parameter/diagnostic.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace montelux {

void Diagnostics::add(Diagnostic diagnostic) {
  if (diagnostic.severity == Severity::error) ++errors_;
  all_.push_back(std::move(diagnostic));
}
void Diagnostics::error(const SourceLocation& where, std::string message, std::string hint) {
  add({Severity::error, where, std::move(message), std::move(hint)});
}
void Diagnostics::warning(const SourceLocation& where, std::string message, std::string hint) {
  add({Severity::warning, where, std::move(message), std::move(hint)});
}
void Diagnostics::note(const SourceLocation& where, std::string message, std::string hint) {
  add({Severity::note, where, std::move(message), std::move(hint)});
}

namespace {

// The text with its placeholder replaced, where it has one.
std::string with(std::string text, std::string_view placeholder, std::size_t number) {
  const std::size_t at = text.find(placeholder);
  return at == std::string::npos ? text : text.replace(at, placeholder.size(), std::to_string(number));
}

struct Group {
  std::size_t place = 0;  // of the first
  std::size_t count = 0, sum = 0;
};

std::string message_of(const Diagnostic& first, const Group& group) {
  if (group.count == 1) return first.message;
  if (first.group.summary.empty()) return first.message + " (" + std::to_string(group.count) + " times; here first)";
  return with(with(first.group.summary, "{n}", group.count), "{sum}", group.sum) + "; here first";
}

}  // namespace

Diagnostics grouped(const Diagnostics& diagnostics) {
  std::vector<Diagnostic> list;
  std::map<std::pair<Severity, std::string>, Group> groups;
  for (const Diagnostic& d : diagnostics.all()) {
    if (d.severity != Severity::error) {
      const std::string kind = d.group.summary.empty() ? d.message + '\n' + d.hint : d.group.summary;
      auto [entry, is_new] = groups.try_emplace({d.severity, kind}, Group{list.size()});
      ++entry->second.count, entry->second.sum += d.group.amount;
      if (!is_new) continue;
    }
    list.push_back(d);
  }
  for (const auto& [kind, group] : groups) list[group.place].message = message_of(list[group.place], group);
  Diagnostics result;
  for (Diagnostic& d : list) result.add(std::move(d));
  return result;
}

namespace {

// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      std::size_t substitution = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& candidates) {
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 2) + 1;
  for (std::string_view candidate : candidates) {
    std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance) best = candidate, best_distance = distance;
  }
  return best;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates) {
  const std::string_view near = nearest_name(name, candidates);
  return near.empty() ? "" : " (did you mean \"" + std::string(near) + "\"?)";
}

}  // namespace montelux
