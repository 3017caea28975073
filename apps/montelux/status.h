// Exit statuses, and words to the user on standard error.
#pragma once
#include <string_view>

#include "api/scene.h"

namespace montelux::cli {

// What the program returns. Interrupted renders return 128 plus the signal's number: 130 (SIGINT), 143 (SIGTERM).
inline constexpr int done = 0;
inline constexpr int differs = 1;    // diff found a difference
inline constexpr int bad_input = 2;  // options, scenes or pictures that cannot be used
inline constexpr int failed = 3;     // what should not happen: a full disk, memory, an error of the program

// Standard error is a terminal that moves its cursor.
bool terminal_on_stderr();
// Colour is wanted on standard error: a terminal, and no NO_COLOR in the environment (no-color.org).
bool color_on_stderr();

// "montelux: error: message" and returns bad_input, so that a verb can return it.
int complain(std::string_view message);
void warn(std::string_view message);

// Diagnostics of loading, on standard error; quiet leaves only errors.
void print_diagnostics(const Diagnostics& diagnostics, bool quiet);

}  // namespace montelux::cli
