// Samples that pixels share, against the published formula of every filter in double precision.
#include "filter/sample_sharing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace montelux {
namespace {

double sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

double mitchell(double x) {
  const double b = 1.0 / 3, c = 1.0 / 3, t = std::abs(x);
  if (t >= 2) return 0;
  if (t < 1) return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + (6 - 2 * b)) / 6;
  return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t + (8 * b + 24 * c)) / 6;
}

double clipped(double x, double radius, double value) { return std::abs(x) < radius ? value : 0; }

struct Case {
  FilterKind kind;
  float radius;
  std::function<double(double)> profile;  // of one axis, any scale
  bool negative = false;                  // somewhere
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {FilterKind::box, 0.5f, [](double x) { return clipped(x, 0.5, 1); }},
      {FilterKind::box, 0.8f, [](double x) { return clipped(x, 0.8f, 1); }},
      {FilterKind::gaussian, 1.5f,
       [](double x) { return clipped(x, 1.5, std::exp(-2 * x * x) - std::exp(-2 * 1.5 * 1.5)); }},
      {FilterKind::mitchell, 2, mitchell, true},
      {FilterKind::sinc, 4, [](double x) { return clipped(x, 4, sinc(x) * sinc(x / 3)); }, true},
      {FilterKind::triangle, 1, [](double x) { return std::max(1 - std::abs(x), 0.0); }},
      {FilterKind::triangle, 2, [](double x) { return std::max(2 - std::abs(x), 0.0); }},
  };
  return all;
}

Filter built(const Case& of) {
  FilterDesc filter = FilterDesc::usual(of.kind);
  filter.x_radius = of.radius;  // along y the usual one
  return Filter::build(filter);
}

double integral(const std::function<double(double)>& f, double a, double b, int n = 20000) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(a + (i + 0.5) * (b - a) / n);
  return sum * (b - a) / n;
}

// The mean, over all places at which the samples of pixels may lie, of what a half-plane x < edge counts in pixel 0.
// `mirrored` plants a fault: the pixels on the other side take the weights.
double part_below(const SampleSharing& sharing, double edge, bool mirrored = false) {
  constexpr int steps = 1 << 15;
  double sum = 0;
  const int reach = sharing.reach_x();
  for (int i = 0; i < steps; ++i) {
    const SampleSharing::Weights weights = sharing.at({(float(i) + 0.5f) / steps, 0.5f});
    for (int j = -reach; j <= reach; ++j) {
      // The sample of the pixel -j counts for pixel 0, which is j beside it.
      const double place = double(weights.offset.x) - j;
      if (place < edge) sum += double(weights.x[std::size_t((mirrored ? -j : j) + reach)]) / steps;
    }
  }
  return sum;
}

TEST(SampleSharing, weighs_places_as_the_filter_does) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(name_of(c.kind));
    const SampleSharing sharing(built(c));
    const double radius = double(c.radius), all = integral(c.profile, -radius, radius);
    double worst = 0, worst_of_fault = 0;
    for (const double edge : {-1.7, -0.9, -0.45, 0.1, 0.35, 0.6, 1.2, 9.0}) {
      const double expected = integral(c.profile, -radius, std::clamp(edge, -radius, radius)) / all;
      worst = std::max(worst, std::abs(part_below(sharing, edge) - expected));
      worst_of_fault = std::max(worst_of_fault, std::abs(part_below(sharing, edge, true) - expected));
    }
    // Each of the 2^15 places has about that share of the whole.
    EXPECT_LT(worst, 2.0 / (1 << 15));
    EXPECT_TRUE(sharing.reach_x() == 0 || worst_of_fault > 0.01) << worst_of_fault;
  }
}

TEST(SampleSharing, has_weights_whose_sum_is_one) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(name_of(c.kind));
    const SampleSharing sharing(built(c));
    EXPECT_EQ(sharing.reach_x(), int(std::ceil(c.radius - 0.5f)));
    for (int i = 0; i < 1000; ++i) {
      const SampleSharing::Weights weights = sharing.at({(float(i) + 0.5f) / 1000, 0.3f});
      double x = 0, y = 0;
      for (const float w : weights.x) x += double(w);
      for (const float w : weights.y) y += double(w);
      EXPECT_GE(weights.offset.x, -0.5f);
      EXPECT_LE(weights.offset.x, 0.5f);
      // A box of a width that is no multiple of a pixel has steps within a cell of the table.
      const bool has_steps = c.kind == FilterKind::box && c.radius > 0.5f;
      const bool at_step = has_steps && std::abs(std::abs(weights.offset.x) - 0.2f) < 0.01f;
      EXPECT_TRUE(at_step || std::abs(x - 1) < 1e-4) << x;
      EXPECT_NEAR(y, 1, 1e-4);
    }
  }
}

TEST(SampleSharing, states_how_much_noise_is_left) {
  const auto share = [](FilterKind kind, float radius) {
    FilterDesc filter = FilterDesc::usual(kind);
    filter.x_radius = filter.y_radius = radius;
    return SampleSharing(Filter::build(filter)).noise();
  };
  // Except for the rounding of weights to 2^-20, of which at most nine are squared.
  EXPECT_NEAR(share(FilterKind::box, 0.5f), 1, 1e-5);
  EXPECT_NEAR(share(FilterKind::box, 1), 0.25, 1e-5);  // means over 2 x 2 pixels
  EXPECT_NEAR(share(FilterKind::triangle, 1), 4.0 / 9, 1e-5);
  EXPECT_NEAR(share(FilterKind::triangle, 2), 1.0 / 9, 1e-5);
  // In general the integral of f^2 over the sum of f over the grid, squared for both axes.
  for (const Case& c : cases()) {
    if (c.kind != FilterKind::gaussian && c.kind != FilterKind::mitchell) continue;
    const double all = integral(c.profile, -double(c.radius), double(c.radius));
    const double of_axis = integral(
        [&](double x) {
          double sum = 0, squares = 0;
          for (int j = -4; j <= 4; ++j) {
            const double f = c.profile(x - j) / all;
            sum += f, squares += f * f;
          }
          return squares / sum;
        },
        -0.5, 0.5);
    EXPECT_NEAR(share(c.kind, c.radius), of_axis * of_axis, 1e-4) << name_of(c.kind);
    const double magnitude =
        integral([&](double x) { return std::abs(c.profile(x)); }, -double(c.radius), double(c.radius)) / all;
    EXPECT_NEAR(SampleSharing(built(c)).noise_of_own_samples(), std::pow(magnitude, 4), 1e-3);
  }
}

}  // namespace
}  // namespace montelux
