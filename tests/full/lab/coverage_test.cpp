// The coverage of every method on every family in 2, 5 and 10 dimensions.
#include <gtest/gtest.h>

#include <cstdio>

#include "integral_coverage.h"
#include "statistics.h"

namespace montelux::test {
namespace {

constexpr int runs = 500;
constexpr std::uint64_t samples = 1u << 14;

// The corner peak's spike is missed by sampling that does not adapt to it: the passes are then skewed, and intervals
// too short. docs/integration.md has the figures.
bool known_to_fail(GenzFamily family, std::string_view method) {
  const bool adapts = method == "qmc:adapt=true" || method == "vegas" || method == "auto";
  return family == GenzFamily::corner_peak && !adapts;
}

TEST(Coverage, of_nominal_95_percent_is_93_to_97_percent) {
  const double tests = double(covered_methods.size() * genz_families.size() * 3);
  for (std::string_view method : covered_methods)
    for (GenzFamily family : genz_families)
      for (std::size_t dimension : {2, 5, 10}) {
        const Genz g = Genz::make(family, dimension, 1);
        const Coverage c = coverage_of(genz_problem(g), g.integral(), method, samples, runs);
        std::printf("%-32s %-14s %2zu %.3f\n", method.data(), name_of(family).data(), dimension, c.share());
        if (known_to_fail(family, method)) continue;
        // Outside of 93 to 97 percent by more than the chance of 500 runs explains.
        const double nearest = std::clamp(c.share(), 0.93, 0.97);
        EXPECT_GT(proportion_test(c.inside, c.runs, nearest).p_value, sidak_level(family_level, tests))
            << method << " " << name_of(family) << " " << dimension << " covers " << c.share();
      }
}

}  // namespace
}  // namespace montelux::test
