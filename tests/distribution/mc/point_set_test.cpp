#include "mc/point_set.h"

#include <gtest/gtest.h>

#include "mc/digital.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

// The tests of this file that give a p-value: per kind uniformity (2), correlation (3), bias (3), decay (2), and a few.
constexpr double tests_of_the_suite = double(point_set_names.size()) * 10 + 8;
const double level = sidak_level(family_level, tests_of_the_suite);

// One point of each of many realisations: whatever the correlation inside a set, these are independent.
template <class Fault>
TestResult uniformity(PointSetKind kind, std::uint32_t dimension, Fault fault) {
  std::uint32_t n = 0;
  return chi_square_square(
      [&](RandomStream<float>&) {
        const std::uint32_t pass = n / 16, index = n % 16;
        ++n;
        PointSet set{kind, 21, pass, 16};
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

TEST(PointSet, uniformity_test_rejects_points_whose_scramble_is_missing) {
  std::uint32_t n = 0;
  TestResult r = chi_square_square(
      [&](RandomStream<float>&) {
        const std::uint32_t index = n++ % 16;
        return Vec2f{fraction_of_reversed<float>(index), fraction_of_reversed<float>(multiply_by_pascal(index))};
      },
      [](double, double) { return 1.0; }, {16, 16}, 64000, 1);
  EXPECT_LT(r.p_value, level);
}

// Estimates of one integral: over passes, over distant pixels, and over dimensions they must not be correlated.
TEST(PointSet, passes_pixels_and_dimensions_are_uncorrelated) {
  for (const NamedPointSet& entry : point_set_names) {
    std::vector<double> here, next_pass, other_pixel, x, other_dimension;
    const std::uint32_t n = 20000;
    for (std::uint32_t k = 0; k < n; ++k) {
      PointSet set{entry.kind, 5, 2 * k, 4}, following = set;
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

// The variance over randomisations of the mean over n points.
template <class Function>
SampleSummary variance_over_passes(PointSetKind kind, std::uint32_t n, Function f) {
  return variance_summary([&](std::uint32_t pass) { return mean_over_set({kind, 77, pass, n}, 3, 5, f); }, 1000);
}
template <class Function>
Exponent variance_slope(PointSetKind kind, Function f) {
  return measured_exponent(variance_over_passes(kind, 16, f), variance_over_passes(kind, 1024, f), 64);
}

// The variance of the mean of one point in each of side x side squares, by quadrature.
double variance_of_jittered(int side) {
  double sum = 0;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const auto moment = [&](int power) {
        return side * side *
               integrate2([&](double x, double y) { return std::pow(std::exp(-3 * (x + 0.5 * y * y)), power); },
                          double(i) / side, double(i + 1) / side, double(j) / side, double(j + 1) / side, 1);
      };
      sum += moment(2) - moment(1) * moment(1);
    }
  return sum / std::pow(side, 4);
}

TEST(PointSet, variance_of_independent_and_of_jittered_points_is_that_of_theory) {
  for (const std::uint32_t side : {4u, 32u}) {
    const std::uint32_t n = side * side;
    for (auto [kind, truth] : {std::pair{PointSetKind::independent, variance_of_jittered(1) / n},
                               {PointSetKind::stratified, variance_of_jittered(int(side))}}) {
      const SampleSummary measured = variance_over_passes(kind, n, integrand);
      EXPECT_GT(t_test(measured, truth).p_value, level) << name_of(kind) << " " << measured.mean << " for " << truth;
      EXPECT_LT(t_test(measured, 1.5 * truth).p_value, level) << name_of(kind);
    }
  }
}

TEST(PointSet, variance_decays_at_the_rate_of_its_construction) {
  // The p-value of "the variance falls no faster than N^exponent" between 16 and 1024 points.
  const auto slower = [](PointSetKind kind, auto f, double exponent) {
    const Exponent e = variance_slope(kind, f);
    return at_least_p_value(e.value, e.standard_error, exponent);
  };
  // Smooth integrands: near N^-3 for scrambled nets (Owen 1997); higher dimensions of one Sobol' sequence form poorer
  // nets, still better than jittered points.
  for (PointSetKind kind : {PointSetKind::padded_sobol, PointSetKind::blue_noise})
    EXPECT_LT(slower(kind, integrand, -2.5), level) << name_of(kind);
  EXPECT_LT(slower(PointSetKind::sobol, integrand, -2.1), level);
  EXPECT_LT(slower(PointSetKind::halton, integrand, -1.8), level);
  EXPECT_GT(slower(PointSetKind::stratified, integrand, -2.5), level);
  EXPECT_GT(slower(PointSetKind::independent, integrand, -1.8), level);
  // An edge: N^-1.5 for every two-dimensional stratification, in the limit.
  for (const NamedPointSet& entry : point_set_names) {
    if (entry.kind == PointSetKind::independent) continue;
    EXPECT_LT(slower(entry.kind, disc, -1.3), level) << entry.name;
  }
  EXPECT_GT(slower(PointSetKind::independent, disc, -1.3), level);
}

TEST(PointSet, realisations_are_unbiased) {
  const double truth = integrate2([](double x, double y) { return std::exp(-3 * (x + 0.5 * y * y)); }, 0, 1, 0, 1);
  for (const NamedPointSet& entry : point_set_names)
    for (std::uint32_t n : {1u, 5u, 16u}) {
      std::vector<double> means;
      for (std::uint32_t pass = 0; pass < 4000; ++pass)
        means.push_back(mean_over_set({entry.kind, 1, pass, n}, 20, 30, integrand));
      EXPECT_GT(t_test(means, truth).p_value, level) << entry.name << n;
      EXPECT_LT(t_test(means, 1.2 * truth).p_value, level) << entry.name << n;
    }
}

// The screen's error after a 3x3 box blur, against that of white noise, with one point to a pixel.
TEST(PointSet, blue_noise_leaves_less_error_after_a_blur) {
  const std::uint32_t side = 32;
  const double truth = integrate2([](double x, double y) { return std::exp(-3 * (x + 0.5 * y * y)); }, 0, 1, 0, 1);
  const auto blurred_error = [&](PointSetKind kind, std::uint32_t pass) {
    std::vector<double> image;
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        image.push_back(mean_over_set({kind, 3, pass, 1}, x, y, integrand) - truth);
    double squares = 0;
    for (std::uint32_t y = 1; y + 1 < side; ++y)
      for (std::uint32_t x = 1; x + 1 < side; ++x) {
        double sum = 0;
        for (std::uint32_t j = 0; j < 3; ++j)
          for (std::uint32_t i = 0; i < 3; ++i) sum += image[(y + j - 1) * side + x + i - 1];
        squares += (sum / 9) * (sum / 9);
      }
    return squares;
  };
  // Over 400 passes: how much of the error of independent points, times `factor`, is saved.
  const auto saving = [&](PointSetKind kind, double factor) {
    std::vector<double> saved;
    for (std::uint32_t pass = 0; pass < 400; ++pass)
      saved.push_back(factor * blurred_error(PointSetKind::independent, pass) - blurred_error(kind, pass));
    return summarize(saved);
  };
  const auto not_below = [&](PointSetKind kind, double factor) {
    const SampleSummary s = saving(kind, factor);
    return at_most_p_value(s.mean, s.standard_error(), 0);
  };
  EXPECT_LT(not_below(PointSetKind::blue_noise, 0.5), level);
  // Pixels that know nothing of each other are no better than white noise.
  EXPECT_GT(not_below(PointSetKind::padded_sobol, 0.9), 1 - level);
}

}  // namespace
}  // namespace montelux
