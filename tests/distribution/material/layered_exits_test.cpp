// Light leaves a rough coat by two techniques: a direction that is drawn from the coat, and one that the base draws and
// that happens to pass. Their weights must be formed from the densities by which directions are really drawn; with the
// density of the way back in place of one of them, coats come out too bright.
#include <gtest/gtest.h>

#include "cases.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

constexpr float reflectance = 0.8f, eta = 1.5f;
constexpr auto radiance = TransportMode::radiance;
constexpr auto importance = TransportMode::importance;

struct Estimates {
  SampleSummary consistent, reversed;
};

// One bounce off Lambert's law under a rough coat: f |cos| from wo to wi by both techniques, reimplemented from
// the coat alone, with the right weights and with the density of the reversed directions for the second technique.
Estimates two_techniques(const Dielectric<float>& coat, Vec3f wo, Vec3f wi, int count, std::uint32_t seed) {
  RandomStream<float> random(seed, 17u);
  std::vector<double> consistent, reversed;
  for (int i = 0; i < count; ++i) {
    const auto entry = coat.sample_lobes<Lobes::transmission>(wo, 0, random.next2(), radiance);
    const auto exit = coat.sample_lobes<Lobes::transmission>(wi, 0, random.next2(), importance);
    const Vec3f w = sample_cosine_hemisphere(random.next2());
    double by_coat = 0, by_base = 0, by_base_reversed = 0;
    if (entry.valid && exit.valid) {
      const double cos = -double(exit.wi.z), base = cos / std::numbers::pi, drawn = double(exit.density);
      by_coat = double(entry.weight * reflectance) * base * double(exit.weight * wi.z) / cos * drawn * drawn /
                (drawn * drawn + base * base);
    }
    if (entry.valid) {
      const auto out = coat.evaluate_lobes<Lobes::transmission>(-w, wi, radiance);
      const auto back = coat.evaluate_lobes<Lobes::transmission>(wi, -w, importance);
      const double base = double(w.z) / std::numbers::pi, value = double(entry.weight * reflectance * out.f_cos);
      const auto weighted = [&](double other) { return value * base * base / (base * base + other * other); };
      if (base > 0) by_base = weighted(double(back.density)), by_base_reversed = weighted(double(out.density));
    }
    consistent.push_back(by_coat + by_base), reversed.push_back(by_coat + by_base_reversed);
  }
  return {summarize(consistent), summarize(reversed)};
}

// The same as a product of two integrals, by quadrature.
double one_bounce(const Dielectric<float>& coat, Vec3f wo, Vec3f wi) {
  const LocalFrame<float> up = LocalFrame<float>::from_normal({0, 0, 1});
  const double enters = integrate_sphere(
      [&](Vec3f w) { return coat.evaluate_lobes<Lobes::transmission>(wo, w, radiance).f_cos; }, up, 64, -1, 0);
  const double leaves = integrate_sphere(
      [&](Vec3f w) { return -w.z * coat.evaluate_lobes<Lobes::transmission>(w, wi, radiance).f_cos; }, up, 64, -1, 0);
  return enters * double(reflectance) / std::numbers::pi * leaves;
}

TEST(RoughCoat, exits_weighted_by_the_densities_of_their_draws_are_unbiased_and_others_are_not) {
  std::uint32_t seed = 0;
  for (const float alpha : {0.3f, 0.63f}) {
    const Dielectric<float> coat({alpha, alpha}, eta);
    const Vec3f wo = direction(0.7f, 0.2f), wi = direction(0.5f, 0.6f);
    const double truth = one_bounce(coat, wo, wi);
    const Estimates e = two_techniques(coat, wo, wi, 300000, ++seed);
    const double level = sidak_level(family_level, 4);
    EXPECT_GT(z_test(e.consistent.mean, e.consistent.standard_error(), truth).p_value, level)
        << "alpha " << alpha << ": " << e.consistent.mean << " for " << truth;
    EXPECT_LT(z_test(e.reversed.mean, e.reversed.standard_error(), truth).p_value, level);
    EXPECT_GT(e.reversed.mean, truth);
    std::printf("    alpha %.2f: the reversed density makes the bounce %.1f +- %.1f %% too bright\n", double(alpha),
                100 * (e.reversed.mean / truth - 1), 100 * e.reversed.standard_error() / truth);
  }
}

// Albedo of a coat by its own samples, and by its value at directions of a cosine lobe.
TEST(RoughCoat, values_and_samples_have_one_albedo) {
  std::uint32_t seed = 50;
  const float coats[] = {0.1f, 0.63f};
  const double level = sidak_level(family_level, 8);
  for (const float alpha : coats) {
    const BsdfCase c = coated_diffuse_case("", {.alpha_x = alpha, .alpha_y = alpha}, 1);
    const CoatedDiffuse<float> model(BsdfRows<float>{&c.row});
    for (const Vec3f wo : {direction(0.9f, 0.2f), direction(0.3f, 0.6f)}) {
      RandomStream<float> random(++seed, 23u);
      std::vector<double> drawn, valued;
      for (int i = 0; i < 200000; ++i) {
        const BsdfContext<float> first{radiance, random.fork(std::uint32_t(2 * i))},
            second{radiance, random.fork(std::uint32_t(2 * i + 1))};
        const float u = random.next();
        const BsdfSample<float> s = model.sample(wo, u, random.next2(), first);
        drawn.push_back(s.valid ? double(s.weight[0]) : 0);
        const Vec3f wi = sample_cosine_hemisphere(random.next2());
        valued.push_back(wi.z > 0 ? double(model.evaluate(wo, wi, second).f_cos[0]) * std::numbers::pi / double(wi.z)
                                  : 0);
      }
      const SampleSummary a = summarize(drawn);
      SampleSummary b = summarize(valued);
      EXPECT_GT(welch_test(a, b).p_value, level)
          << "alpha " << alpha << ", wo.z = " << wo.z << ": " << a.mean << " drawn, " << b.mean << " valued";
      b.mean *= 1.04;
      EXPECT_LT(welch_test(a, b).p_value, level) << "values that are 4 % too bright pass";
    }
  }
}

}  // namespace
}  // namespace montelux
