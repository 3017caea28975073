// What the fuzzer feeds to Montelux: for each kind of input, undamaged examples and a run that must end well.
#pragma once
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace montelux::fuzz {

// A rule that a run has broken. Anything else that a run throws is a finding, too.
struct Finding : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Kind {
  std::string_view name, what;
  // Undamaged inputs, made in this folder, which is the run's own; other files that they name are left there.
  std::vector<std::string> (*examples)(const std::filesystem::path& folder);
  // Reads the input and does a little with what came of it. Throws where a rule is broken.
  void (*run)(const std::string& input, const std::filesystem::path& folder);
};

std::span<const Kind> kinds();
// Null for an unknown name.
const Kind* kind_named(std::string_view name);

}  // namespace montelux::fuzz
