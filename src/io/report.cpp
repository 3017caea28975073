#include "io/report.h"

#include <algorithm>
#include <map>
#include <optional>

#include "io/text_file.h"

namespace montelux {

namespace {

// The files from which excerpts are taken, each read once.
class Excerpts {
 public:
  std::optional<std::string_view> line(const SourceLocation& where) {
    if (!where.file || where.line < 1) return std::nullopt;
    auto [entry, is_new] = files_.try_emplace(*where.file);
    if (is_new)
      if (auto text = read_whole_file(*where.file)) entry->second = std::move(*text);
    std::string_view rest = without_byte_order_mark(entry->second);
    for (int i = 1; i < where.line; ++i) {
      std::size_t end = rest.find('\n');
      if (end == std::string_view::npos) return std::nullopt;
      rest.remove_prefix(end + 1);
    }
    if (rest.empty()) return std::nullopt;
    return rest.substr(0, rest.find('\n'));
  }

 private:
  std::map<std::string, std::string> files_;
};

std::string_view name_of(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}
std::string_view colour_of(Severity severity) {
  return severity == Severity::error ? "\x1b[1;31m" : severity == Severity::warning ? "\x1b[1;35m" : "\x1b[1;36m";
}

// The part of a long line around the column, and the column within it.
std::string excerpt_with_caret(std::string_view line, int column) {
  constexpr std::size_t width = 100;
  std::size_t at = std::min<std::size_t>(column > 0 ? std::size_t(column) - 1 : 0, line.size());
  std::size_t start = at > width * 3 / 4 ? at - width / 2 : 0;
  const std::string shown = without_control(line.substr(start, width), ' ');
  std::string before = start > 0 ? "..." : "", after = start + width < line.size() ? "..." : "";
  return "    " + before + shown + after + "\n    " + std::string(before.size() + at - start, ' ') + "^\n";
}

std::string render_one(const Diagnostic& diagnostic, const ReportStyle& style, Excerpts& excerpts) {
  std::string text;
  const SourceLocation& where = diagnostic.where;
  if (where.file) {
    text += *where.file + ":";
    if (where.line > 0) text += std::to_string(where.line) + ":" + std::to_string(where.column) + ":";
    text += " ";
  }
  if (style.colour) text += colour_of(diagnostic.severity);
  text += std::string(name_of(diagnostic.severity)) + ": ";
  if (style.colour) text += "\x1b[0m";
  text += diagnostic.message + "\n";
  if (style.excerpts)
    if (auto line = excerpts.line(where)) text += excerpt_with_caret(*line, where.column);
  if (!diagnostic.hint.empty()) text += "    " + diagnostic.hint + "\n";
  return text;
}

}  // namespace

std::string render(const Diagnostic& diagnostic, const ReportStyle& style) {
  Excerpts excerpts;
  return render_one(diagnostic, style, excerpts);
}

std::string render(const Diagnostics& diagnostics, const ReportStyle& style) {
  Excerpts excerpts;
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics.all()) text += render_one(diagnostic, style, excerpts);
  return text;
}

}  // namespace montelux
