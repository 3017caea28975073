#include "mc/point_set.h"

#include <gtest/gtest.h>

#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

// The tests of this file that give a p-value: per kind uniformity (2), correlation (3).
constexpr double tests_of_the_suite = 6 * 8;
const double level = sidak_level(family_level, tests_of_the_suite);

// One point of each of many realisations: whatever the correlation inside a set, these are independent.
template <class Fault>
TestResult uniformity(PointSetKind kind, std::uint32_t dimension, Fault fault) {
  std::uint32_t n = 0;
  return chi_square_square(
      [&](RandomStream<float>&) {
        const std::uint32_t pass = n / 16, index = n % 16;
        ++n;
        PointSet set{kind, 21, pass, 16, 64, 64};
        return fault(Sampler<float>(set, pass % 61, pass % 53, index).get2(dimension));
      },
      [](double, double) { return 1.0; }, {16, 16}, 64000, 1);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  SampleSummary sa = summarize(a), sb = summarize(b);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - sa.mean) * (b[i] - sb.mean);
  return sum / (sa.count - 1) / std::sqrt(sa.variance * sb.variance);
}

double integrand(Vec2f u) { return std::exp(-3 * (double(u.x) + 0.5 * double(u.y) * double(u.y))); }
double disc(Vec2f u) { return u.x * u.x + u.y * u.y < 1 ? 1.0 : 0.0; }

template <class Function>
double mean_over_set(PointSet set, std::uint32_t x, std::uint32_t y, Function f) {
  double sum = 0;
  for (std::uint32_t i = 0; i < set.samples_per_pass; ++i) sum += f(Sampler<float>(set, x, y, i).get2(2));
  return sum / set.samples_per_pass;
}

TEST(PointSet, points_are_uniform_over_passes_pixels_and_indices) {
  for (const NamedPointSet& entry : point_set_names)
    for (std::uint32_t d : {2u, 140u}) {
      TestResult r = uniformity(entry.kind, d, [](Vec2f u) { return u; });
      // A set that is more even than random makes the statistic small, never large.
      EXPECT_GT(r.p_value, level) << entry.name << r.note;
    }
}

TEST(PointSet, uniformity_test_rejects_a_coordinate_bent_by_five_percent) {
  TestResult r = uniformity(PointSetKind::independent, 2, [](Vec2f u) { return Vec2f{std::pow(u.x, 1.05f), u.y}; });
  EXPECT_LT(r.p_value, level);
}

// Estimates of one integral: over passes, over distant pixels, and over dimensions they must not be correlated.
TEST(PointSet, passes_pixels_and_dimensions_are_uncorrelated) {
  for (const NamedPointSet& entry : point_set_names) {
    std::vector<double> here, next_pass, other_pixel, x, other_dimension;
    const std::uint32_t n = 20000;
    for (std::uint32_t k = 0; k < n; ++k) {
      PointSet set{entry.kind, 5, 2 * k, 4, 64, 64}, following = set;
      following.pass += 1;
      here.push_back(mean_over_set(set, 7, 7, integrand));
      next_pass.push_back(mean_over_set(following, 7, 7, integrand));
      Sampler<float> s(set, 7, 7, k % 4), t(set, 40, 23, k % 4);
      other_pixel.push_back(double(t.get1(9)));
      x.push_back(double(s.get1(9)));
      other_dimension.push_back(double(s.get1(10)));
    }
    for (auto [a, b] : {std::pair{&here, &next_pass}, {&x, &other_dimension}, {&x, &other_pixel}}) {
      // Pixels of one Z curve are meant to be correlated a little.
      if (entry.kind == PointSetKind::blue_noise && b == &other_pixel) continue;
      EXPECT_GT(z_test(correlation(*a, *b), 1 / std::sqrt(double(n)), 0).p_value, level) << entry.name;
    }
    EXPECT_LT(z_test(correlation(here, here), 1 / std::sqrt(double(n)), 0).p_value, level);
  }
}

