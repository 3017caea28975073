// The error that is stated of a filter of which nothing is known, on noise of known truth: skewed samples, rare bright
// ones, halves of different length. Planted: a filter that sees the other half, too.
#include "denoise/color_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "mc/random.h"

namespace montelux {

namespace {

constexpr int side = 48;
constexpr std::size_t pixels = side * side;
constexpr std::array<int, 2> passes{5, 3};
constexpr float share = 5.0f / 8;

// Coloured, with an edge and a gradient.
double truth(std::size_t i, std::size_t c) {
  const auto x = double(i % side), y = double(i / side);
  return (x < 20 ? 0.2 : 0.7) * (1 + 0.4 * double(c)) + 0.01 * y;
}

// Exponentially distributed, and one sample of fifty is brighter by this factor.
double sample(double mean, double u, double v, double factor) {
  return -std::log1p(-u) * (v < 0.02 ? factor : 1) * mean / (1 + 0.02 * (factor - 1));
}

NoisyImage noisy_image(std::uint32_t seed, double factor = 30) {
  NoisyImage image(side, side);
  const RandomStream<float> random(seed, 5u);
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < rgb_size; ++c) {
      double squares = 0;
      std::array<double, 2> sums{};
      for (std::size_t half = 0; half < 2; ++half) {
        for (int pass = 0; pass < passes[half]; ++pass, number += 2) {
          const double value = sample(truth(i, c), double(random.at(number)), double(random.at(number + 1)), factor);
          sums[half] += value, squares += value * value;
        }
        HalfPlanes& planes = image.halves[half];
        planes.color[c][i] = float(sums[half] / passes[half]);
        planes.albedo[c][i] = i % side < 20 ? 0.2f : 0.7f, planes.share[i] = half == 0 ? share : 1 - share;
      }
      const double mean = (sums[0] + sums[1]) / 8;
      image.variance[c][i] = float((squares / 8 - mean * mean) / 7);
    }
  return image;
}

// The mean over 5 x 5 pixels of colours that are limited to twice the albedo: biased, and not linear.
std::vector<float> limited_mean(const FilterInput& input) {
  std::vector<float> output(input.color.size());
  for (int y = 0; y < input.height; ++y)
    for (int x = 0; x < input.width; ++x)
      for (int c = 0; c < 3; ++c) {
        float sum = 0, count = 0;
        for (int v = std::max(y - 2, 0); v <= std::min(y + 2, input.height - 1); ++v)
          for (int u = std::max(x - 2, 0); u <= std::min(x + 2, input.width - 1); ++u, ++count) {
            const auto at = std::size_t(3 * (v * input.width + u) + c);
            sum += std::min(input.color[at], 2 * input.albedo[at]);
          }
        output[std::size_t(3 * (y * input.width + x) + c)] = sum / count;
      }
  return output;
}

class LimitedMean final : public ColorFilter {
 public:
  std::string name() const override { return "limited mean"; }
  std::vector<float> filter(const FilterInput& input, int, const std::function<bool()>& stop) const override {
    if (stop && stop()) throw std::runtime_error("stopped");
    return limited_mean(input);
  }
};

// Mixes what it has seen before into its result: the second half then depends on the first.
class Peeking final : public ColorFilter {
 public:
  std::string name() const override { return "peeking"; }
  std::vector<float> filter(const FilterInput& input, int, const std::function<bool()>&) const override {
    std::vector<float> output = limited_mean(input);
    for (std::size_t i = 0; i < before_.size(); ++i) output[i] = (output[i] + before_[i]) / 2;
    before_ = input.color;
    return output;
  }

