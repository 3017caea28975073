// Noisy images whose truth is known, for the removal of noise.
#pragma once
#include <array>
#include <cmath>
#include <random>

#include "denoise/denoise.h"

namespace montelux {

inline constexpr int width = 70, height = 37;  // no whole number of tiles

// A coloured image with an edge that the features show, and one that only the colours show.
inline double truth(int x, int y, std::size_t c) {
  const double slope = 0.5 + 0.01 * x, object = y < height / 2 ? 1 : 0.3 + 0.2 * double(c), shadow = x < 25 ? 0.2 : 1;
  return slope * object * shadow;
}

struct Made {
  NoisyImage image{width, height};
  ColorPlanes truth;
};

// With Gaussian noise of these standard errors relative to the truth, by channel; halves of `share` and 1 - share of
// the passes.
inline Made made(unsigned seed, float share = 0.5f, std::array<double, 3> sigma = {0.1, 0.2, 0.05}) {
  Made m;
  std::mt19937 numbers(seed);
  std::normal_distribution<double> normal;
  for (Plane& plane : m.truth) plane.resize(m.image.pixels());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = std::size_t(y * width + x);
      for (std::size_t h = 0; h < 2; ++h) {
        HalfPlanes& half = m.image.halves[h];
        half.share[i] = h == 0 ? share : 1 - share;
        for (std::size_t c = 0; c < 3; ++c) {
          m.truth[c][i] = float(truth(x, y, c));
          const double deviation = sigma[c] * truth(x, y, c) / std::sqrt(double(half.share[i]));
          half.color[c][i] = float(truth(x, y, c) + normal(numbers) * deviation);
          half.albedo[c][i] = y < height / 2 ? 0.2f : 0.8f;
          half.normal[c][i] = c == 2 ? 1.0f : 0.0f;
        }
      }
      for (std::size_t c = 0; c < 3; ++c) m.image.variance[c][i] = float(std::pow(sigma[c] * truth(x, y, c), 2));
    }
  return m;
}

inline double mean_squared_error(const ColorPlanes& color, const ColorPlanes& truth) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < color[c].size(); ++i) sum += std::pow(double(color[c][i]) - double(truth[c][i]), 2);
  return sum / (3.0 * double(color[0].size()));
}

inline double mean_relative_error(const ColorPlanes& color, const ColorPlanes& truth) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < color[c].size(); ++i)
      sum += std::pow(double(color[c][i]) - double(truth[c][i]), 2) / (std::pow(double(truth[c][i]), 2) + 0.01);
  return sum / (3.0 * double(color[0].size()));
}

inline float mixed(const Made& m, std::size_t c, std::size_t i) {
  const auto& [a, b] = m.image.halves;
  return a.share[i] * a.color[c][i] + b.share[i] * b.color[c][i];
}

// Two layers with independent noise that sum to the image: one dim, one with the edges.
inline Made made_of_layers(unsigned seed, float share, bool knows_variance, std::array<ColorPlanes, 2>& truths) {
  const Made first = made(1000 + seed, share, {0.1, 0.05, 0.2});
  Made sum = made(seed, share);
  sum.image.layers.assign(2, NoisyLayer(sum.image.pixels(), knows_variance, "bounces"));
  truths = {sum.truth, sum.truth};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < sum.image.pixels(); ++i) {
      constexpr float dim = 0.25f;
      const float difference = first.truth[c][i] * dim;
      truths[1][c][i] = difference;
      const float variances[]{sum.image.variance[c][i], first.image.variance[c][i] * dim * dim};
      for (std::size_t h = 0; h < 2; ++h) {
        NoisyLayer &a = sum.image.layers[0], &b = sum.image.layers[1];
        a.halves[h][c][i] = sum.image.halves[h].color[c][i];
        b.halves[h][c][i] = first.image.halves[h].color[c][i] * dim;
        sum.image.halves[h].color[c][i] += b.halves[h][c][i];
      }
      if (knows_variance)
        for (std::size_t k = 0; k < 2; ++k) sum.image.layers[k].variance[c][i] = variances[k];
      sum.image.variance[c][i] += variances[1], sum.truth[c][i] += difference;
    }
  return sum;
}

}  // namespace montelux
