#include "material/build.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "material/measured_table.h"
#include "material/table.h"

namespace montelux {
namespace {

// Builds materials without a scene around them.
struct Workshop {
  Diagnostics diagnostics;
  TextureSet textures;
  CoatTables coats;
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
      [this](const std::string& file, const SourceLocation& where) -> std::shared_ptr<const MeasuredTable> {
        if (file == "table.bsdf") return table;
        diagnostics.error(where, "no table");
        return nullptr;
      },
      coats,
      diagnostics};
  std::shared_ptr<const MeasuredTable> table = table_of({0});

  // A table for these azimuths.
  static std::shared_ptr<const MeasuredTable> table_of(std::vector<float> azimuths) {
    const std::size_t numbers = 4 * azimuths.size();
    MeasuredData data;
    data.elevations = {0}, data.azimuths = std::move(azimuths), data.ndf = data.sigma = {1};
    data.vndf_size = data.value_size = {2, 2};
    data.vndf.assign(numbers, 1), data.luminance.assign(numbers, 1), data.values.assign(3 * numbers, 1);
    return std::make_shared<const MeasuredTable>(std::move(data));
  }

  Material build(const MaterialDesc& desc) { return build_material(desc, inputs); }
  Material build(MaterialModel model) {
    MaterialDesc desc;
    desc.model = std::move(model);
    return build(desc);
  }
  // A checkerboard of 0.9 and 0.1 by this name.
  void add_board() {
    CheckerboardTextureDesc board;
    board.even = gray_value(0.9f), board.odd = gray_value(0.1f);
    builder.add({"board", true, board, {}, {}});
  }
  // The same of numbers, 0.3 and 0.1.
  void add_roughness(const std::string& name) {
    CheckerboardTextureDesc board;
    board.even = 0.3f, board.odd = 0.1f;
    builder.add({name, false, board, {}, {}});
  }
  BsdfRow row(const Material& material) const {
    return material_row(material, textures, {{0.2f, 0.3f}, {}, {0, 0, 1}});
  }
};

TEST(BuildMaterial, every_model_of_the_list_is_built_under_its_own_name) {
  for (std::size_t i = 0; i < bsdf_kind_count; ++i) {
    Workshop shop;
    const auto kind = BsdfKind(i);
    MaterialDesc desc = material_models().initial(name(kind));
    if (auto* measured = std::get_if<MeasuredDesc>(&desc.model)) measured->file = "table.bsdf";
    const Material m = shop.build(desc);
    EXPECT_EQ(m.kind, kind) << name(kind);
    EXPECT_TRUE(m.is_plain()) << name(kind);
    EXPECT_TRUE(shop.diagnostics.all().empty()) << name(kind);
  }
}

TEST(BuildMaterial, coated_diffuse_has_the_documented_defaults) {
  Workshop shop;
  const BsdfRow row = shop.build(CoatedDiffuseDesc{}).row;
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
  CoatedConductorDesc coated;
  coated.coat_eta = 2.0f;
  const BsdfRow copper = shop.build(coated).row;
  EXPECT_FLOAT_EQ(copper.v[Slots::conductor_eta], 0.15f);
  EXPECT_FLOAT_EQ(copper.v[Slots::conductor_k], 1.5f);
  coated.metal.reflectance = gray_value(0.5f);
  const BsdfRow by_reflectance = shop.build(coated).row;
  EXPECT_FLOAT_EQ(by_reflectance.v[Slots::conductor_eta], 0.5f);
  EXPECT_FLOAT_EQ(by_reflectance.v[Slots::conductor_k], 1.0f);
}

TEST(BuildMaterial, roughness_of_coat_and_metal_are_their_own) {
  Workshop shop;
  using Slots = CoatedConductorSlots;
  CoatedConductorDesc coated;
  coated.maps_roughness = false;
  coated.metal_facets.roughness = 0.25f, coated.coat_facets.roughness_v = NumberInput(0.5f);
  const BsdfRow row = shop.build(coated).row;
  EXPECT_EQ(row.v[Slots::conductor_alpha_x], 0.25f);
  EXPECT_EQ(row.v[Slots::conductor_alpha_x + 1], 0.25f);
  EXPECT_EQ(row.v[LayeredSlots::alpha_x], 0);
  EXPECT_EQ(row.v[LayeredSlots::alpha_y], 0.5f);
}

TEST(BuildMaterial, reflectance_of_a_metal_is_met_at_normal_incidence) {
  Workshop shop;
  ConductorDesc metal;
  metal.metal.reflectance = RgbValue{Rgb{{0.2f, 0.6f, 1.0f}}};
  const Material m = shop.build(metal);
  const Conductor<float> conductor(BsdfRows<float>{&m.row});
  const BsdfSample<float> s = conductor.sample({0, 0, 1}, 0.5f, {0.5f, 0.5f}, {});
  EXPECT_NEAR(s.weight[0], 0.2, 1e-5);
  EXPECT_NEAR(s.weight[1], 0.6, 1e-5);
  EXPECT_NEAR(s.weight[2], 0.9999, 1e-5);
}

TEST(BuildMaterial, roughness_is_remapped_unless_reported_not_to) {
  Workshop shop;
  DielectricDesc glass;
  glass.facets.roughness = 0.25f;
  const BsdfRow remapped = shop.build(glass).row;
  EXPECT_FLOAT_EQ(remapped.v[DielectricSlots::alpha_x], 0.5f);
  glass.facets = {0.0f, NumberInput(0.25f), NumberInput(0.1f)}, glass.maps_roughness = false;
  const BsdfRow plain = shop.build(glass).row;
  EXPECT_FLOAT_EQ(plain.v[DielectricSlots::alpha_x], 0.25f);
  EXPECT_FLOAT_EQ(plain.v[DielectricSlots::alpha_y], 0.1f);
}

TEST(BuildMaterial, scaled_reflectance_is_clamped_after_scaling) {
  Workshop shop;
  const BsdfRow row = shop.build(DiffuseTransmissionDesc{gray_value(0.6f), gray_value(1.5f), 0.5f}).row;
  EXPECT_FLOAT_EQ(row.v[DiffuseTransmissionSlots::reflectance], 0.3f);
  EXPECT_FLOAT_EQ(row.v[DiffuseTransmissionSlots::transmittance], 0.75f);
  DiffuseTransmissionDesc bright;
  bright.scale = 8;
  EXPECT_FLOAT_EQ(shop.build(bright).row.v[DiffuseTransmissionSlots::reflectance], 1.0f);
}

TEST(BuildMaterial, varying_texture_is_bound_and_looked_up_at_the_point) {
  Workshop shop;
  shop.add_board();
  const Material m = shop.build(DiffuseDesc{TextureName{"board"}});
  ASSERT_EQ(m.bindings.size(), 1u);
  EXPECT_FALSE(m.is_plain());
  const float at = shop.row(m).v[DiffuseSlots::reflectance];
  EXPECT_TRUE(at == 0.9f || at == 0.1f) << at;
}

// A texture of eta, with the default of k.
TEST(BuildMaterial, index_of_a_metal_may_be_a_texture) {
  Workshop shop;
  shop.add_board();
  ConductorDesc metal;
  metal.metal.eta = TextureName{"board"};
  const Material m = shop.build(metal);
  ASSERT_EQ(m.bindings.size(), 1u);
  const float at = shop.row(m).v[ConductorSlots::eta];
  EXPECT_TRUE(at == 0.9f || at == 0.1f) << at;
  EXPECT_EQ(m.row.v[ConductorSlots::k], 3.0f);
}

// At a point the row is that of a constant roughness, up to the errors of the table.
TEST(BuildMaterial, coat_of_a_textured_roughness_is_known_at_the_point) {
  Workshop shop;
  using Slots = CoatedDiffuseSlots;
  shop.add_roughness("rough"), shop.add_roughness("other");
  CoatedDiffuseDesc coated;
  coated.maps_roughness = false;
  coated.facets.roughness = TextureName{"rough"};
  const Material textured = shop.build(coated);
  const BsdfRow at = shop.row(textured);
  coated.facets.roughness = at.v[Slots::alpha_x];
  const BsdfRow constant = shop.build(coated).row;
  EXPECT_EQ(textured.row.v[Slots::internal], 0);
  EXPECT_NEAR(at.v[Slots::internal], constant.v[Slots::internal], 2e-3);
  EXPECT_NE(constant.v[Slots::series], 0);
  for (int k = 0; k < coat_transmittance::terms; ++k)
    EXPECT_NEAR(at.v[Slots::series + k], constant.v[Slots::series + k], 3e-4) << k;
  coated.facets.roughness = TextureName{"rough"};
  EXPECT_EQ(shop.build(coated).coat, textured.coat) << "one table for all materials with this coat";
  coated.layer.thickness = 0.02f;
  EXPECT_NE(shop.build(coated).coat, textured.coat);
}

// Walks are sampled where roughness has a direction, where the layer varies, and where something scatters under the
// coat.
TEST(BuildMaterial, coat_of_a_textured_roughness_is_unknown_where_more_varies) {
  Workshop shop;
  using Slots = CoatedDiffuseSlots;
  shop.add_roughness("rough"), shop.add_roughness("other");
  const auto internal = [&](auto change) {
    CoatedDiffuseDesc coated;
    coated.facets.roughness = TextureName{"rough"};
    change(coated);
    return shop.row(shop.build(coated)).v[Slots::internal];
  };
  EXPECT_GT(internal([](CoatedDiffuseDesc&) {}), 0);
  EXPECT_EQ(internal([](CoatedDiffuseDesc& c) { c.facets.roughness_v = NumberInput(TextureName{"other"}); }), 0);
  EXPECT_EQ(internal([](CoatedDiffuseDesc& c) { c.facets.roughness_v = NumberInput(0.2f); }), 0);
  EXPECT_EQ(internal([](CoatedDiffuseDesc& c) { c.layer.thickness = TextureName{"other"}; }), 0);
  EXPECT_EQ(internal([](CoatedDiffuseDesc& c) { c.layer.albedo = gray_value(0.5f); }), 0);
}

TEST(BuildMaterial, normals_are_those_of_the_material_and_of_its_coat) {
  Workshop shop;
  shop.add_board();
  MaterialDesc desc;
  CoatedMetallicRoughnessDesc coated;
  coated.coat_normals = {SpectrumInput(TextureName{"board"}), {0.5f, 2}};
  desc.model = coated, desc.normals.scale = {3, -4};
  const Material m = shop.build(desc);
  EXPECT_FALSE(m.has_normal_map());
  EXPECT_EQ(m.coat_normal_texture, shop.builder.find_spectrum("board"));
  EXPECT_EQ(m.coat_normal_scale.y, 2);
  EXPECT_EQ(m.normal_scale.x, 3);
  EXPECT_EQ(m.normal_scale.y, -4);
  desc.normals.texture = SpectrumInput(TextureName{"board"});
  EXPECT_EQ(shop.build(desc).normal_texture, shop.builder.find_spectrum("board"));
}

TEST(BuildMaterial, mix_names_its_children_and_reports_unknown_ones) {
  Workshop shop;
  const Material m = shop.build(MixDesc{{"known", "unknown"}, 0.25f});
  ASSERT_TRUE(m.mixture.has_value());
  EXPECT_EQ(m.mixture->children[0], 7u);
  EXPECT_EQ(shop.textures.constant(m.mixture->amount), 0.25f);
  EXPECT_EQ(shop.diagnostics.errors(), 1);
  shop.build(MixDesc{{"known"}, 0.25f});
  EXPECT_EQ(shop.diagnostics.errors(), 2);
}

TEST(BuildMaterial, measured_owns_the_table_whose_address_is_in_its_row) {
  Workshop shop;
  const Material m = shop.build(MeasuredDesc{"table.bsdf"});
  EXPECT_EQ(m.table, shop.table);
  EXPECT_EQ(address_in<MeasuredTable>(m.row.v + MeasuredSlots::table), shop.table.get());
  EXPECT_FALSE(uses_parameters(m));
  shop.table = Workshop::table_of({-3, 0, 3});
  EXPECT_TRUE(uses_parameters(shop.build(MeasuredDesc{"table.bsdf"})));
  EXPECT_EQ(shop.build(MeasuredDesc{}).table, nullptr);
  EXPECT_EQ(shop.diagnostics.errors(), 1);
  EXPECT_EQ(shop.build(MeasuredDesc{"other.bsdf"}).table, nullptr);
  EXPECT_EQ(shop.diagnostics.errors(), 2);
}

TEST(BuildMaterial, interface_scatters_nothing) {
  Workshop shop;
  EXPECT_TRUE(shop.build(InterfaceDesc{}).is_interface);
}

}  // namespace
}  // namespace montelux