// Slope of log variance against log N between 16 and 1024 points, from 200 randomisations.
template <class Function>
double variance_slope(PointSetKind kind, Function f) {
  double log_variance[2];
  for (int i = 0; i < 2; ++i) {
    std::vector<double> means;
    for (std::uint32_t pass = 0; pass < 200; ++pass)
      means.push_back(mean_over_set({kind, 77, pass, i == 0 ? 16u : 1024u, 16, 16}, 3, 5, f));
    log_variance[i] = std::log(summarize(means).variance);
  }
  return (log_variance[1] - log_variance[0]) / std::log(64.0);
}

TEST(PointSet, variance_decays_at_the_rate_of_its_construction) {
  // Smooth integrands: N^-1 independent, N^-2 jittered in two dimensions, near N^-3 for scrambled nets (Owen 1997).
  // The log variance ratio of 200 realisations has a standard deviation of 0.034 in these units.
  const double five_sigma = 0.17;
  EXPECT_NEAR(variance_slope(PointSetKind::independent, integrand), -1, five_sigma);
  EXPECT_NEAR(variance_slope(PointSetKind::stratified, integrand), -2, five_sigma);
  for (PointSetKind kind : {PointSetKind::sobol, PointSetKind::padded_sobol, PointSetKind::blue_noise})
    EXPECT_LT(variance_slope(kind, integrand), -2.5) << name_of(kind);
  EXPECT_LT(variance_slope(PointSetKind::halton, integrand), -1.8);
  // An edge: N^-1.5 for every two-dimensional stratification.
  for (const NamedPointSet& entry : point_set_names) {
    if (entry.kind == PointSetKind::independent) continue;
    EXPECT_LT(variance_slope(entry.kind, disc), -1.5 + 0.2) << entry.name;
  }
}

TEST(PointSet, realisations_are_unbiased) {
  const double truth = integrate2([](double x, double y) { return std::exp(-3 * (x + 0.5 * y * y)); }, 0, 1, 0, 1);
  for (const NamedPointSet& entry : point_set_names)
    for (std::uint32_t n : {1u, 5u, 16u}) {
      std::vector<double> means;
      for (std::uint32_t pass = 0; pass < 4000; ++pass)
        means.push_back(mean_over_set({entry.kind, 1, pass, n, 32, 32}, 20, 30, integrand));
      EXPECT_GT(t_test(means, truth).p_value, level) << entry.name << n;
      EXPECT_LT(t_test(means, 1.2 * truth).p_value, level) << entry.name << n;
    }
}

// The screen's error after a 3x3 box blur, against that of white noise, with one point to a pixel.
TEST(PointSet, blue_noise_leaves_less_error_after_a_blur) {
  const std::uint32_t side = 32;
  const auto blurred_variance = [&](PointSetKind kind) {
    std::vector<double> blurred;
    for (std::uint32_t pass = 0; pass < 8; ++pass) {
      std::vector<double> image;
      for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x)
          image.push_back(mean_over_set({kind, 3, pass, 1, side, side}, x, y, integrand));
      for (std::uint32_t y = 1; y + 1 < side; ++y)
        for (std::uint32_t x = 1; x + 1 < side; ++x) {
          double sum = 0;
          for (std::uint32_t j = 0; j < 3; ++j)
            for (std::uint32_t i = 0; i < 3; ++i) sum += image[(y + j - 1) * side + x + i - 1];
          blurred.push_back(sum / 9);
        }
    }
    return summarize(blurred).variance;
  };
  EXPECT_LT(blurred_variance(PointSetKind::blue_noise), 0.5 * blurred_variance(PointSetKind::independent));
  EXPECT_GT(blurred_variance(PointSetKind::padded_sobol), 0.8 * blurred_variance(PointSetKind::independent));
}

}  // namespace
}  // namespace montelux
