// Exit statuses, and words to the user on standard error.
#pragma once
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "api/scene.h"

namespace montelux::cli {

// What the program returns. What a signal ends returns 128 plus its number: 129 (SIGHUP), 130 (SIGINT), 141 (SIGPIPE,
// and results to a pipe that nobody reads), 143 (SIGTERM).
inline constexpr int done = 0;
inline constexpr int differs = 1;    // diff found a difference; with --strict, the result of an integral has warnings
inline constexpr int bad_input = 2;  // options, scenes or pictures that cannot be used
inline constexpr int failed = 3;     // what should not happen: a full disk, memory, an error of the program

// Standard error is a terminal that moves its cursor.
bool terminal_on_stderr();
// Colour is wanted on standard error: a terminal, and no NO_COLOR in the environment (no-color.org).
bool color_on_stderr();

// Text on standard error, as it is. That it cannot be written there is no error: nothing depends on it.
void print_log(std::string_view text);
// "montelux: error: message" and returns the status, so that a verb can return it.
int complain(std::string_view message, int status = bad_input);
// Of several mistakes.
int complain_of_all(const std::vector<std::string>& mistakes);
void warn(std::string_view message);

// Writes out what was printed on standard output. Throws std::system_error where that fails, as printing itself does.
void flush_results();
// What the program returns when results could not be written: failed with a message, or quietly 128 + SIGPIPE where
// nobody reads them any more.
int results_lost(const std::error_code& reason);

// Diagnostics of loading, on standard error; quiet leaves only errors.
void print_diagnostics(const Diagnostics& diagnostics, bool quiet);

}  // namespace montelux::cli
