#include "status.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace montelux::cli {

namespace {

void say(std::string_view kind, std::string_view colour, std::string_view message) {
  if (color_on_stderr())
    fmt::print(stderr, "montelux: \x1b[1;{}m{}:\x1b[0m {}\n", colour, kind, message);
  else
    fmt::print(stderr, "montelux: {}: {}\n", kind, message);
}

}  // namespace

bool terminal_on_stderr() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) && !(term && std::string_view(term) == "dumb");
}

bool color_on_stderr() {
  const char* refused = std::getenv("NO_COLOR");
  return terminal_on_stderr() && !(refused && *refused);
}

int complain(std::string_view message) {
  say("error", "31", message);
  return bad_input;
}

void warn(std::string_view message) { say("warning", "33", message); }

void print_diagnostics(const Diagnostics& diagnostics, bool quiet) {
  for (const Diagnostic& diagnostic : diagnostics.all())
    if (!quiet || diagnostic.severity == Severity::error)
      fmt::print(stderr, "{}", to_text(diagnostic, color_on_stderr()));
}

}  // namespace montelux::cli
