#include "mc/confidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics.h"

namespace montelux {
namespace {

TEST(Confidence, quantiles_are_those_of_published_tables) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, tables 1.3.6.7.1 to 1.3.6.7.4.
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(1e-6), -4.753424308822899, 1e-10);
  EXPECT_NEAR(student_t_quantile(0.975, 1), 12.706, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.975, 10), 2.228, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.995, 30), 2.750, 5e-4);
  EXPECT_NEAR(student_t_quantile(0.95, 1e7), normal_quantile(0.95), 1e-6);
  EXPECT_NEAR(test::chi_square_p_value(18.307, 10), 0.05, 1e-5);
  EXPECT_NEAR(test::chi_square_p_value(124.342, 100), 0.05, 1e-5);
}

TEST(Confidence, quantile_undoes_the_distribution_function) {
  for (double p : {1e-12, 1e-4, 0.02, 0.3, 0.5, 0.9, 0.9999}) {
    EXPECT_NEAR(normal_cdf(normal_quantile(p)) / p, 1, 1e-10);
    for (double degrees : {1.0, 3.0, 15.0, 400.0})
      EXPECT_NEAR(student_t_cdf(student_t_quantile(p, degrees), degrees) / p, 1, 1e-8);
  }
}

TEST(Confidence, student_of_one_degree_is_cauchy) {
  for (double t : {-5.0, -1.0, 0.3, 20.0})
    EXPECT_NEAR(student_t_cdf(t, 1), 0.5 + std::atan(t) / std::numbers::pi, 1e-12);
}

TEST(Quadrature, gauss_legendre_is_exact_for_polynomials) {
  for (int n : {1, 4, 8, 17}) {
    test::QuadratureRule rule = test::gauss_legendre(n);
    double sum = 0;
    for (std::size_t i = 0; i < rule.x.size(); ++i) sum += rule.w[i] * std::pow(rule.x[i], 2 * n - 1);
    EXPECT_NEAR(sum, 1.0 / (2 * n), 1e-14);
  }
  EXPECT_NEAR(test::integrate_sphere([](Vec3f w) { return w.z * w.z; }), 4 * std::numbers::pi / 3, 1e-5);
}

}  // namespace
}  // namespace montelux
