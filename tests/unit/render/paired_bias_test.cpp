// The mean and the error of a bias that pairs of samples show.
#include "render/paired_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace montelux::test {
namespace {

struct NoIntegrator final : PixelIntegrator {
  RayCounts trace(const TilePass&, std::span<PixelSample>) const override { return {}; }
};

constexpr std::size_t tiles = 96;
constexpr int pixels = 16;
// The bias of each tile differs, as light beyond a limit of depth does.
double bias_of(std::size_t tile) { return -double(tile % 7) * 0.1 - (tile > 60 ? 1.0 : 0.0); }
double mean_bias() {
  double sum = 0;
  for (std::size_t tile = 0; tile < tiles; ++tile) sum += bias_of(tile);
  return sum / double(tiles);
}

// Of a picture whose samples have so much noise.
BiasEstimate measured(int passes, int samples_per_pass, double noise, unsigned seed = 0) {
  const NoIntegrator integrator;
  PairedBias paired(integrator, tiles, samples_per_pass);
  std::mt19937 numbers(seed);
  std::normal_distribution<float> normal(0, 1);
  int compared = 0;
  for (int pass = 0; pass < passes; ++pass)
    for (std::size_t tile = 0; tile < tiles; ++tile)
      for (int sample = 0; sample < samples_per_pass; ++sample) {
        if (!paired.compares(tile, pass, sample)) continue;
        ++compared;
        std::vector<PixelSample> with(pixels), without(pixels);
        for (int i = 0; i < pixels; ++i) {
          with[std::size_t(i)].radiance = Rgb{1, 1, 1};
          const float truth = 1 - float(bias_of(tile));
          without[std::size_t(i)].radiance =
              Rgb{truth, truth + float(noise) * normal(numbers), truth + float(noise) * normal(numbers)};
        }
        paired.add(tile, pass, with, without);
      }
  EXPECT_NEAR(compared, passes * samples_per_pass * int(tiles) / 8, int(tiles) / 8);
  const auto bias = estimate_bias(paired.bias());
  EXPECT_TRUE(bias);
  return bias.value_or(BiasEstimate{});
}

TEST(PairedBias, has_no_error_because_parts_of_the_picture_differ) {
  const struct { int passes, samples; } plans[] = {{8, 8}, {2, 8}, {8, 64}, {5, 24}, {8, 4}, {8, 12}, {16, 2}, {32, 1}};
  for (const auto [passes, samples] : plans) {
    SCOPED_TRACE(testing::Message() << passes << " passes of " << samples);
    const BiasEstimate bias = measured(passes, samples, 0);
    EXPECT_NEAR(bias.mean[0], mean_bias(), 1e-6);
    EXPECT_NEAR(bias.standard_error[0], 0, 1e-6);
  }
  // Fewer passes see less than the whole picture: their spread contains the differences of its parts.
  EXPECT_GT(measured(8, 1, 0).standard_error[0], 0.01);
}

TEST(PairedBias, states_the_error_that_noise_makes) {
  const struct { int passes, samples; } plans[] = {{8, 8}, {8, 4}, {8, 32}};
  for (const auto [passes, samples] : plans) {
    SCOPED_TRACE(testing::Message() << passes << " passes of " << samples);
    constexpr int runs = 400;
    double stated = 0, squared = 0;
    for (unsigned run = 0; run < runs; ++run) {
      const BiasEstimate bias = measured(passes, samples, 0.5, run);
      for (std::size_t c : {1, 2}) {
        stated += bias.standard_error[c] * bias.standard_error[c];
        squared += (bias.mean[c] - mean_bias()) * (bias.mean[c] - mean_bias());
      }
    }
    // Sums of 800 squares and of 800 estimates of three or seven degrees of freedom: 0.05 and 0.03 in the logarithm.
    EXPECT_NEAR(std::log(stated / squared), 0, 4 * std::hypot(0.05, 0.03));
  }
}

}  // namespace
}  // namespace montelux::test
