// Exit statuses, and messages to the user on standard error.
#pragma once
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "api/scene.h"

namespace montelux::cli {

// The program's exit statuses. After a signal it is 128 plus the signal number: 129 (SIGHUP), 130 (SIGINT), 141
// (SIGPIPE, or results to a closed pipe), 143 (SIGTERM).
inline constexpr int done = 0;
inline constexpr int differs = 1;    // diff found a difference; with --strict, the result of an integral has warnings
inline constexpr int bad_input = 2;  // invalid options, scenes or images
inline constexpr int failed = 3;     // unexpected failures: a full disk, out of memory, an internal error

// Standard error is a terminal with cursor movement.
bool terminal_on_stderr();
// Colour is enabled on standard error: a terminal, and no NO_COLOR in the environment (no-color.org).
bool color_on_stderr();

// Writes text to standard error unchanged. A failure to write is ignored: nothing depends on it.
void print_log(std::string_view text);
// Prints "montelux: error: message" and returns the status, so that a verb can return it.
int complain(std::string_view message, int status = bad_input);
// Of several mistakes.
int complain_of_all(const std::vector<std::string>& mistakes);
void warn(std::string_view message);

// Flushes standard output. Throws std::system_error if that fails, as printing itself does.
void flush_results();
// The exit status when results could not be written: failed, with a message, or quietly 128 + SIGPIPE if
// nobody reads them any more.
int results_lost(const std::error_code& reason);

// Prints the diagnostics of loading on standard error; quiet: only errors.
void print_diagnostics(const Diagnostics& diagnostics, bool quiet);

}  // namespace montelux::cli
