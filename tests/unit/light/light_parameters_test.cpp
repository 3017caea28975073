// Lights from the parameters of a scene file.
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

Made make(Entity entity, const Transform& to_world = {}) {
  LightInputs inputs{[](const SpectrumValue& v) { return std::get<RgbValue>(v).rgb; },
                     [](const std::string& name, const SourceLocation&) -> std::shared_ptr<const LightImage> {
                       if (name == "square") return test_image();
                       if (name == "wide")
                         return std::make_shared<LightImage>(LightImage{2, 1, {gray_rgb(1.0f), gray_rgb(1.0f)}});
                       return nullptr;
                     }};
  Made made;
  LightSetBuilder builder;
  made.id = builder.add(entity, to_world, inputs, made.diagnostics);
  made.lights = alone(std::move(builder));
  return made;
}

Parameter number(std::string name, float x) {
  return {std::move(name), ParameterType::number, std::vector<float>{x}, {}};
}
Parameter text(std::string name, std::string x) {
  return {std::move(name), ParameterType::string, std::vector<std::string>{std::move(x)}, {}};
}
Parameter point(std::string name, Vec3f x) {
  return {std::move(name), ParameterType::point3, std::vector<Vec3f>{x}, {}};
}
Parameter rgb(std::string name, Rgb x) {
  return {std::move(name), ParameterType::spectrum, std::vector<SpectrumValue>{RgbValue{x}}, {}};
}
Entity entity(std::string type, std::vector<Parameter> parameters) {
  Entity e{std::move(type), {}, {}};
  for (Parameter& p : parameters) e.parameters.add(std::move(p));
  return e;
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
  for (const EntitySpec& spec : light_table()) {
    Made made = make(entity(std::string(spec.name), {text("filename", spec.name == "point" ? "" : "square")}));
    EXPECT_TRUE(made.id) << spec.name;
    EXPECT_FALSE(made.diagnostics.has_errors()) << spec.name;
  }
}

TEST(LightParameters, power_is_what_a_light_in_one_point_sends_in_all) {
  for (std::string type : {"point", "spot", "goniometric", "projection"}) {
    std::vector<Parameter> parameters{number("power", 30)};
    if (type == "goniometric" || type == "projection") parameters.push_back(text("filename", "square"));
    Made made = make(entity(type, parameters), translate(1, 2, 3));
    // The sharp edge of a projected picture cuts through about one in thirty of its cells of directions.
    EXPECT_NEAR(sent(made.lights, {1, 2, 3}) / 30, 1, type == "projection" ? 4e-3 : 1e-3) << type;
  }
}

TEST(LightParameters, illuminance_is_what_the_upward_plane_receives) {
  for (std::string file : {"", "square"}) {
    Made made = make(entity("infinite", {text("filename", file), number("illuminance", 5)}));
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
  Made made =
      make(entity("point", {rgb("I", {1, 2, 3}), number("scale", 4), point("from", {0, 0, 2})}), scale(1, 1, 2));
  LightSample<float> s = made.lights.sample<float>({0, 0, 2}, {0, 0, 0}, 0.5f, Vec2f{0.5f, 0.5f}, true);
  EXPECT_FLOAT_EQ(s.distance, 2);
  EXPECT_FLOAT_EQ(s.radiance[1], 2);
}

TEST(LightParameters, distant_light_comes_from_where_it_is_said_to) {
  Made made = make(entity("distant", {point("from", {0, 5, 0}), point("to", {0, 0, 0}), rgb("L", {3, 3, 3})}));
  LightSample<float> s = made.lights.sample<float>({0, 0, 2}, {0, 0, 0}, 0.5f, Vec2f{0.5f, 0.5f}, true);
  EXPECT_FLOAT_EQ(s.wi.y, 1);
  EXPECT_FLOAT_EQ(s.radiance[0], 3);
}

TEST(LightParameters, images_of_directions_must_be_square_and_readable) {
  for (std::string type : {"infinite", "goniometric"})
    for (std::string file : {"wide", "missing"}) {
      Made made = make(entity(type, {text("filename", file)}));
      EXPECT_FALSE(made.id) << type << " " << file;
      EXPECT_TRUE(made.diagnostics.has_errors()) << type << " " << file;
    }
  EXPECT_FALSE(make(entity("projection", {})).id);
  EXPECT_FALSE(make(entity("lamp", {})).id);
}

TEST(LightParameters, lights_belong_to_the_group_that_they_state) {
  LightSetBuilder b;
  Diagnostics diagnostics;
  const LightInputs inputs{};
  b.add(entity("point", {text("group", "key")}), Transform(), inputs, diagnostics);
  b.add(entity("point", {}), Transform(), inputs, diagnostics);
  b.add(TriangleShape{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {.radiance = gray_rgb(1.0f), .group = "key"});
  b.add(entity("distant", {text("group", "far_2")}), Transform(), inputs, diagnostics);
  const LightSet lights = alone(std::move(b));
  EXPECT_EQ(lights.group_names(), (std::vector<std::string>{"key", "default", "far_2"}));
  EXPECT_EQ(lights.groups(), (std::vector<std::uint32_t>{0, 1, 0, 2}));
  EXPECT_FALSE(diagnostics.has_errors());
  for (const char* name : {"", "two words", "a.b", "\n"})
    EXPECT_TRUE(make(entity("point", {text("group", name)})).diagnostics.has_errors()) << name;
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
