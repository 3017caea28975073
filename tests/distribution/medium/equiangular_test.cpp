// Distances by the angle under which a point sees a ray, against the law of that angle.
#include "medium/equiangular.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "mc/random.h"
#include "statistics.h"

namespace montelux::test {
namespace {

struct Line {
  const char* name;
  Vec3f o, d;
  float length;
  Vec3f point;
};

std::vector<Line> lines() {
  const Vec3f slanted = normalize(Vec3f{1, -2, 0.5f});
  const float endless = std::numeric_limits<float>::infinity();
  return {{"beside the middle", {0, 0, 0}, {0, 0, 1}, 4, {1, 0, 2}},
          {"close to the ray", {0, 0, 0}, {0, 0, 1}, 4, {0.001f, 0, 2.5f}},
          {"before the ray", {1, 2, 3}, slanted, 3, {0.5f, 3.2f, 2.6f}},
          {"beyond the ray", {0, 0, 0}, {0, 1, 0}, 2, {0.3f, 5, 0.1f}},
          {"without an end", {0, 0, 0}, {1, 0, 0}, endless, {3, 0.5f, -0.5f}},
          {"without an end, far behind", {0, 0, 0}, {1, 0, 0}, endless, {-10, 0.01f, 0}},
          {"far away", {0, 0, 0}, {0, 0, 1}, 1, {300, 100, 40}}};
}

// In double precision: the angle at the point from the ray's start to this distance, as a share of the whole. A `bias`
// moves the point along the ray.
double share_before(const Line& line, double t, double bias = 0) {
  const Vec3f v = line.o - line.point;
  const double along = double(v.x) * double(line.d.x) + double(v.y) * double(line.d.y) + double(v.z) * double(line.d.z);
  const double squared = double(v.x) * double(v.x) + double(v.y) * double(v.y) + double(v.z) * double(v.z);
  const double gap = std::sqrt(squared - along * along), start = along * (1 + bias);
  const auto angle = [&](double end) {
    if (std::isinf(end)) return std::atan2(gap, start);
    return std::atan2(gap * end, gap * gap + start * (start + end));
  };
  return angle(t) / angle(double(line.length));
}

TEST(EquiangularDistances, are_uniform_in_the_angle_and_a_point_elsewhere_is_found) {
  constexpr int samples = 100000, bins = 40;
  const double level = sidak_level(family_level, double(lines().size()));
  for (const Line& line : lines()) {
    SCOPED_TRACE(line.name);
    const EquiangularDistances<float> distances(line.o, line.d, line.length, line.point);
    RandomStream<float> random(11, 4);
    std::vector<double> counts(bins, 0.0), wrong = counts;
    const std::vector<double> expected(bins, double(samples) / bins);
    for (int i = 0; i < samples; ++i) {
      const float t = distances.sample(random.next());
      ASSERT_GE(t, 0);
      ASSERT_LE(t, line.length);
      for (const auto& [bias, into] : {std::pair(0.0, &counts), std::pair(0.1, &wrong)}) {
        const auto bin = std::size_t(share_before(line, double(t), bias) * bins);
        (*into)[std::min(bin, std::size_t(bins - 1))] += 1;
      }
    }
    EXPECT_GT(chi_square_test(counts, expected).p_value, level);
    // From far away all distances are equally likely.
    if (std::string(line.name) != "far away") {
      EXPECT_LT(chi_square_test(wrong, expected).p_value, level);
    }
  }
}

TEST(EquiangularDistances, have_the_density_of_their_law) {
  for (const Line& line : lines()) {
    SCOPED_TRACE(line.name);
    const EquiangularDistances<float> distances(line.o, line.d, line.length, line.point);
    for (const float u : {0.01f, 0.2f, 0.5f, 0.8f, 0.99f}) {
      const double t = double(distances.sample(u)), step = 1e-7 * t;
      EXPECT_NEAR(share_before(line, t), double(u), 1e-4);
      const double slope = (share_before(line, t + step) - share_before(line, t - step)) / (2 * step);
      EXPECT_NEAR(double(distances.density(float(t))) / slope, 1, 1e-3) << u;
    }
  }
}

TEST(EquiangularDistances, from_a_point_on_the_ray_are_sound) {
  const EquiangularDistances<float> distances({0, 0, 0}, {0, 0, 1}, 5, {0, 0, 2});
  for (const float u : {0.0f, 0.3f, 0.5f, 0.999f}) {
    const float t = distances.sample(u);
    EXPECT_TRUE(t >= 0 && t <= 5) << u;
    EXPECT_TRUE(std::isfinite(distances.density(t)) && distances.density(t) > 0) << u;
  }
}

TEST(EquiangularDistances, are_the_same_in_lanes) {
  using P = NativeFloats;
  const Line line = lines()[2];
  const EquiangularDistances<P> distances(splat<P>(line.o), splat<P>(line.d), P(line.length), splat<P>(line.point));
  const EquiangularDistances<float> one(line.o, line.d, line.length, line.point);
  RandomStream<P> random(Uint<P>(5u), lane_index<P>());
  const P u = random.next(), t = distances.sample(u), density = distances.density(t);
  for (int k = 0; k < lanes_of<P>; ++k) {
    EXPECT_NEAR(lane(t, k), one.sample(lane(u, k)), 1e-5f);
    EXPECT_NEAR(lane(density, k), one.density(lane(t, k)), 1e-5f);
  }
}

}  // namespace
}  // namespace montelux::test
