// What is wrong with the user's input, and where.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace montelux {

// A position in a file: line and column count from 1; line 0 is the file as a whole. No file: not from a file.
struct SourceLocation {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;
};

enum class Severity { note, warning, error };

// How many diagnostics of one kind are combined into one line.
struct DiagnosticGroup {
  std::string summary;     // with {n} for their number and {sum} for the sum of their amounts; empty: the message
  std::size_t amount = 1;  // what the message counts
};

struct Diagnostic {
  Severity severity = Severity::error;
  SourceLocation where;
  std::string message;      // what was found and what is valid, one sentence without a final full stop
  std::string hint;         // the closest valid name, or what to do; may be empty
  DiagnosticGroup group{};  // of warnings and notes
};

// All diagnostics of one run. A stage adds its own and continues as far as possible.
class Diagnostics {
 public:
  void error(const SourceLocation& where, std::string message, std::string hint = {});
  void warning(const SourceLocation& where, std::string message, std::string hint = {});
  void note(const SourceLocation& where, std::string message, std::string hint = {});
  void add(Diagnostic diagnostic);

  bool has_errors() const { return errors_ > 0; }
  int errors() const { return errors_; }
  const std::vector<Diagnostic>& all() const { return all_; }

 private:
  std::vector<Diagnostic> all_;
  int errors_ = 0;
};

// The same, with one line for all warnings, or notes, that have the same summary (or without one: message and hint), at
// the position of the first. Errors are unchanged.
Diagnostics grouped(const Diagnostics& diagnostics);

// The candidate closest to `name` by edit distance; empty if none is close enough.
std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& candidates);
// " (did you mean "path"?)", or an empty text if no name is close.
std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates);

}  // namespace montelux
