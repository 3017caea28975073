#include "integrator/distribution/settings.h"

#include <fmt/format.h>

#include <charconv>

namespace montelux {

namespace {

// "16/4/1": whole numbers from `low` to 4096.
Result<std::vector<int>> read_counts(std::string_view name, const std::string& text, int low) {
  const auto wrong = [&] {
    return Failure{
        fmt::format("{} takes whole numbers from {} to 4096 by depth, as 16/4/1; found \"{}\"", name, low, text)};
  };
  std::vector<int> counts;
  const char *at = text.data(), *end = at + text.size();
  for (;;) {
    int value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || value < low || value > 4096) return wrong();
    counts.push_back(value);
    if (next == end) return counts;
    if (*next != '/' || counts.size() == 64) return wrong();
    at = next + 1;
  }
}

}  // namespace

EntitySpec distribution_spec() {
  using enum ParameterType;
  return {"distribution",
          "distribution ray tracing: many secondary rays at each surface",
          {{"branching", {string}, "secondary rays at the 1st/2nd/... surface; default 8/4/1"},
           {"shadow-rays", {string}, "shadow rays at the 1st/2nd/... surface; default 4/2/1"},
           {"maxdepth", {integer}, "most bounces; default: none", 0, 2147483647, {"none"}}}};
}

Result<DistributionSettings> distribution_settings(const ParameterList& list, std::optional<int> max_depth) {
  DistributionSettings s;
  s.max_depth = max_depth;
  auto branching = read_counts("branching", list.string("branching", "8/4/1"), 1);
  if (!branching) return branching.failure();
  auto shadow_rays = read_counts("shadow-rays", list.string("shadow-rays", "4/2/1"), 0);
  if (!shadow_rays) return shadow_rays.failure();
  s.branching = *branching, s.shadow_rays = *shadow_rays;
  if (s.branching.back() > 1 && !s.max_depth)
    return Failure{fmt::format("branching {} never ends: its last number must be 1, or maxdepth must be set",
                               list.string("branching", ""))};
  return s;
}

}  // namespace montelux
