#include "math/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace montelux {
namespace {

void expect_near(const Matrix4& a, const Matrix4& b, double tolerance = 1e-12) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(a.m[i][j], b.m[i][j], tolerance) << i << ", " << j;
}

TEST(Motion, is_what_was_stated_at_its_ends_and_beyond) {
  const Transform a = translate(1, 2, 3) * rotate(20, 1, 0, 1) * scale(1, -2, 3), b = rotate(50, 0, 1, 0);
  const Motion motion(a, b);
  for (double t : {-1.0, 0.0}) EXPECT_EQ(motion.at(t).matrix(), a.matrix());
  for (double t : {1.0, 2.0}) EXPECT_EQ(motion.at(t).matrix(), b.matrix());
}

TEST(Motion, turns_at_constant_speed) {
  const Motion motion(rotate(10, 1, 2, 3), rotate(130, 1, 2, 3));
  EXPECT_NEAR(motion.angle(), 120 * std::numbers::pi / 180, 1e-12);
  for (double t : {0.125, 0.25, 0.5, 0.75}) expect_near(motion.at(t).matrix(), rotate(10 + 120 * t, 1, 2, 3).matrix());
}

TEST(Motion, takes_the_shorter_way_around) {
  const Motion motion(rotate(0, 0, 0, 1), rotate(270, 0, 0, 1));
  expect_near(motion.at(0.5).matrix(), rotate(-45, 0, 0, 1).matrix());
}

TEST(Motion, shifts_and_stretches_on_straight_lines) {
  const Motion motion(translate(1, 2, 3) * scale(1, 1, 2), translate(3, 2, -1) * scale(2, 3, 2));
  expect_near(motion.at(0.25).matrix(), (translate(1.5, 2, 2) * scale(1.25, 1.5, 2)).matrix());
  EXPECT_EQ(motion.angle(), 0);
  EXPECT_EQ(motion.steps(), 1);
}

TEST(Motion, keeps_a_mirror_a_mirror_while_it_turns) {
  const Motion motion(scale(-1, 1, 1), rotate(90, 0, 0, 1) * scale(-1, 1, 1));
  for (double t : {0.25, 0.5, 0.75})
    expect_near(motion.at(t).matrix(), (rotate(90 * t, 0, 0, 1) * scale(-1, 1, 1)).matrix());
}

TEST(Motion, puts_any_map_together_again) {
  const Transform a = translate(1, 2, 3) * rotate(20, 1, 0, 1) * scale(1, 2, 3) * rotate(70, 3, 1, 0) * scale(5, 1, -1);
  const MotionKey key = decompose(a);
  // T R S with R from its quaternion, by hand.
  const auto [x, y, z, w] = key.rotation;
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += r[i][k] * key.stretch[3 * k + j];
      EXPECT_NEAR(sum, a.matrix().m[i][j], 1e-10);
    }
    EXPECT_EQ(key.translation[i], a.matrix().m[i][3]);
  }
}

TEST(Motion, is_the_same_in_lanes_as_in_double) {
  const Motion motion(translate(1, 2, 3) * rotate(20, 1, 0, 1) * scale(1, 2, 3),
                      translate(-4, 2, 1) * rotate(150, 0, 2, 1) * scale(2, 2, 1));
  using F = NativeFloats;
  F time;
  for (int k = 0; k < lanes_of<F>; ++k) set_lane(time, k, float(k) / float(lanes_of<F>));
  const Affine<F> pack = motion.at(time);
  for (int k = 0; k < lanes_of<F>; ++k) {
    const Transform one = motion.at(double(lane(time, k)));
    for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(lane(pack.m[i], k), one.rows()[i], 5e-6f);
  }
}

TEST(Motion, chords_of_its_steps_stay_as_close_to_it_as_is_said) {
  for (double angle : {5.0, 40.0, 179.0}) {
    const Motion motion(Transform(), rotate(angle, 0, 0, 1));
    const int n = motion.steps();
    double worst = 0;
    for (int i = 0; i < n; ++i) {
      const auto a = motion.at(double(i) / n).rows(), b = motion.at(double(i + 1) / n).rows();
      const auto c = motion.at((i + 0.5) / n).rows();
      worst = std::max(worst,
                       std::hypot(0.5 * double(a[0] + b[0]) - double(c[0]), 0.5 * double(a[4] + b[4]) - double(c[4])));
    }
    EXPECT_LT(worst, angle > 73 ? 7.7e-5 : 1.3e-5) << angle;
  }
}

TEST(Affine, normals_stay_at_right_angles_and_on_their_side) {
  const Transform map =
      translate(1, 2, 3) * rotate(20, 1, 0, 1) * scale(1, 2, 3) * rotate(70, 3, 1, 0) * scale(5, 1, -1);
  Affine<float> affine;
  std::copy(map.rows().begin(), map.rows().end(), affine.m);
  const Vec3f n = normalize(Vec3f{1, -2, 0.5f});
  const Vec3f a = normalize(affine.normal(n)), b = normalize(map.normal(n));
  EXPECT_LT(length(a - b), 1e-6f);
}

TEST(Motion, goes_through_all_maps_at_even_moments) {
  const std::vector<Transform> later{rotate(60, 0, 0, 1), translate(1, 0, 0) * rotate(90, 0, 0, 1),
                                     translate(1, 4, 0) * scale(2, 2, 2)};
  const Motion motion(Transform(), later);
  EXPECT_TRUE(motion.moves());
  EXPECT_NEAR(motion.angle(), std::numbers::pi / 2, 1e-12);
  expect_near(motion.at(1.0 / 6).matrix(), rotate(30, 0, 0, 1).matrix());
  expect_near(motion.at(0.5).matrix(), (translate(0.5, 0, 0) * rotate(75, 0, 0, 1)).matrix());
  expect_near(motion.at(5.0 / 6).matrix(), (translate(1, 2, 0) * rotate(45, 0, 0, 1) * scale(1.5, 1.5, 1.5)).matrix());
  for (double t : {1.0, 3.0}) expect_near(motion.at(t).matrix(), later.back().matrix());
  // Every map is at the end of a step.
  EXPECT_EQ(motion.steps() % 3, 0);
  EXPECT_LE(motion.steps(), 128);
}

TEST(Motion, through_many_maps_is_the_same_in_lanes) {
  std::vector<Transform> later;
  for (int i = 1; i <= 7; ++i) later.push_back(translate(i * i, -i, 1) * rotate(25 * i, 1, 2, i) * scale(1, i, 2));
  const Motion motion(Transform(), later);
  for (double t : {0.0, 0.1, 1.0 / 7, 0.33, 0.5, 0.9, 1.0}) {
    const Affine<float> one = motion.at(float(t));
    const Affine<NativeFloats> all = motion.at(NativeFloats(float(t)));
    for (std::size_t i = 0; i < 12; ++i) {
      EXPECT_EQ(one.m[i], lane(all.m[i], 0));
      EXPECT_NEAR(one.m[i], motion.at(t).matrix().m[i / 4][i % 4], 1e-4);
    }
  }
  EXPECT_EQ(Motion(Transform(), std::vector<Transform>{later[0]}).at(0.3).matrix(),
            Motion(Transform(), later[0]).at(0.3).matrix());
  EXPECT_FALSE(Motion(Transform(), std::vector<Transform>{}).moves());
}

}  // namespace
}  // namespace montelux
