// Distances to events in media, and the directions of phase functions, against closed forms.
#include "medium/medium.h"

#include <gtest/gtest.h>

#include <array>

#include "mc/random.h"
#include "statistics.h"

namespace montelux::test {
namespace {

constexpr int samples = 200000;

// Sums of x and x^2.
struct Sums {
  double x = 0, square = 0;
  void add(double value) { x += value, square += value * value; }
  double mean() const { return x / samples; }
  double standard_error() const { return std::sqrt((square / samples - mean() * mean()) / (samples - 1)); }
  double p_value(double truth) const {
    const double error = standard_error();
    if (!(error > 0)) return std::abs(mean() - truth) <= 1e-6 * std::abs(truth) ? 1 : 0;
    return 2 * normal_cdf(-std::abs(mean() - truth) / error);
  }
};

TEST(DistanceSample, has_the_means_of_transmittance_and_of_what_scatters) {
  const Medium stated{{{0.1f, 0.5f, 0.0f}}, {{0.3f, 2.0f, 8.0f}}, {}, 0};
  const Spectrum<float> absorption = from_rgb(stated.absorption), scattering = from_rgb(stated.scattering);
  MediumSet media;
  const std::uint32_t medium = media.add(stated);
  const double level = sidak_level(family_level, spectrum_size * 2 * 2);
  for (const Spectrum<float>& throughput : {gray(1.0f), from_rgb(Rgb{{0.5f, 0.1f, 0.01f}})})
    for (const float length : {0.4f, 3.0f}) {
      RandomStream<float> random(3, 1);
      std::array<Sums, spectrum_size> events, ends;
      for (int i = 0; i < samples; ++i) {
        const float u = random.next();
        const DistanceSample<float> s = media.sample_distance<float>(medium, throughput, length, {u, random.next()});
        double total = 0, before = 0;
        for (std::size_t c = 0; c < spectrum_size; ++c) {
          events[c].add(s.is_event ? double(s.weight.c[c]) : 0), ends[c].add(s.is_event ? 0 : double(s.weight.c[c]));
          total += double(s.weight.c[c] * throughput.c[c]), before += double(throughput.c[c]);
        }
        // The balance heuristic bounds the throughput.
        EXPECT_LE(total, before * 1.0001);
        EXPECT_TRUE(!s.is_event || s.distance < length);
      }
      for (std::size_t c = 0; c < spectrum_size; ++c) {
        const double extinction = double(absorption.c[c]) + double(scattering.c[c]);
        const double left = std::exp(-extinction * double(length));
        const double scattered = double(scattering.c[c]) * (1 - left) / extinction;
        EXPECT_GT(ends[c].p_value(left), level) << c << ": " << ends[c].mean() << " for " << left;
        EXPECT_GT(events[c].p_value(scattered), level) << c << ": " << events[c].mean() << " for " << scattered;
        EXPECT_LT(events[c].p_value(1.05 * scattered), level) << c;
      }
    }
}

TEST(DistanceSample, of_a_medium_that_only_absorbs_is_the_transmittance) {
  MediumSet media;
  const std::uint32_t medium = media.add({{{0.1f, 0.5f, 2.0f}}, {}, {}, 0});
  for (const float u : {0.0f, 0.5f, 0.999f}) {
    const auto s = media.sample_distance<float>(medium, gray(1.0f), 1.5f, {u, u});
    EXPECT_FALSE(s.is_event);
    EXPECT_NEAR(s.weight.c[0], std::exp(-0.15), 1e-6);
    EXPECT_NEAR(s.weight.c[2], std::exp(-3.0), 1e-6);
  }
  // Empty space, however far.
  const auto far = media.sample_distance<float>(empty_space, gray(1.0f), 1e30f, {0.5f, 0.5f});
  EXPECT_FALSE(far.is_event);
  EXPECT_EQ(far.weight.c[0], 1.0f);
}

// The first two Legendre moments of the phase function are g and g^2.
TEST(HenyeyGreenstein, has_the_moments_of_its_mean_cosine) {
  const double level = sidak_level(family_level, 2 * 5);
  const Vec3f wo = normalize(Vec3f{0.3f, -0.5f, 0.7f});
  for (const float g : {-0.7f, -0.2f, 0.0f, 0.4f, 0.95f}) {
    const HenyeyGreenstein<float> phase(g);
    RandomStream<float> random(7, 2);
    Sums first, second;
    for (int i = 0; i < samples; ++i) {
      const PhaseSample<float> s = phase.sample(wo, random.next2());
      const double cosine = double(-dot(wo, s.wi));
      first.add(cosine), second.add((3 * cosine * cosine - 1) / 2);
      EXPECT_NEAR(double(length(s.wi)), 1, 1e-5);
    }
    EXPECT_GT(first.p_value(double(g)), level) << g;
    EXPECT_GT(second.p_value(double(g) * double(g)), level) << g;
    EXPECT_LT(first.p_value(double(g) + 0.02), level) << g;
    // The density integrates to 1, by Simpson's rule over the cosine.
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
      const double cosine = -1 + 2.0 * i / steps;
      const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
      sum += weight * double(henyey_greenstein(float(cosine), g)) * 2 * std::numbers::pi;
    }
    EXPECT_NEAR(sum * 2 / (3.0 * steps), 1, 2e-4) << g;
  }
}

// The cosine has mean 0, and its square 2/5; isotropic scattering has 1/3.
TEST(Rayleigh, has_the_moments_of_its_law) {
  const double level = sidak_level(family_level, 2);
  const Vec3f wo = normalize(Vec3f{0.3f, -0.5f, 0.7f});
  const Rayleigh<float> phase(0);
  RandomStream<float> random(7, 3);
  Sums first, second;
  for (int i = 0; i < samples; ++i) {
    const PhaseSample<float> s = phase.sample(wo, random.next2());
    const double cosine = double(-dot(wo, s.wi));
    first.add(cosine), second.add(cosine * cosine);
    EXPECT_NEAR(double(length(s.wi)), 1, 1e-5);
  }
  EXPECT_GT(first.p_value(0), level);
  EXPECT_GT(second.p_value(0.4), level) << second.mean();
  EXPECT_LT(second.p_value(1.0 / 3), level);
}

// Every phase function: samples follow the value, which integrates to 1, also in lanes of mixed kinds.
TEST(PhaseFunction, draws_directions_by_its_value_and_a_planted_fault_is_found) {
  const double level = sidak_level(family_level, 2.0 * phase_names.size());
  const Vec3f wo = normalize(Vec3f{-0.2f, 0.4f, 0.5f});
  const LocalFrame<float> frame = LocalFrame<float>::from_normal(-wo);
  for (std::size_t kind = 0; kind < phase_names.size(); ++kind) {
    const PhaseFunction<float> phase{std::uint32_t(kind), 0.35f};
    const auto direction = [&](RandomStream<float>& random) { return phase.sample(wo, random.next2()).wi; };
    const auto density = [&](Vec3f wi) { return double(phase.evaluate(wo, wi).value); };
    EXPECT_NEAR(integrate_sphere(density, frame, 64, -1), 1, 1e-4) << phase_names[kind];
    for (const Grid grid : {coarse_grid, fine_grid})
      EXPECT_GT(chi_square_sphere(direction, density, grid, 100000, 9, frame, 4).p_value, level) << phase_names[kind];
    const auto wrong = [&](Vec3f wi) { return density(wi) * (dot(wi, frame.s) > 0 ? 1.05 : 0.95); };
    EXPECT_LT(chi_square_sphere(direction, wrong, coarse_grid, 100000, 9, frame, 4).p_value, level);
  }
}

TEST(PhaseFunction, is_the_same_in_lanes_of_mixed_kinds) {
  using P = NativeFloats;
  const Uint<P> kinds = lane_index<P>() & Uint<P>(1u);
  const PhaseFunction<P> phases{kinds, P(-0.4f)};
  const Vec3f wo = normalize(Vec3f{0.1f, 0.9f, -0.3f});
  RandomStream<P> random(Uint<P>(5u), lane_index<P>());
  const Vec2<P> u = random.next2();
  const PhaseSample<P> all = phases.sample(splat<P>(wo), u);
  for (int k = 0; k < lanes_of<P>; ++k) {
    const PhaseFunction<float> one{lane(kinds, k), -0.4f};
    const PhaseSample<float> s = one.sample(wo, lane(u, k));
    EXPECT_NEAR(double(length(lane(all.wi, k) - s.wi)), 0, 1e-5);
    EXPECT_NEAR(double(lane(all.density.value, k)), double(one.evaluate(wo, lane(all.wi, k)).value), 1e-5);
  }
}

}  // namespace
}  // namespace montelux::test
