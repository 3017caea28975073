// The removal of noise from layers of light: they sum to the image, and have errors of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "math/functions.h"
#include "noisy_images.h"

namespace montelux {

// The fits of a layer of rare bright pixels are below zero beside them, where other layers have light. Planted: layers
// of no family, which stay as they are.
TEST(DenoisedLayers, of_a_family_have_no_light_below_zero) {
  Made m = made(3);
  std::mt19937 numbers(7);
  std::exponential_distribution<float> light(1);
  m.image.layers.assign(2, NoisyLayer(m.image.pixels(), false, "bounces"));
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < m.image.pixels(); ++i) {
      const float rare = i % 29 == 0 ? 4.0f : 0.0f;
      for (std::size_t h = 0; h < 2; ++h) {
        float &even = m.image.layers[0].halves[h][c][i], &bright = m.image.layers[1].halves[h][c][i];
        even = 5 * light(numbers), bright = rare * light(numbers);
        m.image.halves[h].color[c][i] = even + bright;
      }
      m.image.variance[c][i] = 0.25f * square(m.image.halves[0].color[c][i] - m.image.halves[1].color[c][i]);
    }
  const auto min_of = [&](const DenoisedImage& image) {
    float least = 0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < m.image.pixels(); ++i) {
        const float a = image.layers[0].color[c][i], b = image.layers[1].color[c][i];
        EXPECT_NEAR(a + b, image.color[c][i], 1e-4f);
        least = std::min({least, a, b});
      }
    return least;
  };
  EXPECT_GT(min_of(denoise(m.image)), -1e-6f);  // rounding
  for (NoisyLayer& layer : m.image.layers) layer.family.clear();
  EXPECT_LT(min_of(denoise(m.image)), -1e-3f);
}

// Planted: layers whose halves are exchanged, which weights of the wrong half filter.
TEST(DenoisedLayers, sum_to_the_image_without_noise) {
  std::array<ColorPlanes, 2> truths;
  for (float share : {0.5f, 0.25f}) {
    const Made m = made_of_layers(3, share, false, truths), earlier = made_of_layers(40, share, false, truths);
    for (const bool others : {false, true}) {
      DenoiseSettings settings;
      if (others) settings.others = {&earlier.image, 1};
      const DenoisedImage result = denoise(m.image, settings);
      ASSERT_EQ(result.layers.size(), 2u);
      EXPECT_TRUE(result.layers[0].error[0].empty());
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < m.image.pixels(); ++i)
          ASSERT_NEAR(result.layers[0].color[c][i] + result.layers[1].color[c][i], result.color[c][i], 2e-5f);
      Made exchanged = m;
      for (NoisyLayer& layer : exchanged.image.layers) std::swap(layer.halves[0], layer.halves[1]);
      const DenoisedImage wrong = denoise(exchanged.image, settings);
      float deviation = 0;
      for (std::size_t i = 0; i < m.image.pixels(); ++i)
        deviation = std::max(deviation,
                             std::abs(wrong.layers[0].color[0][i] + wrong.layers[1].color[0][i] - wrong.color[0][i]));
      EXPECT_GT(deviation, 1e-3f);
    }
  }
}

// Of each layer. Planted: variances that are a quarter of the true ones. The bound by the difference of the halves,
// which holds around each pixel, makes the stated errors too large.
TEST(DenoisedLayers, have_their_own_errors) {
  const auto sum_of_squares = [](const ColorPlanes& error) {
    double sum = 0;
    for (const Plane& plane : error)
      for (float x : plane) sum += double(x) * double(x);
    return sum / (3.0 * double(error[0].size()));
  };
  for (float share : {0.5f, 0.25f}) {
    std::array<double, 2> stated{}, left{}, before{}, planted{};
    for (unsigned seed = 0; seed < 8; ++seed) {
      std::array<ColorPlanes, 2> truths;
      Made m = made_of_layers(seed, share, true, truths);
      const DenoisedImage result = denoise(m.image);
      for (NoisyLayer& layer : m.image.layers)
        for (Plane& plane : layer.variance)
          for (float& x : plane) x /= 4;
      const DenoisedImage wrong = denoise(m.image);
      for (std::size_t k = 0; k < 2; ++k) {
        left[k] += mean_squared_error(result.layers[k].color, truths[k]);
        stated[k] += sum_of_squares(result.layers[k].error), planted[k] += sum_of_squares(wrong.layers[k].error);
        for (const Plane& plane : m.image.layers[k].variance)
          before[k] += 4 * std::accumulate(plane.begin(), plane.end(), 0.0) / (3.0 * double(m.image.pixels()));
      }
    }
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_LT(left[k], 0.25 * before[k]) << k;
      EXPECT_GT(stated[k], 0.75 * left[k]) << k;
      EXPECT_LT(stated[k], 3.1 * left[k]) << k;
      EXPECT_GT(planted[k], 3.1 * left[k]) << k;
    }
  }
}

}  // namespace montelux
