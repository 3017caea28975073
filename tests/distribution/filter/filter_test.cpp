// Every filter against its published formula in double precision.
#include "filter/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "mc/random.h"
#include "statistics.h"

namespace montelux {
namespace {

using test::family_level;
constexpr int samples = 400000;

struct Case {
  const char* name;
  double radius;
  std::function<double(double)> profile;  // of one axis, any scale
};

double sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

double mitchell(double x) {
  double b = 1.0 / 3, c = 1.0 / 3, t = std::abs(x);
  if (t >= 2) return 0;
  if (t < 1) return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + (6 - 2 * b)) / 6;
  return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t + (8 * b + 24 * c)) / 6;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"box", 0.5, [](double) { return 1.0; }},
      {"gaussian", 1.5, [](double x) { return std::exp(-2 * x * x) - std::exp(-2 * 1.5 * 1.5); }},
      {"mitchell", 2.0, mitchell},
      {"sinc", 4.0, [](double x) { return sinc(x) * sinc(x / 3); }},
      {"triangle", 2.0, [](double x) { return 2 - std::abs(x); }},
  };
  return all;
}

Filter built(const std::string& name) {
  const auto place = std::ranges::find(filter_names, name);
  return Filter::build(FilterDesc::usual(FilterKind(place - filter_names.begin())));
}

// The integral of f over [a, b], midpoint rule.
double integral(const std::function<double(double)>& f, double a, double b, int n = 4000) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(a + (i + 0.5) * (b - a) / n);
  return sum * (b - a) / n;
}

// p-value of Pearson's test of sampled offsets on a grid of cells x cells against the magnitude of the profile.
double offsets_match(const Filter& filter, const Case& expected, int cells) {
  double whole = integral([&](double x) { return std::abs(expected.profile(x)); }, -expected.radius, expected.radius);
  std::vector<double> mass(cells);
  double step = 2 * expected.radius / cells;
  for (int i = 0; i < cells; ++i)
    mass[i] = integral([&](double x) { return std::abs(expected.profile(x)); }, -expected.radius + i * step,
                       -expected.radius + (i + 1) * step) /
              whole;
  std::vector<double> counts(cells * cells);
  RandomStream<float> random(12u, 34u);
  for (int k = 0; k < samples; ++k) {
    Vec2f p = filter.sample(random.next2()).offset;
    int i = std::min(cells - 1, int((p.x + expected.radius) / step));
    int j = std::min(cells - 1, int((p.y + expected.radius) / step));
    counts[j * cells + i] += 1;
  }
  std::vector<double> expectations;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) expectations.push_back(mass[i] * mass[j] * samples);
  return test::chi_square_test(counts, expectations).p_value;
}

// The least two-sided p-value, times their number, over 40 strips across x: does the mean weight that falls into a
// strip equal the integral of the normalised filter over it?
double strips_match(const std::function<FilterSample<float>(Vec2f)>& sample, const Case& expected) {
  const int strips = 40;
  double a = -expected.radius, step = 2 * expected.radius / strips;
  double whole = integral(expected.profile, a, -a);
  std::vector<double> sum(strips), squares(strips);
  RandomStream<float> random(91u, 11u);
  for (int k = 0; k < samples; ++k) {
    FilterSample<float> s = sample(random.next2());
    int i = std::min(strips - 1, int((s.offset.x - a) / step));
    sum[i] += s.weight, squares[i] += double(s.weight) * s.weight;
  }
  double smallest = 1;
  for (int i = 0; i < strips; ++i) {
    double truth = integral(expected.profile, a + i * step, a + (i + 1) * step) / whole, mean = sum[i] / samples;
    double error = std::sqrt((squares[i] / samples - mean * mean) / samples);
    smallest = std::min(smallest, test::z_test(mean, error, truth).p_value);
  }
  return smallest * strips;
}

// Two-sided p-value: does the mean of weight * g over samples equal the integral of f g for the normalised filter?
double filtered_value_matches(const std::function<FilterSample<float>(Vec2f)>& sample, const Case& expected) {
  auto g = [](double x, double y) { return std::cos(0.9 * x + 0.3) * (1 + 0.5 * y * y + y); };
  double a = -expected.radius, b = expected.radius;
  double whole = integral(expected.profile, a, b);
  double cos_part = integral([&](double x) { return expected.profile(x) * std::cos(0.9 * x + 0.3); }, a, b) / whole;
  double y_part = integral([&](double y) { return expected.profile(y) * (1 + 0.5 * y * y + y); }, a, b) / whole;
  double mean = 0, m2 = 0;
  RandomStream<float> random(56u, 78u);
  for (int k = 1; k <= samples; ++k) {
    FilterSample<float> s = sample(random.next2());
    double value = s.weight * g(s.offset.x, s.offset.y), delta = value - mean;
    mean += delta / k;
    m2 += delta * (value - mean);
  }
  double error = std::sqrt(m2 / samples / (samples - 1));
  return test::z_test(mean, error, cos_part * y_part).p_value;
}

