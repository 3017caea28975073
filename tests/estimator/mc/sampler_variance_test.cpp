// The variance of every point set is that of the theory of its construction; where theory states a rate alone, the
// rate. tests/full/samplers does the same at every N up to 4096 and writes the table of docs/samplers.md.
#include "sampler_variance.h"

#include <gtest/gtest.h>

#include "mc/digital.h"
#include "mc/pmj02.h"

namespace montelux::test {
namespace {

constexpr PointSetKind nets[] = {PointSetKind::sobol, PointSetKind::padded_sobol, PointSetKind::blue_noise,
                                 PointSetKind::pmj02};
// Nets: three integrands; independent and jittered points: two; the lattice: two; at three N each. Rates of edges.
constexpr double tests_of_the_suite = 3 * (4 * 3 + 2 * 2 + 2) + 8;
const double level = sidak_level(family_level, tests_of_the_suite);

void expect_variance(PointSetKind kind, std::uint32_t n, const SquareIntegrand& f, double truth) {
  const SampleSummary measured = measured_variance(kind, n, f);
  EXPECT_GT(t_test(measured, truth).p_value, level)
      << name_of(kind) << ", " << f.name << ", " << n << " points: " << measured.mean << " +- "
      << measured.standard_error() << " where theory has " << truth;
  EXPECT_LT(t_test(measured, 1.5 * truth).p_value, level) << name_of(kind) << " " << f.name << " " << n;
}

TEST(SamplerVariance, of_scrambled_nets_is_the_sum_over_levels_of_owen) {
  for (PointSetKind kind : nets)
    for (int m : {2, 5, 8})
      for (const SquareIntegrand& f : {line_exp, square_bell, square_periodic})
        expect_variance(kind, 1u << m, f, scrambled_net_variance(f, m));
}

TEST(SamplerVariance, of_independent_and_jittered_points_is_that_of_their_boxes) {
  for (std::uint32_t n : {4u, 64u, 256u})
    for (const SquareIntegrand& f : {line_exp, square_bell}) {
      expect_variance(PointSetKind::independent, n, f, independent_variance(f, n));
      expect_variance(PointSetKind::stratified, n, f, jittered_variance(f, n));
    }
}

TEST(SamplerVariance, of_lattices_is_the_sum_over_the_dual_lattice) {
  for (int m : {2, 5, 8}) {
    expect_variance(PointSetKind::lattice, 1u << m, square_periodic, lattice_variance_of_periodic(m));
    expect_variance(PointSetKind::lattice, 1u << m, line_exp, lattice_variance_of_exp(1u << m));
  }
}

// The p-value of "the variance falls no faster than N^exponent" from 64 to 1024 points.
template <class Variance>
double slower(Variance variance, double exponent) {
  const Exponent e = measured_exponent(variance(64u), variance(1024u), 16);
  return at_least_p_value(e.value, e.standard_error, exponent);
}

TEST(SamplerVariance, at_an_edge_falls_faster_than_at_random) {
  for (const NamedPointSet& set : point_set_names) {
    const auto disk = [&](std::uint32_t n) { return measured_variance(set.kind, n, square_disk); };
    if (set.kind == PointSetKind::independent) {
      EXPECT_GT(slower(disk, -1.2), level);
    } else {
      EXPECT_LT(slower(disk, -1.2), level) << set.name;
      EXPECT_GT(slower(disk, -1.9), level) << set.name;
    }
  }
}

// Points of one pass with a part of the construction omitted, compared with the complete one.
TEST(SamplerVariance, shows_what_is_missing_from_a_construction) {
  const int m = 8;
  const auto variance_of = [&](auto points) {
    return variance_summary(
        [&](std::uint32_t pass) {
          double sum = 0;
          for (std::uint32_t i = 0; i < 1u << m; ++i) {
            const Vec2f u = points(i, RandomStream<float>(pass, 0x77u));
            sum += square_bell.f(double(u.x), double(u.y));
          }
          return sum / (1u << m);
        },
        1000);
  };
  const double truth = scrambled_net_variance(square_bell, m);
  const auto pair = [](std::uint32_t x, std::uint32_t y) {
    return Vec2f{fraction_of_reversed<float>(x), fraction_of_reversed<float>(y)};
  };
  // Whole: it agrees.
  EXPECT_GT(t_test(variance_of([&](std::uint32_t i, RandomStream<float> s) {
                     return pair(pmj02_digits(i, m, s.bits_at(0)),
                                 pmj02_digits(multiply_by_pascal(i), m, s.bits_at(1)));
                   }),
                   truth)
                .p_value,
            level);
  // The second matrix left out: a diagonal.
  EXPECT_LT(t_test(variance_of([&](std::uint32_t i, RandomStream<float> s) {
                     return pair(pmj02_digits(i, m, s.bits_at(0)), pmj02_digits(i, m, s.bits_at(1)));
                   }),
                   truth)
                .p_value,
            level);
  // The digits only flipped alike for all points, not nested: another variance, since points keep their places in
  // boxes.
  EXPECT_LT(t_test(variance_of([&](std::uint32_t i, RandomStream<float> s) {
                     return pair(i ^ s.bits_at(0), multiply_by_pascal(i) ^ s.bits_at(1));
                   }),
                   truth)
                .p_value,
            level);
  // No scramble at all: nothing is random.
  EXPECT_LT(
      t_test(variance_of([&](std::uint32_t i, RandomStream<float>) { return pair(i, multiply_by_pascal(i)); }), truth)
          .p_value,
      level);
}

}  // namespace
}  // namespace montelux::test
