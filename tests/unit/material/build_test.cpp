#include "material/build.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "material/table.h"

namespace montelux {
namespace {

// Builds materials without a scene around them.
struct Workshop {
  Diagnostics diagnostics;
  TextureSet textures;
  TextureBuilder builder{textures, std::filesystem::temp_directory_path().string(),
                         [](const SpectrumValue& value) { return std::get<RgbValue>(value).rgb; }, diagnostics};
  MaterialInputs inputs{
      builder,
      [](const SpectrumValue& eta, const SpectrumValue&) {
        const bool copper = std::holds_alternative<NamedSpectrum>(eta);
        return ConductorRgb{gray_rgb(copper ? 0.3f : std::get<RgbValue>(eta).rgb.c[0]), gray_rgb(3.0f)};
      },
      [](const SpectrumValue& value) { return std::get<RgbValue>(value).rgb; },
      [](const SpectrumValue&) { return 1.52f; },
      [](const std::string& name) { return name == "known" ? std::optional<std::uint32_t>(7) : std::nullopt; },
      diagnostics};

  Material build(const Entity& entity) { return build_material(entity, inputs); }
  BsdfRow row(const Material& material) const {
    return material_row(material, textures, {{0.2f, 0.3f}, {}, {0, 0, 1}});
  }
};

Entity entity(std::string type, std::vector<Parameter> parameters = {}) {
  Entity e{std::move(type), {}, {}};
  for (Parameter& p : parameters) e.parameters.add(std::move(p));
  return e;
}
Parameter number(std::string name, float value) {
  return {std::move(name), ParameterType::number, std::vector<float>{value}, {}};
}
Parameter spectrum(std::string name, Rgb value) {
  return {std::move(name), ParameterType::spectrum, std::vector<SpectrumValue>{RgbValue{value}}, {}};
}
Parameter boolean(std::string name, bool value) {
  return {std::move(name), ParameterType::boolean, std::vector<std::uint8_t>{std::uint8_t(value)}, {}};
}
Parameter texture(std::string name, std::string of) {
  return {std::move(name), ParameterType::texture, TextureName{std::move(of)}, {}};
}

TEST(BuildMaterial, every_model_of_the_list_is_built_under_its_own_name) {
  for (std::size_t i = 0; i < bsdf_kind_count; ++i) {
    Workshop shop;
    const auto kind = BsdfKind(i);
    const Material m = shop.build(entity(std::string(name(kind))));
    EXPECT_EQ(m.kind, kind) << name(kind);
    EXPECT_TRUE(m.is_plain()) << name(kind);
    EXPECT_TRUE(shop.diagnostics.all().empty()) << name(kind);
    EXPECT_NE(find_entity(material_table(), name(kind)), nullptr) << name(kind);
  }
}

TEST(BuildMaterial, coated_diffuse_has_the_documented_defaults) {
  Workshop shop;
  const BsdfRow row = shop.build(entity("coateddiffuse")).row;
  using Slots = CoatedDiffuseSlots;
  EXPECT_EQ(row.v[Slots::alpha_x], 0);
  EXPECT_EQ(row.v[Slots::eta], 1.5f);
  EXPECT_EQ(row.v[Slots::thickness], 0.01f);
  EXPECT_EQ(row.v[Slots::albedo], 0);
  EXPECT_EQ(row.v[Slots::max_depth], 10);
  EXPECT_EQ(row.v[Slots::samples], 1);
  EXPECT_EQ(row.v[Slots::reflectance + 2], 0.5f);
}

TEST(BuildMaterial, metal_under_a_coat_is_relative_to_the_coat) {
  Workshop shop;
  using Slots = CoatedConductorSlots;
  const BsdfRow copper = shop.build(entity("coatedconductor", {number("interface.eta", 2)})).row;
  EXPECT_FLOAT_EQ(copper.v[Slots::conductor_eta], 0.15f);
  EXPECT_FLOAT_EQ(copper.v[Slots::conductor_k], 1.5f);
  const BsdfRow by_reflectance =
      shop.build(entity("coatedconductor", {number("interface.eta", 2), spectrum("reflectance", gray_rgb(0.5f))})).row;
  EXPECT_FLOAT_EQ(by_reflectance.v[Slots::conductor_eta], 0.5f);
  EXPECT_FLOAT_EQ(by_reflectance.v[Slots::conductor_k], 1.0f);
}

TEST(BuildMaterial, reflectance_of_a_metal_is_met_at_normal_incidence) {
  Workshop shop;
  const Material m = shop.build(entity("conductor", {spectrum("reflectance", Rgb{{0.2f, 0.6f, 1.0f}})}));
  const Conductor<float> conductor(BsdfRows<float>{&m.row});
  const BsdfSample<float> s = conductor.sample({0, 0, 1}, 0.5f, {0.5f, 0.5f}, {});
  EXPECT_NEAR(s.weight[0], 0.2, 1e-5);
  EXPECT_NEAR(s.weight[1], 0.6, 1e-5);
  EXPECT_NEAR(s.weight[2], 0.9999, 1e-5);
}

TEST(BuildMaterial, roughness_is_remapped_unless_told_not_to) {
  Workshop shop;
  const BsdfRow remapped = shop.build(entity("dielectric", {number("roughness", 0.25f)})).row;
  EXPECT_FLOAT_EQ(remapped.v[DielectricSlots::alpha_x], 0.5f);
  const BsdfRow plain = shop.build(entity("dielectric", {number("uroughness", 0.25f), number("vroughness", 0.1f),
                                                         boolean("remaproughness", false)}))
                            .row;
  EXPECT_FLOAT_EQ(plain.v[DielectricSlots::alpha_x], 0.25f);
  EXPECT_FLOAT_EQ(plain.v[DielectricSlots::alpha_y], 0.1f);
}

TEST(BuildMaterial, scaled_reflectance_is_clamped_after_scaling) {
  Workshop shop;
  const BsdfRow row =
      shop.build(entity("diffusetransmission", {spectrum("reflectance", gray_rgb(0.6f)),
                                                spectrum("transmittance", gray_rgb(1.5f)), number("scale", 0.5f)}))
          .row;
  EXPECT_FLOAT_EQ(row.v[DiffuseTransmissionSlots::reflectance], 0.3f);
  EXPECT_FLOAT_EQ(row.v[DiffuseTransmissionSlots::transmittance], 0.75f);
  const BsdfRow bright = shop.build(entity("diffusetransmission", {number("scale", 8)})).row;
  EXPECT_FLOAT_EQ(bright.v[DiffuseTransmissionSlots::reflectance], 1.0f);
}

TEST(BuildMaterial, varying_texture_is_bound_and_looked_up_at_the_point) {
  Workshop shop;
  shop.builder.add("board", true,
                   entity("checkerboard", {spectrum("tex1", gray_rgb(0.9f)), spectrum("tex2", gray_rgb(0.1f))}),
                   Transform{});
  const Material m = shop.build(entity("diffuse", {texture("reflectance", "board")}));
  ASSERT_EQ(m.bindings.size(), 1u);
  EXPECT_FALSE(m.is_plain());
  const float at = shop.row(m).v[DiffuseSlots::reflectance];
  EXPECT_TRUE(at == 0.9f || at == 0.1f) << at;
}

TEST(BuildMaterial, mix_names_its_children_and_reports_unknown_ones) {
  Workshop shop;
  Parameter names{"materials", ParameterType::string, std::vector<std::string>{"known", "unknown"}, {}};
  const Material m = shop.build(entity("mix", {names, number("amount", 0.25f)}));
  ASSERT_TRUE(m.mixture.has_value());
  EXPECT_EQ(m.mixture->children[0], 7u);
  EXPECT_EQ(shop.textures.constant(m.mixture->amount), 0.25f);
  EXPECT_EQ(shop.diagnostics.errors(), 1);
}

TEST(BuildMaterial, interface_scatters_nothing) {
  Workshop shop;
  EXPECT_TRUE(shop.build(entity("interface")).is_interface);
  EXPECT_TRUE(shop.build(entity("")).is_interface);
}

}  // namespace
}  // namespace montelux
