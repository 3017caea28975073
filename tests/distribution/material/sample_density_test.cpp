// What models draw follows the density that they state: those whose density is a closed form, and those that have one
// where exact densities are requested.
#include <gtest/gtest.h>

#include "cases.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

constexpr double sample_count = 100000;
constexpr double tests_in_family = 200;  // not fewer than all calls of the chi-square test in this file

// `stated` turns the model's density into the one that is claimed: the identity, or a planted fault.
template <class Model, class Stated>
TestResult samples_against_density(const Model& model, const BsdfCase& c, Vec3f wo, std::uint32_t seed, Stated stated) {
  RandomStream<float> none(seed, 1u);
  const BsdfContext<float> context = exact_context_of(none);
  return chi_square_sample_density(
      [&](RandomStream<float>& stream) {
        const float u = stream.next();
        const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
        // A delta beside a density is not the density's.
        return s.valid && !s.delta ? s.wi : Vec3f{0, 0, 0};
      },
      [&](Vec3f wi) { return stated(model.evaluate(wo, wi, context).density.value, wi); }, sample_count, seed,
      LocalFrame<float>::from_normal({0, 0, 1}), c.panels);
}

// Walks that meet deltas alone are drawn by numbers of their own, one for each direction; here they have but one, which
// is all the same to what is no delta.
TEST(BsdfDistribution, directions_follow_the_density) {
  std::uint32_t seed = 1;
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if (model.is_delta()) return;
    for (const Vec3f wo : outgoing_directions()) {
      const TestResult r = samples_against_density(model, c, wo, seed += 2, [](float p, Vec3f) { return p; });
      EXPECT_GT(r.p_value, sidak_level(family_level, tests_in_family))
          << Model::name << ", " << c.label << ", wo.z = " << wo.z << ":" << r.note;
    }
  });
}

TEST(BsdfDistribution, a_density_that_leans_to_one_side_is_rejected) {
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if (model.is_delta()) return;
    const Vec3f wo = outgoing_directions()[1];
    const TestResult r =
        samples_against_density(model, c, wo, 77, [](float p, Vec3f wi) { return p * (wi.x > 0 ? 1.05f : 0.95f); });
    EXPECT_LT(r.p_value, sidak_level(family_level, tests_in_family)) << Model::name << ", " << c.label;
  });
}

TEST(BsdfDistribution, weight_is_value_over_density) {
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    // A value that is itself random is sampled again.
    const bool is_drawn = std::is_same_v<Model, CoatedDiffuse<float>> && c.row.v[CoatedDiffuseSlots::internal] > 0;
    if (is_drawn || model.is_delta()) return;
    RandomStream<float> stream(5, 6);
    const BsdfContext<float> context = exact_context_of(stream);
    for (const Vec3f wo : outgoing_directions())
      for (int i = 0; i < 2000; ++i) {
        const float u = stream.next();
        const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
        // The half vector of nearly opposite directions is lost to rounding.
        if (!s.valid || s.delta || std::abs(s.wi.z) < 1e-2f || length(s.wi + wo) < 1e-1f) continue;
        const BsdfValue<float> v = model.evaluate(wo, s.wi, context);
        ASSERT_NEAR(v.density.value / s.density.value, 1, 2e-3) << Model::name << ", " << c.label << " " << wo.z;
        for (int k = 0; k < spectrum_size; ++k)
          ASSERT_NEAR(v.f_cos[k], s.weight[k] * v.density.value, 2e-3 * v.f_cos[k] + 1e-6) << Model::name;
      }
  });
}

TEST(BsdfDistribution, delta_models_have_no_value_and_sample_deltas) {
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if (!model.is_delta()) return;
    RandomStream<float> stream(7, 8);
    for (const Vec3f wo : outgoing_directions())
      for (int i = 0; i < 100; ++i) {
        const BsdfContext<float> context = context_of(stream);
        const float u = stream.next();
        const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
        EXPECT_TRUE(!s.valid || s.delta) << Model::name << ", " << c.label;
        const BsdfValue<float> v = model.evaluate(wo, s.wi, context);
        EXPECT_EQ(v.density.value, 0);
        EXPECT_EQ(max_component(v.f_cos), 0);
      }
  });
}

}  // namespace
}  // namespace montelux
