#include "render/paired_bias.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace montelux {

namespace {

constexpr std::size_t share = 8;

bool is_finite(const Rgb& color) {
  return std::all_of(std::begin(color.c), std::end(color.c), [](float x) { return std::isfinite(x); });
}

}  // namespace

PairedBias::PairedBias(const PixelIntegrator& unbiased, std::size_t tiles, int samples_per_pass)
    : unbiased_(unbiased),
      every_(std::clamp<std::size_t>(tiles, 1, share)),
      samples_per_pass_(std::size_t(samples_per_pass)),
      samples_per_turn_(samples_per_pass_ % every_ == 0 ? samples_per_pass_ / every_ : 1) {}

// Of each group of consecutive tiles one in turn, so that every turn sees all parts of the picture. A turn has
// successive samples: those of most point sets are spread best.
bool PairedBias::compares(std::size_t tile, int pass, int sample) const {
  const std::size_t turn = (std::size_t(pass) * samples_per_pass_ + std::size_t(sample)) / samples_per_turn_;
  const std::size_t group = tile / every_, first = (group * 0x9e3779b1u >> 16) % every_;
  return (tile + first + turn) % every_ == 0;
}

void PairedBias::add(std::size_t tile, int pass, std::span<const PixelSample> biased,
                     std::span<const PixelSample> unbiased) {
  Sum sum;
  sum.pixels = double(biased.size());
  for (std::size_t i = 0; i < biased.size(); ++i) {
    const Rgb with = biased[i].light(), without = unbiased[i].light();
    if (!is_finite(with) || !is_finite(without)) continue;
    for (std::size_t c = 0; c < rgb_size; ++c) sum.difference[c] += double(with.c[c]) - double(without.c[c]);
  }
  const std::scoped_lock lock(mutex_);
  sums_[pass][tile] += sum;
}

BiasOfPasses PairedBias::bias() {
  const std::scoped_lock lock(mutex_);
  // So many passes see all tiles equally often.
  const std::size_t whole = every_ / std::gcd(every_, samples_per_pass_ / samples_per_turn_);
  constexpr std::size_t min_parts = 4;
  const int step = sums_.size() >= min_parts * whole ? int(whole) : 1;
  Sum all;
  std::map<int, Sum> parts;
  for (const auto& [pass, tiles] : sums_)
    for (const auto& [tile, sum] : tiles) parts[pass / step * step] += sum, all += sum;
  BiasOfPasses bias;
  for (const auto& [pass, sum] : parts)
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const double mean = all.difference[c] / all.pixels;
      bias[pass][c] = mean + (sum.difference[c] - mean * sum.pixels) * double(parts.size()) / all.pixels;
    }
  return bias;
}

}  // namespace montelux
