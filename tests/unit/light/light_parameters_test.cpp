// Lights from what a scene states.
#include <gtest/gtest.h>

#include "light/table.h"
#include "light_cases.h"

namespace montelux::test {
namespace {

struct Made {
  std::optional<LightId> id;
  Diagnostics diagnostics;
  LightSet lights;
};

Made make(const LightDesc& light) {
  LightInputs inputs{[](const SpectrumValue& v) { return std::get<RgbValue>(v).rgb; },
                     [](const std::string& name, const SourceLocation&) -> std::shared_ptr<const LightImage> {
                       if (name == "square") return test_image();
                       if (name == "wide")
                         return std::make_shared<LightImage>(LightImage{2, 1, {gray_rgb(1.0f), gray_rgb(1.0f)}});
                       return nullptr;
                     }};
  Made made;
  LightSetBuilder builder;
  made.id = builder.add(light, inputs, made.diagnostics);
  made.lights = alone(std::move(builder));
  return made;
}

LightDesc light(LightModel model, const Transform& to_world = {}) {
  LightDesc desc;
  desc.model = std::move(model), desc.light_to_world = to_world;
  return desc;
}
LightDesc light_of_group(std::string group, LightModel model = PointLightDesc{}) {
  LightDesc desc = light(std::move(model));
  desc.group = std::move(group);
  return desc;
}
// With everything that it needs.
LightModel needing_image(LightModel model) {
  if (auto* slide = std::get_if<ProjectionLightDesc>(&model)) slide->file = "square";
  return model;
}

// The integral over the sphere of directions of what a light in one point sends: its power.
float sent(const LightSet& lights, Vec3f place) {
  double sum = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Vec3f w = sphere_from_square(Vec2f{(float(i) + 0.5f) / n, (float(j) + 0.5f) / n});
      LightSample<float> s = lights.sample<float>(place + w, {0, 0, 0}, 0.5f, Vec2f{0.5f, 0.5f}, true);
      if (s.valid) sum += double(luminance(to_rgb(s.radiance)));
    }
  return float(4 * std::numbers::pi * sum / (n * n));
}

TEST(LightParameters, every_light_of_the_table_can_be_made) {
  for (const EntitySpec& spec : light_models().specs()) {
    const LightDesc& usual = light_models().initial(spec.name);
    EXPECT_EQ(name_of(usual.model), spec.name);
    Made made = make(light(needing_image(usual.model)));
    EXPECT_TRUE(made.id) << spec.name;
    EXPECT_FALSE(made.diagnostics.has_errors()) << spec.name;
  }
}

TEST(LightParameters, power_is_what_a_light_in_one_point_sends_in_all) {
  PointLightDesc point;
  SpotLightDesc spot;
  GoniometricLightDesc goniometric;
  ProjectionLightDesc projection;
  goniometric.file = projection.file = "square";
  point.power = spot.power = goniometric.power = projection.power = 30;
  for (const LightModel& model :
       {LightModel(point), LightModel(spot), LightModel(goniometric), LightModel(projection)}) {
    Made made = make(light(model, translate(1, 2, 3)));
    // The sharp edge of a projected picture cuts through about one in thirty of its cells of directions.
    const bool is_slide = std::holds_alternative<ProjectionLightDesc>(model);
    EXPECT_NEAR(sent(made.lights, {1, 2, 3}) / 30, 1, is_slide ? 4e-3 : 1e-3) << name_of(model);
  }
}

TEST(LightParameters, illuminance_is_what_the_upward_plane_receives) {
  for (std::string file : {"", "square"}) {
    InfiniteLightDesc sky;
    sky.file = file, sky.illuminance = 5;
    Made made = make(light(sky));
    double sum = 0;
    const int n = 400;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        Vec3f w = sphere_from_square(Vec2f{(float(i) + 0.5f) / n, (float(j) + 0.5f) / n});
        sum += double(luminance(to_rgb(made.lights.escaped_radiance<float>(w, true))) * max(w.z, 0.0f));
      }
    // The sum over cells, whose error falls as 1 / n^2, but where the edges of the file's texels cut them.
    EXPECT_NEAR(4 * std::numbers::pi * sum / (n * n), 5, 5e-4) << file;
  }
}

TEST(LightParameters, emission_is_scaled_as_stated) {
  LightDesc lamp = light(PointLightDesc{RgbValue{{{1, 2, 3}}}, {0, 0, 2}}, scale(1, 1, 2));
  lamp.scale = 4;
  Made made = make(lamp);
  LightSample<float> s = made.lights.sample<float>({0, 0, 2}, {0, 0, 0}, 0.5f, Vec2f{0.5f, 0.5f}, true);
  EXPECT_FLOAT_EQ(s.distance, 2);
  EXPECT_FLOAT_EQ(s.radiance[1], 2);
}

TEST(LightParameters, distant_light_comes_from_where_it_is_said_to) {
  Made made = make(light(DistantLightDesc{gray_value(3), {0, 5, 0}, {0, 0, 0}}));
  LightSample<float> s = made.lights.sample<float>({0, 0, 2}, {0, 0, 0}, 0.5f, Vec2f{0.5f, 0.5f}, true);
  EXPECT_FLOAT_EQ(s.wi.y, 1);
  EXPECT_FLOAT_EQ(s.radiance[0], 3);
}

TEST(LightParameters, images_of_directions_must_be_square_and_readable) {
  for (std::string file : {"wide", "missing"}) {
    InfiniteLightDesc sky;
    GoniometricLightDesc lamp;
    sky.file = lamp.file = file;
    for (const LightModel& model : {LightModel(sky), LightModel(lamp)}) {
      Made made = make(light(model));
      EXPECT_FALSE(made.id) << name_of(model) << " " << file;
      EXPECT_TRUE(made.diagnostics.has_errors()) << name_of(model) << " " << file;
    }
  }
  EXPECT_FALSE(make(light(ProjectionLightDesc{})).id);
}

TEST(LightParameters, lights_belong_to_the_group_that_they_state) {
  LightSetBuilder b;
  Diagnostics diagnostics;
  const LightInputs inputs{[](const SpectrumValue& v) { return std::get<RgbValue>(v).rgb; }, {}};
  b.add(light_of_group("key"), inputs, diagnostics);
  b.add(light(PointLightDesc{}), inputs, diagnostics);
  b.add(TriangleShape{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {.radiance = gray_rgb(1.0f), .group = "key"});
  b.add(light_of_group("far_2", DistantLightDesc{}), inputs, diagnostics);
  const LightSet lights = alone(std::move(b));
  EXPECT_EQ(lights.group_names(), (std::vector<std::string>{"key", "default", "far_2"}));
  EXPECT_EQ(lights.groups(), (std::vector<std::uint32_t>{0, 1, 0, 2}));
  EXPECT_FALSE(diagnostics.has_errors());
  for (const char* name : {"", "two words", "a.b", "\n"})
    EXPECT_TRUE(make(light_of_group(name)).diagnostics.has_errors()) << name;
}

TEST(LightParameters, power_of_a_surface_is_what_it_emits_in_all) {
  for (bool two_sided : {false, true}) {
    LightSetBuilder b;
    b.add(PatchShape{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}},
          {.radiance = gray_rgb(1.0f), .power = 60.0f, .two_sided = two_sided});
    LightSet lights = alone(std::move(b));
    float radiance = lights.hit_radiance<float>(0, {0, 0, 1}, {0.5f, 0.5f}, {0, 0, -1}, true)[0];
    EXPECT_NEAR(radiance * pi * 6 * (two_sided ? 2 : 1), 60, 1e-3);
  }
}

}  // namespace
}  // namespace montelux::test
