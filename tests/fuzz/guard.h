// What ends a run that crashes, hangs or wants all memory: the input is kept under its name, then the process ends.
#pragma once
#include <filesystem>

namespace montelux::fuzz {

// From now on a fatal signal keeps the input of the run. `memory` in bytes, 0 for no limit (a sanitizer needs none).
void guard_process(std::size_t memory);

// A run begins: its input is in `running`, and is renamed `kept` by a fatal signal or after so many seconds of
// processor time (twelve times as many by the clock).
void guard_run(const std::filesystem::path& running, const std::filesystem::path& kept, int seconds);
void end_run();

}  // namespace montelux::fuzz
