// Starts the build of the program for the largest instruction set that this processor has. Only the standard library of
// C++ and the oldest instructions are used here, and the program itself replaces this one.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace {

// Levels of the x86-64 psABI, the largest first, with some of the instructions of each; no processor has these without
// the others.
struct Level {
  const char* name;
  bool is_supported;
};
std::array<Level, 3> levels() {
  __builtin_cpu_init();
  const bool second = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
  const bool third = second && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                     __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  const bool fourth = third && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  return {{{"x86-64-v4", fourth}, {"x86-64-v3", third}, {"x86-64-v2", second}}};
}

int fail(int status, const std::string& message) {
  std::fprintf(stderr, "montelux: error: %s\n", message.c_str());
  return status;
}

std::string listed(const std::vector<Level>& builds) {
  std::string text;
  for (const Level& build : builds) text += (text.empty() ? "" : ", ") + std::string(build.name);
  return text;
}

}  // namespace

int main(int, char** arguments) {
  constexpr int bad_choice = 2, cannot_start = 3;
  std::error_code error;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return fail(cannot_start, "cannot read /proc/self/exe: " + error.message());
  const std::filesystem::path folder = (own.parent_path() / MONTELUX_BUILD_FOLDER).lexically_normal();
  const auto program_of = [&](const char* name) { return folder / name / "bin" / "montelux"; };
  std::vector<Level> builds;
  for (const Level& level : levels())
    if (std::filesystem::exists(program_of(level.name), error)) builds.push_back(level);
  if (builds.empty()) return fail(cannot_start, "no program in " + folder.string());

  auto chosen = std::ranges::find_if(builds, &Level::is_supported);
  if (const char* stated = std::getenv("MONTELUX_INSTRUCTIONS")) {
    chosen = std::ranges::find_if(builds, [&](const Level& build) { return std::strcmp(build.name, stated) == 0; });
    if (chosen == builds.end())
      return fail(bad_choice, "MONTELUX_INSTRUCTIONS: \"" + std::string(stated) + "\" is not one of " + listed(builds));
    if (!chosen->is_supported)
      return fail(bad_choice, "MONTELUX_INSTRUCTIONS: this processor does not have " + std::string(stated));
  }
  if (chosen == builds.end())
    return fail(cannot_start, "this processor has none of the instruction sets " + listed(builds));
  const std::filesystem::path program = program_of(chosen->name);
  execv(program.c_str(), arguments);
  return fail(cannot_start, "cannot start " + program.string() + ": " + std::strerror(errno));
}
