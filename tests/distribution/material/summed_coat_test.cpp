// Coats over Lambert's law whose walks are summed in closed form, against the walks themselves, their own density, and
// the series of a smooth coat.
#include <gtest/gtest.h>

#include "cases.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

struct Coats {
  BsdfCase walked, summed;
};
std::vector<Coats> coats() {
  const CoatCase all[] = {{.alpha_x = 0.4f, .alpha_y = 0.4f},
                          {.alpha_x = 0.05f, .alpha_y = 0.3f, .thickness = 0.3f, .max_depth = 5},
                          {.alpha_x = 0.2f, .alpha_y = 0.2f, .eta = 2, .max_depth = 100},
                          {.thickness = 0.1f}};
  std::vector<Coats> result;
  for (const CoatCase& c : all) result.push_back({coated_diffuse_case("", c, 0.9f), summed_coat_case("", c, 0.9f)});
  return result;
}

SampleSummary mean_value(const BsdfCase& c, Vec3f wo, Vec3f wi, int count, std::uint32_t seed, TransportMode mode) {
  const CoatedDiffuse<float> model(BsdfRows<float>{&c.row});
  RandomStream<float> stream(seed, 3u);
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(double(model.evaluate(wo, wi, context_of(stream, mode)).f_cos[1]));
  return summarize(x);
}

TEST(SummedCoat, value_is_that_of_the_walks) {
  std::uint32_t seed = 10;
  for (const Coats& c : coats())
    for (const TransportMode mode : {TransportMode::radiance, TransportMode::importance})
      for (const Vec3f wi : {direction(0.35f, 0.9f), direction(0.9f, 0.3f)}) {
        const Vec3f wo = direction(0.6f, 0.2f);
        const SampleSummary walked = mean_value(c.walked, wo, wi, 60000, ++seed, mode);
        SampleSummary summed = mean_value(c.summed, wo, wi, 20000, ++seed, mode);
        EXPECT_GT(welch_test(walked, summed).p_value, sidak_level(family_level, 16))
            << walked.mean << " by walks, " << summed.mean;
        summed.mean *= 1.04;
        EXPECT_LT(welch_test(walked, summed).p_value, sidak_level(family_level, 16));
      }
}

TEST(SummedCoat, rough_directions_follow_the_density) {
  std::uint32_t seed = 40;
  for (const BsdfCase& c : {summed_coat_case("", {.alpha_x = 0.4f, .alpha_y = 0.4f}, 0.3f),
                            summed_coat_case("", {.alpha_x = 0.2f, .alpha_y = 0.5f, .eta = 1.8f}, 0.8f)}) {
    const CoatedDiffuse<float> model(BsdfRows<float>{&c.row});
    RandomStream<float> none(9, 1u);
    const BsdfContext<float> context = context_of(none);
    for (const Vec3f wo : outgoing_directions()) {
      const auto test = [&](auto fault) {
        return chi_square_sample_density(
            [&](RandomStream<float>& stream) {
              const float u = stream.next();
              const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
              return s.valid ? s.wi : Vec3f{0, 0, 0};
            },
            [&](Vec3f wi) { return fault(model.evaluate(wo, wi, context).density.value, wi); }, 100000, seed,
            LocalFrame<float>::from_normal({0, 0, 1}), 2);
      };
      seed += 2;
      const TestResult right = test([](float p, Vec3f) { return p; });
      EXPECT_GT(right.p_value, sidak_level(family_level, 16)) << "wo.z = " << wo.z << ": " << right.note;
      const TestResult wrong = test([](float p, Vec3f wi) { return p * (wi.x > 0 ? 1.05f : 0.95f); });
      EXPECT_LT(wrong.p_value, sidak_level(family_level, 16)) << "wo.z = " << wo.z;
    }
  }
}

// The internal reflectance of a smooth coat is one integral of Fresnel's law.
TEST(SummedCoat, internal_reflectance_of_a_smooth_coat_is_an_integral_over_angles) {
  for (const float eta : {1.2f, 1.5f, 2.4f})
    for (const float thickness : {1e-30f, 0.01f, 0.5f}) {
      const double truth = integrate(
          [&](double mu) {
            return 2 * mu * double(fresnel_dielectric(float(-mu), eta)) * std::exp(-2 * double(thickness) / mu);
          },
          0, 1, 20000);
      EXPECT_NEAR(internal_reflectance({{0, 0}, eta, thickness}), truth, 1e-4 * truth) << eta << " " << thickness;
    }
}

}  // namespace
}  // namespace montelux
