// Doubts over many seeds: what misleads is said in nearly all, what does not in hardly any.
#include <gtest/gtest.h>

#include "doubtful.h"
#include "genz.h"
#include "statistics.h"

namespace montelux::test {
namespace {

using enum lab::IntegralWarning::Kind;
constexpr std::uint64_t samples = 1u << 20, seeds = 60;

lab::IntegralResult run(const lab::Integrand& f, std::string_view method, std::uint64_t seed) {
  return lab::integrate({.integrand = f}, lab::parse_method(method).value(), {.samples = samples}, {.seed = seed});
}

TEST(Doubts, two_peaks_are_found_or_the_doubt_is_said) {
  for (double sigma : {0.03, 0.04, 0.05}) {
    const KnownIntegral f = two_gaussians(sigma);
    int good = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const lab::IntegralResult r = run(f.integrand, "auto", seed);
      const Interval wide = lab::result_of(r.state, 0.9999).interval;
      EXPECT_TRUE((wide.low <= f.truth && f.truth <= wide.high) || !r.warnings.empty()) << sigma << " seed " << seed;
      good += (r.interval.low <= f.truth && f.truth <= r.interval.high) || !r.warnings.empty();
    }
    EXPECT_EQ(good, int(seeds)) << sigma;
    std::printf("sigma %g: within 95 %% or warned %d of %d\n", sigma, good, int(seeds));
  }
}

TEST(Doubts, heavy_tails_are_said_in_57_of_60_runs) {
  for (const char* method : {"auto", "uniform", "qmc", "vegas"}) {
    const auto count = [&](const KnownIntegral& f, lab::IntegralWarning::Kind kind) {
      int said = 0;
      for (std::uint64_t seed = 0; seed < seeds; ++seed) said += warns(run(f.integrand, method, seed), kind);
      std::printf("%s %s: said in %d of %d\n", method, f.name.c_str(), said, int(seeds));
      EXPECT_GE(said, 57) << method << " " << f.name;
    };
    for (const KnownIntegral& f : infinite_variance()) count(f, heavy_tail);
    for (const KnownIntegral& f : divergent()) count(f, may_not_exist);
  }
}

TEST(Doubts, what_is_well_behaved_is_not_doubted) {
  std::vector<KnownIntegral> cases = well_behaved();
  for (GenzFamily family : genz_families)
    for (std::size_t dimension : {2, 5, 10}) {
      const Genz g = Genz::make(family, dimension, 1);
      cases.push_back({std::string(name_of(family)), g.integrand(), g.integral()});
    }
  int warned = 0, runs = 0;
  for (const KnownIntegral& f : cases)
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const lab::IntegralResult r = run(f.integrand, "auto", seed);
      ++runs, warned += !r.warnings.empty();
      if (!r.warnings.empty())
        std::printf("%s seed %d: %s\n", f.name.c_str(), int(seed), r.warnings.front().message.c_str());
    }
  std::printf("warned in %d of %d\n", warned, runs);
  EXPECT_LE(warned, runs / 100);
}

}  // namespace
}  // namespace montelux::test