 private:
  mutable std::vector<float> before_;
};

double true_mse(const DenoisedImage& image) {
  double sum = 0;
  for (std::size_t c = 0; c < rgb_size; ++c)
    for (std::size_t i = 0; i < pixels; ++i) {
      const double difference = double(image.color[c][i]) - truth(i, c);
      sum += difference * difference;
    }
  return sum / (3 * pixels);
}

// Stated less true, over the standard error of that, of 100 images.
template <class Filter>
double deviation_of_stated() {
  double sum = 0, squares = 0;
  constexpr int images = 100;
  for (std::uint32_t seed = 1; seed <= images; ++seed) {
    const Filter filter;
    const NoisyImage image = noisy_image(seed);
    const DenoisedImage done = denoise(image, {1, {}, {}, &filter});
    const double difference = done.sums.mse() - true_mse(done);
    sum += difference, squares += difference * difference;
  }
  const double mean = sum / images;
  return mean / std::sqrt((squares / images - mean * mean) / (images - 1));
}

}  // namespace

TEST(ColorFilter, states_its_error_without_bias) { EXPECT_LT(std::abs(deviation_of_stated<LimitedMean>()), 4); }

TEST(ColorFilter, would_state_another_error_if_it_saw_the_other_half) { EXPECT_LT(deviation_of_stated<Peeking>(), -8); }

TEST(ColorFilter, states_the_error_of_each_part_of_the_image) {
  std::array<double, 2> stated{}, actual{};
  const LimitedMean filter;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const DenoisedImage done = denoise(noisy_image(seed, 2), {1, {}, {}, &filter});
    for (std::size_t i = 0; i < pixels; ++i)
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const auto part = std::size_t(i % side < 20 ? 0 : 1);
        const double error = double(done.error[c][i]), difference = double(done.color[c][i]) - truth(i, c);
        stated[part] += error * error, actual[part] += difference * difference;
      }
  }
  for (std::size_t part = 0; part < 2; ++part) {
    EXPECT_GT(stated[part] / actual[part], 0.8) << part;
    EXPECT_LT(stated[part] / actual[part], 1.25) << part;
  }
  EXPECT_GT(actual[1] / actual[0], 1.5);  // the parts differ, and so must what is stated of them
}

TEST(ColorFilter, filters_each_half_and_layer_by_itself) {
  NoisyImage image = noisy_image(3);
  NoisyLayer& layer = image.layers.emplace_back(pixels, true);
  for (std::size_t half = 0; half < 2; ++half) layer.halves[half] = image.halves[half].color;
  layer.variance = image.variance;
  // A pixel without passes in the second half stays as it is.
  image.halves[0].share[7] = 1, image.halves[1].share[7] = 0;
  const LimitedMean filter;
  const DenoisedImage done = denoise(image, {1, {}, {}, &filter});
  std::array<std::vector<float>, 2> expected;
  for (std::size_t half = 0; half < 2; ++half) {
    FilterInput input{side, side, std::vector<float>(3 * pixels), std::vector<float>(3 * pixels), {}};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < pixels; ++i)
        input.color[3 * i + c] = image.halves[half].color[c][i],
                            input.albedo[3 * i + c] = image.halves[half].albedo[c][i];
    expected[half] = limited_mean(input);
  }
  ASSERT_EQ(done.layers.size(), 1u);
  for (std::size_t c = 0; c < rgb_size; ++c)
    for (std::size_t i = 0; i < pixels; ++i) {
      const float mean = share * expected[0][3 * i + c] + (1 - share) * expected[1][3 * i + c];
      EXPECT_NEAR(done.color[c][i], i == 7 ? image.halves[0].color[c][i] : mean, 1e-6);
      EXPECT_EQ(done.layers[0].color[c][i], done.color[c][i]);
    }
}

TEST(ColorFilter, may_be_stopped_and_must_keep_the_size) {
  const NoisyImage image = noisy_image(3);
  const LimitedMean filter;
  EXPECT_THROW(denoise(image, {1, [] { return true; }, {}, &filter}), std::runtime_error);
  class Shrinking final : public ColorFilter {
   public:
    std::string name() const override { return "shrinking"; }
    std::vector<float> filter(const FilterInput&, int, const std::function<bool()>&) const override {
      return {1, 2, 3};
    }
  };
  const Shrinking shrinking;
  EXPECT_THROW(denoise(image, {1, {}, {}, &shrinking}), std::runtime_error);
}

}  // namespace montelux
