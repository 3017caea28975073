#include "math/lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "math/functions.h"
#include "math/transform.h"
#include "math/write_lanes.h"

namespace montelux {
namespace {

using F = NativeFloats;

template <class Function>
void expect_same_bits_in_lane_and_float(float low, float high, Function f) {
  const int n = 4096;
  for (int i = 0; i < n; i += native_lanes) {
    F x;
    for (int k = 0; k < native_lanes; ++k) set_lane(x, k, low + (high - low) * float(i + k) / float(n));
    F y = f(x);
    for (int k = 0; k < native_lanes; ++k)
      ASSERT_EQ(float_bits(lane(y, k)), float_bits(f(lane(x, k)))) << "at " << lane(x, k);
  }
}

TEST(Lanes, every_function_gives_one_lane_the_bits_of_a_float) {
  expect_same_bits_in_lane_and_float(0, 1, [](auto u) { return sin_cos_two_pi(u).sin; });
  expect_same_bits_in_lane_and_float(0, 1, [](auto u) { return sin_cos_two_pi(u).cos; });
  expect_same_bits_in_lane_and_float(-90, 90, [](auto x) { return montelux::exp(x); });
  expect_same_bits_in_lane_and_float(1e-6f, 50, [](auto x) { return montelux::log(x); });
  expect_same_bits_in_lane_and_float(-1, 1, [](auto x) { return montelux::acos(x); });
  expect_same_bits_in_lane_and_float(-3, 3, [](auto x) { return montelux::atan2(x, x * x - 1.0f); });
  expect_same_bits_in_lane_and_float(0, 40, [](auto x) { return whole_power(x * 0.03f, floor(x)); });
  expect_same_bits_in_lane_and_float(-3, 3, [](auto x) { return round(x) + floor(x) + abs(x); });
}

TEST(Functions, agree_with_the_standard_library_within_their_stated_error) {
  for (int i = 0; i <= 100000; ++i) {
    double u = i / 100000.0;
    EXPECT_NEAR(sin_cos_two_pi(float(u)).sin, std::sin(2 * std::numbers::pi * float(u)), 3e-7);
    EXPECT_NEAR(sin_cos_two_pi(float(u)).cos, std::cos(2 * std::numbers::pi * float(u)), 3e-7);
    float x = float(174 * u - 87);
    EXPECT_NEAR(montelux::exp(x) / std::exp(double(x)), 1, 3e-7) << x;
    float p = float(std::pow(10.0, 60 * u - 30));
    EXPECT_NEAR(montelux::log(p), std::log(double(p)), 3e-7 + 1e-7 * std::abs(std::log(double(p))));
    float c = float(2 * u - 1);
    EXPECT_NEAR(montelux::acos(c), std::acos(double(c)), 5e-7) << c;
    EXPECT_NEAR(montelux::atan2(c, 0.3f), std::atan2(double(c), double(0.3f)), 4e-7);
  }
}

TEST(Functions, a_whole_power_is_as_exact_as_its_products) {
  for (int n = 0; n <= 200; ++n)
    for (float x : {0.0f, 0.3f, 0.97f, 1.0f, -0.9f, 1.2f}) {
      const double truth = std::pow(double(x), n);
      if (truth != 0 && std::abs(truth) < 1e-37) continue;
      // Of n factors each product is rounded once, and what is squared carries its error along.
      EXPECT_NEAR(whole_power(x, float(n)), truth, std::abs(truth) * (n + 1) * 0x1p-24) << x << " to the " << n;
    }
  EXPECT_EQ(whole_power(1.0f, std::numeric_limits<float>::infinity()), 1.0f);  // and ends
}

TEST(Lanes, masks_round_trip_through_bits) {
  for (std::uint32_t b : {0u, 1u, 5u, 0xau, (1u << native_lanes) - 1u})
    EXPECT_EQ(bits(mask_of_bits<F>(b)), b & ((1u << native_lanes) - 1u));
  EXPECT_TRUE(all(Mask<F>(true)));
  EXPECT_FALSE(any(Mask<F>(false)));
}

TEST(Lanes, that_are_on_are_written_one_after_the_other) {
  using U = Uint<NativeFloats>;
  for (const std::uint32_t b : {0u, 1u, 5u, 0b1010u, (1u << (native_lanes - 1)) | 2u, (1u << native_lanes) - 1u}) {
    std::array<std::uint32_t, std::size_t(native_lanes)> to;
    to.fill(99);
    write_lanes(mask_of_bits<NativeFloats>(b), lane_index<NativeFloats>(), to.data());
    std::size_t n = 0;
    for (std::uint32_t k = 0; k < native_lanes; ++k)
      if ((b >> k) & 1u) {
        EXPECT_EQ(to[n++], k) << b;
      }
    std::array<float, std::size_t(native_lanes)> reals;
    write_lanes(mask_of_bits<NativeFloats>(b), to_float(U(lane_index<NativeFloats>())), reals.data());
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(reals[i], float(to[i]));
  }
}

TEST(Lanes, min_and_max_treat_not_a_number_alike_in_lanes_and_floats) {
  float nan = std::nanf("");
  EXPECT_EQ(lane(min(F(nan), F(2.0f)), 0), min(nan, 2.0f));
  EXPECT_EQ(lane(max(F(nan), F(2.0f)), 0), max(nan, 2.0f));
}

TEST(Transform, inverse_of_a_product_undoes_it) {
  Transform t = translate(1, 2, 3) * rotate(33, 1, 2, -1) * scale(2, -3, 0.5);
  Vec3f p{0.3f, -2, 5};
  Vec3f q = t.inverted().point(t.point(p));
  EXPECT_NEAR(q.x, p.x, 1e-5);
  EXPECT_NEAR(q.y, p.y, 1e-5);
  EXPECT_NEAR(q.z, p.z, 1e-5);
  EXPECT_TRUE(t.swaps_handedness());
  EXPECT_FALSE(from_matrix(scale(1, 0, 1).matrix()).has_value());
}

TEST(Transform, look_at_puts_the_target_on_the_z_axis) {
  auto t = look_at({1, 2, 3}, {4, 0, -2}, {0, 1, 0});
  ASSERT_TRUE(t);
  Vec3f q = t->point(Vec3f{4, 0, -2});
  EXPECT_NEAR(q.x, 0, 1e-6);
  EXPECT_NEAR(q.y, 0, 1e-6);
  EXPECT_NEAR(q.z, std::sqrt(38.0), 1e-5);
  EXPECT_FALSE(look_at({0, 0, 0}, {0, 1, 0}, {0, 2, 0}));
}

}  // namespace
}  // namespace montelux
