#include "denoise/noise_correlation.h"

#include <algorithm>
#include <cmath>

#include "denoise/box_mean.h"
#include "denoise/relative_scale.h"
#include "denoise/weighted_sums.h"
#include "math/functions.h"

namespace montelux {

namespace {

// A correlation counts if it is so many standard errors above zero.
constexpr double significance = 4;
// About so many pixels are compared with those around them.
constexpr std::size_t max_pixels = 1 << 17;
constexpr int brightness_reach = 4;  // pixels over which the brightness is averaged

std::size_t ring_of(int x, int y) { return std::size_t(std::lround(std::hypot(x, y))); }

// The noise of each pixel, relative to the brightness around it: the difference of the halves with the variance that
// their mean has; 0 where it is not known. All of the noise counts as in relative errors: in its own standard
// deviations, that of pixels with hardly any would count as much, which may be shared where the rest is not.
Plane relative_noise(const NoisyImage& image) {
  const auto& [a, b] = image.halves;
  Plane noise(image.pixels()), gray(image.pixels());
  for (std::size_t i = 0; i < noise.size(); ++i)
    for (std::size_t c = 0; c < rgb_size; ++c) {
      gray[i] += (a.share[i] * a.color[c][i] + b.share[i] * b.color[c][i]) / rgb_size;
      noise[i] += std::sqrt(a.share[i] * b.share[i]) * (a.color[c][i] - b.color[c][i]) / rgb_size;
    }
  gray = box_mean(gray, image.width, image.height, brightness_reach);
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise[i] = image.has_halves(i) ? noise[i] * std::sqrt(reciprocal_square(gray[i])) : 0;
  return noise;
}

// Sums over the pairs of pixels at one distance that both have noise.
struct Ring {
  double pairs = 0, products = 0, squares = 0;  // of the products of their noise

  void add(float product) {
    pairs += product != 0 ? 1 : 0, products += double(product), squares += double(square(product));
  }
  bool is_correlated() const { return products > significance * std::sqrt(squares); }
};

}  // namespace

NoiseCorrelation::NoiseCorrelation(const NoisyImage& image) : of_rings_{1.0f} {
  const Plane noise = relative_noise(image);
  const int w = image.width, h = image.height;
  const int step = std::max(1, int(image.pixels() / max_pixels));  // of the rows
  std::vector<Ring> rings(filter_reach + 1);
  for (int y = 0; y < h; y += step)
    for (int dy = 0; dy <= std::min(filter_reach, h - 1 - y); ++dy)
      for (int dx = dy == 0 ? 0 : -filter_reach; dx <= filter_reach; ++dx) {
        const std::size_t ring = ring_of(dx, dy);
        if (ring >= rings.size()) continue;
        const float* const here = noise.data() + std::ptrdiff_t(y) * w;
        const float* const there = noise.data() + std::ptrdiff_t(y + dy) * w + dx;
        for (int x = std::max(0, -dx); x < std::min(w, w - dx); ++x) rings[ring].add(here[x] * there[x]);
      }
  const auto mean = [](const Ring& ring) { return ring.products / std::max(ring.pairs, 1.0); };
  for (std::size_t k = 1; k < rings.size() && rings[k].is_correlated(); ++k)
    of_rings_.push_back(float(std::min(mean(rings[k]) / mean(rings[0]), 1.0)));
}

float NoiseCorrelation::at(int x, int y) const {
  const std::size_t ring = ring_of(x, y);
  return ring < of_rings_.size() ? of_rings_[ring] : 0;
}

}  // namespace montelux
