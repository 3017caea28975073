#include "render/paired_bias.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

constexpr std::size_t share = 8;

bool is_finite(const Rgb& color) {
  return std::all_of(std::begin(color.c), std::end(color.c), [](float x) { return std::isfinite(x); });
}

}  // namespace

PairedBias::PairedBias(const PixelIntegrator& unbiased, std::size_t tiles)
    : unbiased_(unbiased), every_(std::clamp<std::size_t>(tiles, 1, share)) {}

// Of each group of consecutive tiles one in turn, so that every turn sees all parts of the picture.
bool PairedBias::compares(std::size_t tile, std::size_t turn) const {
  const std::size_t group = tile / every_, first = (group * 0x9e3779b1u >> 16) % every_;
  return (tile + first + turn) % every_ == 0;
}

void PairedBias::add(std::size_t tile, int pass, int samples_per_pixel, std::span<const PixelSample> biased,
                     std::span<const PixelSample> unbiased) {
  Sum sum;
  sum.pixels = double(biased.size()) / samples_per_pixel;
  for (std::size_t i = 0; i < biased.size(); ++i) {
    const Rgb &with = biased[i].radiance, &without = unbiased[i].radiance;
    if (!is_finite(with) || !is_finite(without)) continue;
    for (std::size_t c = 0; c < rgb_size; ++c) sum.difference[c] += double(with.c[c]) - double(without.c[c]);
  }
  for (double& channel : sum.difference) channel /= samples_per_pixel;
  const std::scoped_lock lock(mutex_);
  sums_[pass][tile] += sum;
}

BiasOfPasses PairedBias::bias() {
  const std::scoped_lock lock(mutex_);
  Sum all;
  std::map<int, Sum> passes;
  for (const auto& [pass, tiles] : sums_) {
    for (const auto& [tile, sum] : tiles) passes[pass] += sum;
    all += passes[pass];
  }
  BiasOfPasses bias;
  for (const auto& [pass, sum] : passes)
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const double mean = all.difference[c] / all.pixels;
      bias[pass][c] = mean + (sum.difference[c] - mean * sum.pixels) * double(passes.size()) / all.pixels;
    }
  return bias;
}

}  // namespace montelux
