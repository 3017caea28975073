#include "material/fresnel.h"

#include <gtest/gtest.h>

#include <complex>

namespace montelux {
namespace {

TEST(FresnelDielectric, glass_reflects_four_percent_at_normal_incidence_from_both_sides) {
  EXPECT_NEAR(fresnel_dielectric(1.0f, 1.5f), 0.04, 1e-6);
  EXPECT_NEAR(fresnel_dielectric(-1.0f, 1.5f), 0.04, 1e-6);
  EXPECT_NEAR(fresnel_dielectric(1.0f, 1.33f), 0.33 * 0.33 / (2.33 * 2.33), 1e-6);
}

// At Brewster's angle, tan = eta, the parallel part vanishes and the other is ((1 - eta^2) / (1 + eta^2))^2.
TEST(FresnelDielectric, brewster_angle_loses_the_parallel_part) {
  for (const double eta : {1.33, 1.5, 2.4}) {
    const double cos = 1 / std::sqrt(1 + eta * eta), r = (1 - eta * eta) / (1 + eta * eta);
    EXPECT_NEAR(fresnel_dielectric(float(cos), float(eta)), 0.5 * r * r, 1e-6);
  }
}

TEST(FresnelDielectric, total_internal_reflection_starts_at_the_critical_angle) {
  const double critical = std::sqrt(1 - 1 / 2.25);
  EXPECT_EQ(fresnel_dielectric(float(-critical + 1e-3), 1.5f), 1.0f);
  EXPECT_LT(fresnel_dielectric(float(-critical - 1e-3), 1.5f), 0.9f);
  EXPECT_NEAR(fresnel_dielectric(1e-6f, 1.5f), 1, 1e-4);
}

// Light that crosses the interface either way is reflected alike at the two ends of its path.
TEST(FresnelDielectric, both_ends_of_a_refracted_ray_reflect_alike) {
  for (float cos = 0.05f; cos < 1; cos += 0.1f) {
    const float inside = std::sqrt(1 - (1 - cos * cos) / 2.25f);
    EXPECT_NEAR(fresnel_dielectric(cos, 1.5f), fresnel_dielectric(-inside, 1.5f), 1e-5);
  }
}

// The formula in complex numbers, double precision.
double complex_fresnel(double cos, double eta, double k) {
  const std::complex<double> n(eta, k), cos_t = std::sqrt(1.0 - (1 - cos * cos) / (n * n));
  const auto parallel = (n * cos - cos_t) / (n * cos + cos_t), perpendicular = (cos - n * cos_t) / (cos + n * cos_t);
  return 0.5 * (std::norm(parallel) + std::norm(perpendicular));
}

TEST(FresnelConductor, normal_incidence_is_the_textbook_ratio) {
  // Gold, silver and aluminium at about 589 nm (Johnson and Christy 1972; Rakic 1995).
  const double metals[][2] = {{0.27, 2.95}, {0.055, 3.98}, {1.15, 6.97}};
  for (const auto& [eta, k] : metals)
    EXPECT_NEAR(fresnel_conductor(1.0f, float(eta), float(k)),
                ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k), 2e-6);
}

TEST(FresnelConductor, all_angles_match_complex_arithmetic) {
  for (const double eta : {0.05, 0.27, 1.0, 1.15, 2.8})
    for (const double k : {0.0, 0.5, 2.95, 7.0})
      for (double cos = 0.02; cos <= 1; cos += 0.07) {
        if (k == 0 && eta < 1.01) continue;
        EXPECT_NEAR(fresnel_conductor(float(cos), float(eta), float(k)), complex_fresnel(cos, eta, k), 2e-5)
            << eta << " " << k << " " << cos;
      }
}

TEST(FresnelConductor, grazing_light_is_all_reflected) {
  EXPECT_NEAR(fresnel_conductor(0.0f, 0.2f, 3.9f), 1, 1e-6);
  EXPECT_NEAR(fresnel_conductor(1.0f, 1.0f, 1e9f), 1, 1e-6);
}

TEST(Refract, obeys_snell_on_both_sides_and_returns) {
  const Vec3f n{0, 0, 1};
  for (const float z : {1.0f, 0.9f, 0.5f, 0.1f}) {
    const Vec3f w{std::sqrt(1 - z * z), 0, z};
    const Refraction<float> in = refract(w, n, 1.5f);
    ASSERT_TRUE(in.valid);
    EXPECT_NEAR(in.wt.x, -w.x / 1.5f, 1e-6);
    EXPECT_NEAR(length(in.wt), 1, 1e-6);
    EXPECT_LT(in.wt.z, 0);
    EXPECT_EQ(in.relative_eta, 1.5f);
    const Refraction<float> out = refract(in.wt, n, 1.5f);
    ASSERT_TRUE(out.valid);
    EXPECT_NEAR(length(out.wt - w), 0, 5e-6);
    EXPECT_NEAR(out.relative_eta, 1 / 1.5f, 1e-6);
  }
  EXPECT_FALSE(refract(Vec3f{0.8f, 0, -0.6f}, n, 1.5f).valid);
}

}  // namespace
}  // namespace montelux