TEST(Filter, offsets_are_distributed_as_the_magnitude_of_the_filter) {
  double level = family_level / double(cases().size());
  for (const Case& c : cases()) EXPECT_GT(offsets_match(built(c.name), c, 10), level) << c.name;
}

TEST(Filter, offsets_of_a_slightly_wider_gaussian_are_rejected) {
  Filter wrong(GaussianFilter({1.5f, 0.505f}, {1.5f, 0.505f}));
  EXPECT_LT(offsets_match(wrong, cases()[1], 10), 1e-4);
}

TEST(Filter, weights_make_every_strip_exact_whatever_the_table) {
  double level = family_level / double(cases().size());
  for (const Case& c : cases()) {
    Filter filter = built(c.name);
    EXPECT_GT(strips_match([&](Vec2f u) { return filter.sample(u); }, c), level) << c.name;
  }
}

TEST(Filter, weights_that_are_only_a_sign_are_rejected_in_the_strips) {
  Filter filter = built("sinc");
  double magnitude =
      integral([](double x) { return std::abs(cases()[3].profile(x)); }, -4, 4) / integral(cases()[3].profile, -4, 4);
  auto signed_constant = [&](Vec2f u) {
    FilterSample<float> s = filter.sample(u);
    s.weight = std::copysign(float(magnitude * magnitude), s.weight);
    return s;
  };
  EXPECT_LT(strips_match(signed_constant, cases()[3]), 1e-4);
}

TEST(Filter, weights_average_to_the_filtered_value) {
  double level = family_level / double(cases().size());
  for (const Case& c : cases()) {
    Filter filter = built(c.name);
    EXPECT_GT(filtered_value_matches([&](Vec2f u) { return filter.sample(u); }, c), level) << c.name;
  }
}

TEST(Filter, weights_that_lose_their_sign_are_rejected) {
  for (const Case& c : cases()) {
    if (std::string(c.name) != "mitchell" && std::string(c.name) != "sinc") continue;
    Filter filter = built(c.name);
    auto unsigned_sample = [&](Vec2f u) {
      FilterSample<float> s = filter.sample(u);
      s.weight = std::abs(s.weight);
      return s;
    };
    EXPECT_LT(filtered_value_matches(unsigned_sample, c), 1e-6) << c.name;
  }
}

TEST(Filter, weights_of_tabulated_filters_have_mean_one_by_quadrature) {
  for (const Case& c : cases()) {
    Filter filter = built(c.name);
    // The weight along x alone, at a fixed u.y, is the one along y at that place times a function of mean 1.
    const int n = 1 << 16;
    double mean = 0, fixed = filter.sample(Vec2f{0.5f + 0.25f / 1024, 0.61f}).weight;
    for (int i = 0; i < n; ++i) mean += filter.sample(Vec2f{(float(i) + 0.5f) / n, 0.61f}).weight / double(n);
    double centre = c.profile(0) / integral(c.profile, -c.radius, c.radius);
    double magnitude = integral([&](double x) { return std::abs(c.profile(x)); }, -c.radius, c.radius) /
                       integral(c.profile, -c.radius, c.radius);
    EXPECT_GT(centre, 0);
    // The table has steps at multiples of the nodes' distance: the remainder is the rounding of single numbers.
    EXPECT_NEAR(fixed / mean, magnitude, 1e-5) << c.name;
  }
}

TEST(Filter, value_integrates_to_one_and_agrees_with_its_formula) {
  for (const Case& c : cases()) {
    Filter filter = built(c.name);
    double whole = integral(c.profile, -c.radius, c.radius);
    EXPECT_FLOAT_EQ(filter.radius().x, float(c.radius));
    double sum = 0;
    const int n = 800;
    double step = 2 * c.radius / n;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        double x = -c.radius + (i + 0.5) * step, y = -c.radius + (j + 0.5) * step;
        double value = filter.evaluate(Vec2f{float(x), float(y)});
        sum += value * step * step;
        ASSERT_NEAR(value, c.profile(x) * c.profile(y) / (whole * whole), 3e-6) << c.name << " " << x << " " << y;
      }
    EXPECT_NEAR(sum, 1, 2e-5) << c.name;
    EXPECT_EQ(filter.evaluate(Vec2f{float(c.radius) + 0.01f, 0.0f}), 0) << c.name;
  }
}

TEST(Filter, a_lane_gives_the_bits_of_a_float) {
  using F = NativeFloats;
  RandomStream<float> random(1u, 2u);
  for (const Case& c : cases()) {
    Filter filter = built(c.name);
    for (int round = 0; round < 200; ++round) {
      Vec2<F> u;
      for (int k = 0; k < native_lanes; ++k) set_lane(u, k, random.next2());
      FilterSample<F> pack = filter.sample(u);
      for (int k = 0; k < native_lanes; ++k) {
        FilterSample<float> one = filter.sample(lane(u, k));
        ASSERT_EQ(lane(pack.offset.x, k), one.offset.x) << c.name;
        ASSERT_EQ(lane(pack.offset.y, k), one.offset.y) << c.name;
        ASSERT_EQ(lane(pack.weight, k), one.weight) << c.name;
      }
    }
  }
}

}  // namespace
}  // namespace montelux
