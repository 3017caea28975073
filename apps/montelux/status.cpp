#include "status.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace montelux::cli {

namespace {

void say(std::string_view kind, std::string_view colour, std::string_view message) {
  print_log(color_on_stderr() ? fmt::format("montelux: \x1b[1;{}m{}:\x1b[0m {}\n", colour, kind, message)
                              : fmt::format("montelux: {}: {}\n", kind, message));
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

void print_log(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

int complain(std::string_view message, int status) {
  say("error", "31", message);
  return status;
}

int complain_of_all(const std::vector<std::string>& mistakes) {
  for (const std::string& mistake : mistakes) complain(mistake);
  return bad_input;
}

void warn(std::string_view message) { say("warning", "33", message); }

void print_diagnostics(const Diagnostics& diagnostics, bool quiet) {
  for (const Diagnostic& diagnostic : diagnostics.all())
    if (!quiet || diagnostic.severity == Severity::error) print_log(to_text(diagnostic, color_on_stderr()));
}

void flush_results() {
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category());
  if (std::ferror(stdout)) throw std::system_error(EIO, std::generic_category());
}

int results_lost(const std::error_code& reason) {
  if (reason == std::errc::broken_pipe) return 128 + SIGPIPE;
  return complain(fmt::format("cannot write the results to standard output: {}", reason.message()), failed);
}

}  // namespace montelux::cli
