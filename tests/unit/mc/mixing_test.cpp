// Acceptance and autocorrelation of chains, on chains whose autocorrelation has a closed form.
#include "mc/mixing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mc/random.h"
#include "statistics.h"

namespace montelux::test {
namespace {

// A chain over two regions that starts in its stationary distribution and stays with probability (1 + rho) / 2: its
// autocorrelation after k steps is rho^k.
RegionShares two_state_chain(double rho, int steps, std::uint32_t number) {
  const RandomStream<float> random(number, 77u);
  RegionShares shares{};
  std::size_t state = random.at(0u) < 0.5f ? 3 : 9;
  for (int i = 0; i < steps; ++i) {
    shares[state] += 1;
    if (double(random.at(std::uint32_t(i + 1))) >= (1 + rho) / 2) state = 12 - state;
  }
  return shares;
}

// N times the variance of the mean of N states over that of a state.
double autocorrelation_time(double rho, int steps) {
  return (1 + rho) / (1 - rho) - 2 * rho * (1 - std::pow(rho, steps)) / (steps * (1 - rho) * (1 - rho));
}

std::vector<double> measured_times(double rho, int steps) {
  std::vector<double> times;
  for (std::uint32_t repeat = 0; repeat < 60; ++repeat) {
    std::vector<RegionShares> chains;
    for (std::uint32_t chain = 0; chain < 64; ++chain)
      chains.push_back(two_state_chain(rho, steps, repeat * 64 + chain));
    MixingFigures figures;
    add_spread(chains, figures);
    times.push_back(figures.autocorrelation_time().value());
  }
  return times;
}

TEST(Mixing, has_the_autocorrelation_time_of_chains_with_a_closed_form) {
  for (const double rho : {-0.4, 0.0, 0.8, 0.98}) {
    const int steps = 400;
    EXPECT_GT(t_test(measured_times(rho, steps), autocorrelation_time(rho, steps)).p_value, family_level / 4) << rho;
  }
  // An estimate that is a tenth too large would be found.
  EXPECT_LT(t_test(measured_times(0.8, 400), 1.1 * autocorrelation_time(0.8, 400)).p_value, family_level);
}

TEST(Mixing, of_chains_that_never_move_is_their_length) {
  std::vector<RegionShares> chains(1000);
  for (std::size_t i = 0; i < chains.size(); ++i) chains[i][i % 2] = 50;
  MixingFigures figures;
  figures.steps = 50'000;
  add_spread(chains, figures);
  // The variance of a sample of 1000 has the divisor 999.
  EXPECT_NEAR(figures.autocorrelation_time().value(), 50 * 1000.0 / 999, 1e-9);
  EXPECT_NEAR(figures.effective_samples().value(), 999, 1e-6);
}

TEST(Mixing, is_unknown_for_one_chain_and_in_one_region) {
  MixingFigures one, same;
  add_spread(std::vector<RegionShares>{two_state_chain(0.5, 100, 1)}, one);
  EXPECT_FALSE(one.autocorrelation_time());
  std::vector<RegionShares> chains(8);
  for (RegionShares& chain : chains) chain[5] = 10;
  add_spread(chains, same);
  EXPECT_FALSE(same.autocorrelation_time());
  EXPECT_FALSE(same.effective_samples());
}

TEST(Mixing, adds_up_over_passes) {
  MixingFigures a{16, 1000, 300, 60, 350, 12, 3}, b{16, 3000, 900, 300, 1050, 20, 5};
  const MixingFigures sum = sum_of({{1, b}, {0, a}});
  EXPECT_EQ(sum.chains, 32u);
  EXPECT_DOUBLE_EQ(sum.large_acceptance().value(), 0.3);
  EXPECT_DOUBLE_EQ(sum.small_acceptance().value(), 0.5);
  EXPECT_DOUBLE_EQ(sum.autocorrelation_time().value(), 4);
  EXPECT_DOUBLE_EQ(sum.effective_samples().value(), 1000);
  EXPECT_FALSE(MixingFigures{}.large_acceptance());
}

}  // namespace
}  // namespace montelux::test
