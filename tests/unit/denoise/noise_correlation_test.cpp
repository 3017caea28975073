// Noise that pixels share with those around them: its correlation, and the errors of filters. Planted: the noise of
// pixels is taken to be independent.
#include "denoise/noise_correlation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "denoise/squared_error.h"
#include "denoise/weighted_sums.h"
#include "math/functions.h"
#include "noisy_images.h"

namespace montelux {

namespace {

constexpr unsigned seeds = 40;

// The image of made() with noise that is the mean of 3 x 3 independent numbers, times 3.
Made with_shared_noise(unsigned seed, double sigma) {
  Made m = made(seed);
  std::mt19937 numbers(seed);
  std::normal_distribution<double> normal;
  for (HalfPlanes& half : m.image.halves)
    for (std::size_t c = 0; c < 3; ++c) {
      constexpr int columns = width + 2;
      std::vector<double> white(std::size_t(columns * (height + 2)));
      for (double& number : white) number = normal(numbers);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          double sum = 0;
          for (int dy = 0; dy < 3; ++dy)
            for (int dx = 0; dx < 3; ++dx) sum += white[std::size_t((y + dy) * columns + x + dx)];
          const auto i = std::size_t(y * width + x);
          half.color[c][i] = float(truth(x, y, c) * (1 + sigma * sum / 3 / std::sqrt(double(half.share[i]))));
          m.image.variance[c][i] = float(std::pow(sigma * truth(x, y, c), 2));
        }
    }
  return m;
}

// Differences between stated and true squared errors, over some images.
struct Differences {
  double sum = 0, squares = 0;
  void add(double difference) { sum += difference, squares += difference * difference; }
  // In standard errors.
  double mean() const { return sum / std::sqrt(squares - sum * sum / seeds); }
};

// The estimated squared error of a filter, less the true one. `shares`: the planes that hold how far the filtered pixel
// shares its noise with the pixel.
double excess_of(const Made& m, const FilteredHalf& first, const FilteredHalf& second, const Plane& first_shares,
                 const Plane& second_shares) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < m.image.pixels(); ++i) {
      const auto& [a, b] = m.image.halves;
      const double share = double(a.share[i]), x = double(first.color[c][i]), y = double(second.color[c][i]);
      const Noisy noisy{double(a.color[c][i]), double(b.color[c][i]), share, double(m.image.variance[c][i])};
      sum += squared_error(noisy, {x, y, double(first_shares[i]), double(second_shares[i])});
      sum -= square(share * x + (1 - share) * y - double(m.truth[c][i]));
    }
  return sum / (3.0 * double(m.image.pixels()));
}

}  // namespace

TEST(NoiseCorrelation, is_that_of_means_over_the_pixels_around) {
  // The mean of the shares that 3 x 3 pixels have in common, over the pixels at each distance.
  const double expected[] = {1, (2 * 6 + 2 * 4) / 36.0, (2 * 3 + 4 * 2) / 54.0, 2 / 72.0};
  double sums[4] = {}, squares[4] = {};
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const NoiseCorrelation correlation(with_shared_noise(seed, 0.1).image);
    EXPECT_FALSE(correlation.is_zero());
    for (int distance = 0; distance < 4; ++distance) {
      const double value = double(correlation.at(distance, 0));
      EXPECT_EQ(correlation.at(0, -distance), correlation.at(distance, 0));
      sums[distance] += value, squares[distance] += value * value;
    }
  }
  EXPECT_EQ(sums[0], seeds);
  for (int distance = 1; distance < 3; ++distance) {
    const double mean = sums[distance] / seeds;
    const double error = std::sqrt((squares[distance] / seeds - mean * mean) / seeds);
    EXPECT_NEAR(mean, expected[distance], 4 * error) << distance;
  }
  // Hardly significant in an image this small.
  EXPECT_LT(sums[3] / seeds, 2 * expected[3]);
}

TEST(NoiseCorrelation, is_zero_where_noise_is_independent) {
  for (unsigned seed = 0; seed < seeds; ++seed) EXPECT_TRUE(NoiseCorrelation(made(seed).image).is_zero()) << seed;
}

TEST(NoiseCorrelation, gives_the_errors_of_filters) {
  for (std::size_t filter = 0; filter < filter_count; ++filter) {
    Differences differences, planted;
    for (unsigned seed = 0; seed < seeds; ++seed) {
      const Made m = with_shared_noise(seed, 0.2);
      const FilteredHalves halves = filter_halves(m.image, {});
      const FilteredHalf &a = halves[0][filter], &b = halves[1][filter];
      differences.add(excess_of(m, a, b, a.with_pixel(), b.with_pixel()));
      planted.add(excess_of(m, a, b, a.own, b.own));
    }
    EXPECT_LT(std::abs(differences.mean()), 4) << filter;
    EXPECT_LT(planted.mean(), -8) << filter;
  }
}

}  // namespace montelux
