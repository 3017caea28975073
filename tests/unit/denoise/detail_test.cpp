// What the removal of noise does to fine detail that only the colours show.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/functions.h"
#include "noisy_images.h"

namespace montelux {

namespace {

// The squared bias of the filtered image, relative to its truth, over that of the noise before the filter. The detail
// is even noise of this half-width, the same in each of the images.
double bias_with_detail(float half_width) {
  constexpr int seeds = 24;
  ColorPlanes sum, truth;
  double noise = 0, variance = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    Made m = made(seed, 0.5f, {0.1, 0.1, 0.1});
    std::mt19937 numbers(99);
    std::uniform_real_distribution<float> detail(1 - half_width, 1 + half_width);
    for (std::size_t i = 0; i < m.image.pixels(); ++i) {
      const float factor = detail(numbers);
      for (std::size_t c = 0; c < 3; ++c) {
        m.truth[c][i] *= factor, m.image.variance[c][i] *= factor * factor;
        for (HalfPlanes& half : m.image.halves) half.color[c][i] *= factor;
      }
    }
    const DenoisedImage result = denoise(m.image);
    if (seed == 0) sum = truth = m.truth;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < m.image.pixels(); ++i)
        sum[c][i] = (seed == 0 ? 0 : sum[c][i]) + result.color[c][i] / float(seeds);
    noise += result.sums.noisy_relative_mse() / seeds;
    variance += mean_relative_error(result.color, m.truth) / seeds;
  }
  const double of_mean = mean_relative_error(sum, truth);  // the bias, and a part of the noise that is left
  return (of_mean - (variance - of_mean) / (seeds - 1)) / noise;
}

}  // namespace

// If bias counts no more than noise does it is 0.20.
TEST(Denoise, blurs_less_where_bias_is_much_of_the_noise) { EXPECT_LT(bias_with_detail(0.1f), 0.16); }

}  // namespace montelux
