// What is wrong with a user's input, and where.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace montelux {

// A place in a file: line and column count from 1; line 0 means the file as a whole. No file: not from a file.
struct SourceLocation {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;
};

enum class Severity { note, warning, error };

// How many diagnostics of one kind are stated in one line.
struct DiagnosticGroup {
  std::string summary;     // with {n} for their number and {sum} for the sum of their amounts; empty: the message
  std::size_t amount = 1;  // what the message counts
};

struct Diagnostic {
  Severity severity = Severity::error;
  SourceLocation where;
  std::string message;      // what was found and what is valid, one sentence, no full stop needed
  std::string hint;         // the nearest valid name, or what to do; may be empty
  DiagnosticGroup group{};  // of warnings and notes
};

// All that was found in one run. A stage adds to it and goes on as far as it can.
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

// The same, with one line for all warnings, or notes, that share their summary (or without one: message and hint). It
// stands where the first of them stood. Errors stay as they are.
Diagnostics grouped(const Diagnostics& diagnostics);

// The candidate nearest to `name` by edit distance; empty where none is near enough to be meant.
std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& candidates);
// " (did you mean "path"?)", or nothing where no name is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates);

}  // namespace montelux
