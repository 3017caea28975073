// Truth: tables of Abramowitz and Stegun, the NIST handbook of critical values, and values of mpmath at 40 digits.
#include "math/special.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace montelux::special {
namespace {

void expect_relative(double value, double truth, double tolerance) {
  EXPECT_NEAR(value / truth, 1.0, tolerance) << value << " instead of " << truth;
}

TEST(Special, log_gamma_matches_high_precision_values) {
  expect_relative(log_gamma(0.1), 2.252712651734206, 1e-14);
  expect_relative(log_gamma(0.5), 0.57236494292470009, 1e-14);
  expect_relative(log_gamma(3.7), 1.4280723266653879, 1e-14);
  expect_relative(log_gamma(10.5), 13.940625219403764, 1e-14);
  expect_relative(log_gamma(1234.5), 7550.5509010778949, 1e-14);
  EXPECT_NEAR(log_gamma(1.0), 0.0, 1e-14);
  EXPECT_TRUE(std::isnan(log_gamma(-1.0)));
}

TEST(Special, incomplete_gamma_matches_high_precision_values) {
  struct Row {
    double a, x, q, p;
  };
  for (Row r :
       {Row{0.5, 0.1, 0.65472084601857702, 0.34527915398142298}, Row{0.5, 3, 0.01430587843542964, 0.98569412156457036},
        Row{5, 2, 0.94734698265628884, 0.052653017343711157}, Row{5, 12, 0.0076003906810669955, 0.992399609318933},
        Row{100, 90, 0.84177901081356983, 0.15822098918643017},
        Row{100, 130, 0.0027504083673065263, 0.99724959163269347},
        Row{1e5, 100200, 0.26333798999480129, 0.73666201000519871},
        Row{1e5, 101500, 1.1736845137221691e-6, 0.99999882631548628}}) {
    expect_relative(gamma_q(r.a, r.x), r.q, 1e-11);
    expect_relative(gamma_p(r.a, r.x), r.p, 1e-11);
  }
  EXPECT_EQ(gamma_p(2.0, 0.0), 0.0);
  EXPECT_EQ(gamma_q(2.0, std::numeric_limits<double>::infinity()), 0.0);
}

TEST(Special, incomplete_beta_matches_high_precision_values) {
  struct Row {
    double a, b, x, value;
  };
  for (Row r : {Row{0.5, 0.5, 0.3, 0.36901011956554538}, Row{2, 3, 0.4, 0.5248}, Row{10, 0.5, 0.9, 0.15164090963470992},
                Row{50, 70, 0.3, 0.0035661350059569731}, Row{500, 500, 0.55, 0.9992363210604735},
                Row{5000, 0.5, 0.999, 0.0015615791602892908}}) {
    expect_relative(incomplete_beta(r.a, r.b, r.x), r.value, 1e-11);
    EXPECT_NEAR(incomplete_beta(r.b, r.a, 1.0 - r.x), 1.0 - r.value, 1e-11);
  }
  EXPECT_EQ(incomplete_beta(2, 3, 0.0), 0.0);
  EXPECT_EQ(incomplete_beta(2, 3, 1.0), 1.0);
}

TEST(Special, normal_quantile_matches_tables_and_inverts_the_distribution) {
  expect_relative(normal_quantile(0.975), 1.959963984540054, 1e-14);
  expect_relative(normal_quantile(0.001), -3.0902323061678135, 1e-14);
  expect_relative(normal_quantile(0.25), -0.67448975019608174, 1e-14);
  expect_relative(normal_quantile(1e-10), -6.3613409024040562, 1e-14);
  expect_relative(normal_quantile(1e-100), -21.273453560965324, 1e-13);
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-15);
  for (double p = 0.0005; p < 1.0; p += 0.0101) EXPECT_NEAR(normal_cdf(normal_quantile(p)), p, 1e-15);
  EXPECT_EQ(normal_quantile(1.0), std::numeric_limits<double>::infinity());
}

TEST(Special, student_t_tail_matches_high_precision_values) {
  expect_relative(student_t_tail(1, 1), 0.25, 1e-14);
  expect_relative(student_t_tail(3, 2.5), 0.036288047774515922, 1e-13);
  expect_relative(student_t_tail(10, 5), 8.5473787871481795e-5, 1e-13);
  expect_relative(student_t_tail(2, 30), 0.027312522481491552, 1e-13);
  expect_relative(student_t_tail(4, 1000), 3.4004959604390789e-5, 1e-12);
  expect_relative(student_t_tail(6, 1e6), 9.8692490617721733e-10, 1e-9);
  EXPECT_NEAR(student_t_cdf(1, 1) + student_t_cdf(-1, 1), 1.0, 1e-15);
  EXPECT_EQ(student_t_cdf(0.7, std::numeric_limits<double>::infinity()), normal_cdf(0.7));
}

TEST(Special, student_t_quantile_matches_closed_forms_and_high_precision_values) {
  expect_relative(student_t_quantile(0.975, 1), 12.706204736174707, 1e-13);
  expect_relative(student_t_quantile(0.975, 2), 4.3026527297494642, 1e-13);
  expect_relative(student_t_quantile(0.975, 5), 2.5705818356363155, 1e-13);
  expect_relative(student_t_quantile(0.975, 10), 2.2281388519862747, 1e-13);
  expect_relative(student_t_quantile(0.025, 30), -2.0422724563012383, 1e-13);
  EXPECT_EQ(student_t_quantile(0.5, 3), 0.0);
  for (double dof : {0.5, 1.0, 3.3, 40.0, 1e5})
    for (double p : {1e-12, 1e-4, 0.1, 0.4999})
      expect_relative(student_t_cdf(student_t_quantile(p, dof), dof), p, 1e-9);
}

TEST(Special, chi_square_tail_matches_the_published_critical_values) {
  EXPECT_NEAR(chi_square_tail(3.841458820694124, 1), 0.05, 1e-14);
  EXPECT_NEAR(chi_square_tail(18.307038053275146, 10), 0.05, 1e-14);
  EXPECT_NEAR(chi_square_tail(124.342, 100), 0.05, 1e-6);
}

}  // namespace
}  // namespace montelux::special
