// How well Markov chains mix: how many of their proposals they accept, and how many independent samples their states
// are worth.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

namespace montelux {

// Sums over chains, which are added up.
struct MixingFigures {
  std::uint64_t chains = 0, steps = 0;  // steps of all chains
  // Proposals: `large` ones are independent of the state, the others are near it. Accepted: the sums of the
  // probabilities of acceptance.
  std::uint64_t large = 0;
  double large_accepted = 0, small_accepted = 0;
  // Of the autocorrelation time: between_chains is the sum over chains and regions of steps * (share - mean share)^2,
  // independent is what it would be for independent states.
  double between_chains = 0, independent = 0;

  MixingFigures& operator+=(const MixingFigures& other);

  // Mean probabilities of acceptance; none where there was no such proposal.
  std::optional<double> large_acceptance() const;
  std::optional<double> small_acceptance() const;
  // The integrated autocorrelation time, in steps: the mean over a chain of N steps has the variance of N / time
  // independent states. Estimated from the spread between chains of the shares of their steps in the regions of the
  // space (Geyer 1992, sec. 3.2: replicated runs); so it is at most the length of a chain, and no more than a lower
  // bound where it comes near that. None for fewer than two chains, or where all states are in one region.
  std::optional<double> autocorrelation_time() const;
  // steps / autocorrelation_time().
  std::optional<double> effective_samples() const;
};

// By the number of the pass, so that their sum does not depend on the order in which passes end.
using MixingOfPasses = std::map<int, MixingFigures>;
MixingFigures sum_of(const MixingOfPasses& passes);

// Regions into which the space of the states is split.
inline constexpr int mixing_regions = 16;
// How much of its steps a chain spent in each region; the sum is the number of its steps.
using RegionShares = std::array<double, mixing_regions>;

// Adds the spread between these chains, which must have reached their stationary distribution.
void add_spread(std::span<const RegionShares> chains, MixingFigures& figures);

}  // namespace montelux
