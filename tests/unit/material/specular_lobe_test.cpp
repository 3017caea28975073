// Events that are given, against those that the models sample: a share of the random numbers has each direction.
#include "material/specular_lobe.h"

#include <gtest/gtest.h>

namespace montelux {
namespace {

struct Model {
  BsdfKind kind;
  BsdfSlots<float> slots;
};

std::vector<Model> models() {
  Model metal{kind_of<Conductor>, {}}, glass{kind_of<Dielectric>, {}}, tinted{kind_of<TintedDielectric>, {}},
      pane{kind_of<ThinDielectric>, {}};
  for (int i = 0; i < spectrum_size; ++i) {
    metal.slots.v[ConductorSlots::eta + i] = 0.2f + 0.3f * float(i),
                                        metal.slots.v[ConductorSlots::k + i] = 3 - 0.5f * float(i);
    tinted.slots.v[TintedDielectricSlots::tint + i] = 0.9f - 0.2f * float(i);
    pane.slots.v[ThinDielectricSlots::tint + i] = 0.5f + 0.1f * float(i);
  }
  glass.slots.v[DielectricSlots::eta] = 1.5f, tinted.slots.v[TintedDielectricSlots::eta] = 1.3f;
  pane.slots.v[ThinDielectricSlots::eta] = 1.5f;
  return {metal, glass, tinted, pane};
}

TEST(SpecularLobe, has_the_mean_and_the_direction_of_what_is_sampled) {
  for (const Model& m : models())
    for (const float cos_o : {0.9f, 0.5f, 0.1f, -0.95f, -0.4f}) {
      SCOPED_TRACE(std::string(name(m.kind)) + " " + std::to_string(cos_o));
      const Vec3f wo{std::sqrt(1 - cos_o * cos_o), 0, cos_o};
      const BsdfLanes<float> lanes{std::uint32_t(m.kind), &m.slots, true};
      // By one coordinate in equal steps the mean is exact up to the last step.
      constexpr int steps = 1 << 14;
      std::array<std::array<double, spectrum_size>, 2> sum{};
      std::array<Vec3f, 2> directions{};
      for (int i = 0; i < steps; ++i) {
        const BsdfSample<float> s = sample<float>(lanes, wo, {(float(i) + 0.5f) / steps, 0.5f, 0.5f}, {});
        if (!s.valid) continue;
        EXPECT_TRUE(s.delta);
        const std::size_t which = wo.z * s.wi.z > 0 ? 1 : 0;
        for (int c = 0; c < spectrum_size; ++c) sum[which][std::size_t(c)] += double(s.weight.c[c]) / steps;
        directions[which] = s.wi;
      }
      for (const bool reflects : {false, true}) {
        const SpecularLobe<float> lobe = specular_lobe(m.kind, m.slots, cos_o, reflects);
        for (int c = 0; c < spectrum_size; ++c)
          EXPECT_NEAR(sum[reflects ? 1 : 0][std::size_t(c)], double(lobe.weight.c[c]), 2e-4);
        if (reflects || !(max_component(lobe.weight) > 0)) continue;
        // Snell's law.
        EXPECT_NEAR(directions[0].x * lobe.relative_eta, -wo.x, 1e-5f);
      }
    }
}

TEST(SpecularLobe, is_black_of_other_models_and_of_metal_that_would_refract) {
  const BsdfSlots<float> slots{};
  EXPECT_EQ(max_component(specular_lobe(kind_of<Diffuse>, slots, 0.5f, true).weight), 0);
  EXPECT_EQ(max_component(specular_lobe(kind_of<Conductor>, models()[0].slots, 0.5f, false).weight), 0);
}

}  // namespace
}  // namespace montelux
