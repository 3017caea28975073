// The adaptive map: monotone, onto, with the Jacobian that is its derivative, and drawn to where the integrand is
// large.
#include "mc/adaptive_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics.h"

namespace montelux {
namespace {

// Trained towards a narrow peak at 0.3 in the first axis and an edge at 0.6 in the second.
AdaptiveMap trained_map() {
  AdaptiveMap map(2, 32);
  for (int step = 0; step < 8; ++step) {
    std::vector<double> sums(2 * map.bins());
    for (std::size_t b = 0; b < map.bins(); ++b) {
      std::vector<double> x{(double(b) + 0.5) / double(map.bins()), (double(b) + 0.5) / double(map.bins())}, j{1.0};
      map.apply(x, j);
      const auto width = [&](std::size_t d) { return (map.nodes(d)[b + 1] - map.nodes(d)[b]) * double(map.bins()); };
      const double f = std::exp(-1000 * (x[0] - 0.3) * (x[0] - 0.3)), g = x[1] < 0.6 ? 1.0 : 0.0;
      sums[b] = f * f * width(0) * width(0);
      sums[map.bins() + b] = g * width(1) * width(1);
    }
    map.refine(sums, 32);
  }
  return map;
}

struct Mapped {
  double x, jacobian;
};
// The image of the point with y on one axis and 1/2 on the other, and its Jacobian.
Mapped at(const AdaptiveMap& map, std::size_t axis, double y) {
  std::vector<double> p(2, 0.5), j{1.0};
  p[axis] = y;
  map.apply(p, j);
  return {p[axis], j[0]};
}

TEST(AdaptiveMap, starts_as_the_identity) {
  const AdaptiveMap map(3, 10);
  std::vector<double> x{0.1, 0.77, 0.5}, j{1.0};
  map.apply(x, j);
  EXPECT_NEAR(x[0], 0.1, 1e-15);
  EXPECT_NEAR(x[1], 0.77, 1e-15);
  EXPECT_NEAR(j[0], 1.0, 1e-14);
}

TEST(AdaptiveMap, the_jacobian_is_the_derivative_and_positive) {
  const AdaptiveMap map = trained_map();
  for (std::size_t axis : {0, 1}) {
    // The factor of the other axis at 1/2 follows from its own difference quotient.
    const double h = 1e-7;
    const double other = (at(map, 1 - axis, 0.5 + h).x - at(map, 1 - axis, 0.5 - h).x) / (2 * h);
    for (double y = 0.011; y < 1; y += 0.037) {
      const double slope = (at(map, axis, y + h).x - at(map, axis, y - h).x) / (2 * h);
      const double jacobian = at(map, axis, y).jacobian;
      EXPECT_GT(jacobian, 0);
      EXPECT_NEAR(jacobian / (slope * other), 1, 1e-4) << axis << " " << y;
    }
  }
}

TEST(AdaptiveMap, the_mean_jacobian_is_the_volume_of_the_cube) {
  const AdaptiveMap map = trained_map();
  const auto jacobian = [&](double y, double z) {
    std::vector<double> p{y, z}, j{1.0};
    map.apply(p, j);
    return j[0];
  };
  EXPECT_NEAR(test::integrate2(jacobian, 0, 1, 0, 1, 32), 1, 1e-12);
}

TEST(AdaptiveMap, points_go_where_the_integrand_is_large) {
  const AdaptiveMap map = trained_map();
  int near_peak = 0, below_edge = 0;
  for (int i = 0; i < 1000; ++i) {
    near_peak += std::abs(at(map, 0, (i + 0.5) / 1000).x - 0.3) < 0.1;
    below_edge += at(map, 1, (i + 0.5) / 1000).x < 0.6;
  }
  EXPECT_GT(near_peak, 700);
  EXPECT_GT(below_edge, 850);
}

TEST(AdaptiveMap, bins_grow_gradually_on_both_sides_of_an_edge) {
  const AdaptiveMap map = trained_map();
  const auto x = map.nodes(1);
  for (std::size_t b = 1; b + 1 < x.size(); ++b) {
    const double left = x[b] - x[b - 1], right = x[b + 1] - x[b];
    EXPECT_LT(std::max(left / right, right / left), 4) << b;
  }
}

}  // namespace
}  // namespace montelux
