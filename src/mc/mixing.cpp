#include "mc/mixing.h"

namespace montelux {

MixingFigures& MixingFigures::operator+=(const MixingFigures& other) {
  chains += other.chains, steps += other.steps, large += other.large;
  large_accepted += other.large_accepted, small_accepted += other.small_accepted;
  between_chains += other.between_chains, independent += other.independent;
  return *this;
}

std::optional<double> MixingFigures::large_acceptance() const {
  return large > 0 ? std::optional(large_accepted / double(large)) : std::nullopt;
}

std::optional<double> MixingFigures::small_acceptance() const {
  return steps > large ? std::optional(small_accepted / double(steps - large)) : std::nullopt;
}

std::optional<double> MixingFigures::autocorrelation_time() const {
  return independent > 0 ? std::optional(between_chains / independent) : std::nullopt;
}

std::optional<double> MixingFigures::effective_samples() const {
  const std::optional<double> time = autocorrelation_time();
  return time && *time > 0 ? std::optional(double(steps) / *time) : std::nullopt;
}

MixingFigures sum_of(const MixingOfPasses& passes) {
  MixingFigures sum;
  for (const auto& [pass, figures] : passes) sum += figures;
  return sum;
}

void add_spread(std::span<const RegionShares> chains, MixingFigures& figures) {
  if (chains.size() < 2) return;
  RegionShares all{};
  double steps = 0;
  for (const RegionShares& chain : chains)
    for (std::size_t region = 0; region < all.size(); ++region) all[region] += chain[region], steps += chain[region];
  if (!(steps > 0)) return;
  double between = 0, variance = 0;
  for (std::size_t region = 0; region < all.size(); ++region) {
    const double mean = all[region] / steps;
    variance += mean * (1 - mean);
    for (const RegionShares& chain : chains) {
      double length = 0;
      for (double share : chain) length += share;
      const double excess = length > 0 ? chain[region] / length - mean : 0;
      between += length * excess * excess;
    }
  }
  const double count = double(chains.size());
  figures.between_chains += between * count / (count - 1);
  figures.independent += variance * count;
}

}  // namespace montelux
