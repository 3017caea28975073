// Integrals over the domains of the distributions, against closed forms.
#include <gtest/gtest.h>

#include "mc/estimate.h"
#include "mc/hemisphere.h"
#include "mc/triangle.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

const double level = sidak_level(family_level, 24);

template <class Function, class Distribution>
void expect_integral(Function f, const Distribution& distribution, double truth) {
  const Estimate e = estimate(f, distribution, 200000, RandomStream<float>(11, 12));
  EXPECT_EQ(e.non_finite, 0u);
  EXPECT_LT(e.standard_error, 0.005 * truth);
  EXPECT_GT(z_test(e.mean, e.standard_error, truth).p_value, level) << e.mean << " against " << truth;
  EXPECT_LT(z_test(e.mean, e.standard_error, 1.04 * truth).p_value, level);
}

TEST(Integrals, over_a_disk_and_a_triangle) {
  expect_integral(
      [](Vec2f p) { return std::exp(p.x); },
      MappedSquare{[](Vec2f u) { return sample_disk_concentric(u); }, [](Vec2f p) { return disk_density(p); }},
      // 2 pi I_1(1), I_1 the modified Bessel function.
      2 * std::numbers::pi * 0.565159103992485);
  expect_integral(
      [](Vec2f b) { return b.x * b.y; },
      MappedSquare{[](Vec2f u) { return sample_triangle(u); }, [](Vec2f) { return triangle_density(0.5f); }}, 1.0 / 24);
}

TEST(Integrals, over_the_sphere) {
  expect_integral([](Vec3f w) { return w.z * w.z; },
                  MappedSquare{[](Vec2f u) { return sample_sphere(u); }, [](Vec3f) { return sphere_density<float>(); }},
                  4 * std::numbers::pi / 3);
}

TEST(Integrals, of_the_cosine_over_the_hemisphere_are_pi_in_either_measure) {
  // Uniform in solid angle the factor is 2 pi, in projected solid angle pi.
  expect_integral(
      [](Vec3f w) { return w.z; },
      MappedSquare{[](Vec2f u) { return sample_hemisphere(u); }, [](Vec3f w) { return hemisphere_density(w.z); }},
      std::numbers::pi);
  const MappedSquare cosine{[](Vec2f u) { return sample_cosine_hemisphere(u); },
                            [](Vec3f w) { return cosine_hemisphere_density(w.z); }};
  const Estimate e = estimate([](Vec3f w) { return w.z; }, cosine, 1000, RandomStream<float>(1, 2));
  EXPECT_NEAR(e.mean, std::numbers::pi, 1e-6);
  EXPECT_NEAR(e.standard_error, 0, 1e-8);
  expect_integral([](Vec3f w) { return w.z * (1 + w.x); }, cosine, std::numbers::pi);
}

TEST(Integrals, over_twenty_dimensions_by_every_point_set) {
  // The product of 1 + (u_i - 1/2) / 2 has the integral 1 in any number of dimensions.
  const auto product = [](const Sampler<float>& s) {
    double p = 1;
    for (std::uint32_t d = 0; d < 20; ++d) p *= 1 + 0.5 * (double(s.get1(d)) - 0.5);
    return p;
  };
  const auto of = [&](PointSetKind kind, std::uint32_t samples) {
    return estimate_over_passes(product, {kind, 3, 0, samples}, 400);
  };
  // The p-value of "no more variance than independent points have" (means of 64 are near normal: Fisher's F).
  const Estimate independent = of(PointSetKind::independent, 64);
  const auto no_worse = [&](const Estimate& e) {
    return f_test_p_value(e.standard_error * e.standard_error, double(e.count),
                          independent.standard_error * independent.standard_error, double(independent.count));
  };
  for (const NamedPointSet& entry : point_set_names) {
    const Estimate e = of(entry.kind, 64);
    EXPECT_GT(t_test(e, 1).p_value, level) << entry.name;
    EXPECT_LT(t_test(e, 1.04).p_value, level) << entry.name;
    EXPECT_GT(no_worse(e), level) << entry.name;
  }
  // Two thirds of the points are seen to be fewer.
  EXPECT_LT(no_worse(of(PointSetKind::independent, 42)), level);
}

}  // namespace
}  // namespace montelux
