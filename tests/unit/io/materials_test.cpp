// Every field of every material is written and read again, and what is stated about materials is checked.
#include <gtest/gtest.h>

#include <set>

#include "io/pbrt.h"
#include "io/report.h"
#include "io/write_pbrt.h"
#include "material/table.h"
#include "temporary_folder.h"

namespace montelux::test {
namespace {

// The changes of a field, one of each type that it may have, away from the values that hold where nothing is stated.
template <class T>
using Changes = std::vector<T>;

const RgbValue other_color{Rgb{{0.125f, 0.375f, 0.75f}}, "srgb"}, other_space{Rgb{{0.125f, 0.375f, 0.75f}}, "rec2020"};

Changes<SpectrumValue> changes_of(const SpectrumValue&) {
  return {other_color, other_space, NamedSpectrum{"metal-Al-k"}, SampledValue{{400, 700}, {0.25f, 0.75f}},
          Blackbody{3000}};
}
Changes<NumberInput> changes_of(const NumberInput&) { return {0.375f, TextureName{"numbers"}}; }
Changes<SpectrumInput> changes_of(const SpectrumInput&) {
  Changes<SpectrumInput> all{TextureName{"colours"}};
  for (const SpectrumValue& value : changes_of(SpectrumValue())) all.emplace_back(value);
  return all;
}
Changes<IndexInput> changes_of(const IndexInput&) { return {1.75f, SpectrumValue(NamedSpectrum{"glass-SF11"})}; }
Changes<float> changes_of(float) { return {0.375f}; }
Changes<int> changes_of(int) { return {7}; }
Changes<bool> changes_of(bool x) { return {!x}; }
Changes<std::string> changes_of(const std::string&) { return {"normals.pfm"}; }
Changes<std::array<float, 2>> changes_of(const std::array<float, 2>&) { return {{0.5f, 1}, {1, -2}}; }
Changes<std::vector<std::string>> changes_of(const std::vector<std::string>&) { return {{"b", "a"}}; }
template <class T>
Changes<std::optional<T>> changes_of(const std::optional<T>&) {
  Changes<std::optional<T>> all;
  for (const T& value : changes_of(T())) all.push_back(value);
  return all;
}

// Calls `visit` with every field; a struct with another number of members does not compile.
template <class T, class Visit>
void each_field(T& field, const Visit& visit) {
  visit(field);
}
template <class Visit, class... T>
void each_of(const Visit& visit, T&... fields) {
  (each_field(fields, visit), ...);
}
template <class Visit>
void each_field(FacetsDesc& x, const Visit& visit) {
  auto& [both, u, v] = x;
  each_of(visit, both, u, v);
}
template <class Visit>
void each_field(MetalDesc& x, const Visit& visit) {
  auto& [eta, k, reflectance] = x;
  each_of(visit, eta, k, reflectance);
}
template <class Visit>
void each_field(LayerDesc& x, const Visit& visit) {
  auto& [thickness, g, albedo, depth, samples] = x;
  each_of(visit, thickness, g, albedo, depth, samples);
}
template <class Visit>
void each_field(NormalMapDesc& x, const Visit& visit) {
  auto& [texture, scale] = x;
  each_of(visit, texture, scale);
}
template <class Visit>
void each_field(DiffuseDesc& x, const Visit& visit) {
  auto& [albedo] = x;
  each_of(visit, albedo);
}
template <class Visit>
void each_field(CoatedDiffuseDesc& x, const Visit& visit) {
  auto& [albedo, eta, facets, maps, layer] = x;
  each_of(visit, albedo, eta, facets, maps, layer);
}
template <class Visit>
void each_field(CoatedConductorDesc& x, const Visit& visit) {
  auto& [metal, metal_facets, eta, facets, maps, layer] = x;
  each_of(visit, metal, metal_facets, eta, facets, maps, layer);
}
template <class Visit>
void each_field(ConductorDesc& x, const Visit& visit) {
  auto& [metal, facets, maps] = x;
  each_of(visit, metal, facets, maps);
}
template <class Visit>
void each_field(PhongDesc& x, const Visit& visit) {
  auto& [diffuse, glossy, exponent] = x;
  each_of(visit, diffuse, glossy, exponent);
}
template <class Visit>
void each_field(MetallicRoughnessDesc& x, const Visit& visit) {
  auto& [base, metallic, roughness, specular, color, eta] = x;
  each_of(visit, base, metallic, roughness, specular, color, eta);
}
template <class Visit>
void each_field(CoatedMetallicRoughnessDesc& x, const Visit& visit) {
  auto& [base, coat, roughness, normals, strength, rotation, grain_x, grain_y, mirrored] = x;
  each_of(visit, base, coat, roughness, normals, strength, rotation, grain_x, grain_y, mirrored);
}
template <class Visit>
void each_field(MixDesc& x, const Visit& visit) {
  auto& [materials, amount] = x;
  each_of(visit, materials, amount);
}
template <class Visit>
void each_field(InterfaceDesc&, const Visit&) {
  static_assert(std::is_empty_v<InterfaceDesc>);
}
template <class Visit>
void each_field(DielectricDesc& x, const Visit& visit) {
  auto& [eta, facets, maps] = x;
  each_of(visit, eta, facets, maps);
}
template <class Visit>
void each_field(TintedDielectricDesc& x, const Visit& visit) {
  auto& [eta, tint, absorption, facets, maps] = x;
  each_of(visit, eta, tint, absorption, facets, maps);
}
template <class Visit>
void each_field(ThinDielectricDesc& x, const Visit& visit) {
  auto& [eta, tint, roughness, maps] = x;
  each_of(visit, eta, tint, roughness, maps);
}
template <class Visit>
void each_field(DiffuseTransmissionDesc& x, const Visit& visit) {
  auto& [reflected, transmitted, scale] = x;
  each_of(visit, reflected, transmitted, scale);
}
template <class Visit>
void each_field(MeasuredDesc& x, const Visit& visit) {
  auto& [file] = x;
  each_of(visit, file);
}
template <class Visit>
void each_field(MaterialDesc& x, const Visit& visit) {
  auto& [name, model, normal_file, normals, displacement, where] = x;
  std::visit([&](auto& m) { each_field(m, visit); }, model);
  const bool is_surface = !std::holds_alternative<MixDesc>(model) && !std::holds_alternative<InterfaceDesc>(model);
  if (is_surface) each_of(visit, normal_file, normals, displacement);
}

bool same(const MaterialDesc& a, const MaterialDesc& b) {
  return a.model == b.model && a.normal_file == b.normal_file && a.normals == b.normals &&
         a.displacement == b.displacement;
}

// A scene with textures and two materials that a third may name.
SceneDesc scene_with(const MaterialDesc& material, const std::string& folder) {
  ReadResult read = read_pbrt_text(
      R"(WorldBegin Texture "numbers" "float" "constant" Texture "colours" "spectrum" "constant"
MakeNamedMaterial "a" "string type" "diffuse" MakeNamedMaterial "b" "string type" "conductor")",
      folder);
  EXPECT_TRUE(read.scene) << render(read.diagnostics);
  SceneDesc scene = std::move(read.scene).value_or(SceneDesc{});
  scene.materials.push_back(material);
  scene.materials.back().name = "changed";
  return scene;
}

// What every model begins with; a mixture needs its materials, a measured one its table.
MaterialDesc beginning(std::string_view name) {
  MaterialDesc material = material_models().initial(name);
  if (auto* mix = std::get_if<MixDesc>(&material.model)) mix->materials = {"a", "b"};
  if (auto* measured = std::get_if<MeasuredDesc>(&material.model)) measured->file = "table.bsdf";
  return material;
}

class Materials : public testing::TestWithParam<std::string_view> {};

TEST_P(Materials, are_read_again_as_they_were_written) {
  TemporaryFolder folder;
  folder.write("normals.pfm", "PF\n2 2\n-1.0\n" + std::string(2 * 2 * 3 * 4, '\0'));
  folder.write("table.bsdf", "tensor_file");
  const MaterialDesc initial = beginning(GetParam());
  std::set<std::string> written{write_pbrt(scene_with(initial, folder.path()))};
  int fields = 0, changes = 0;
  const auto check = [&](const MaterialDesc& changed) {
    SCOPED_TRACE("field " + std::to_string(fields));
    ++changes;
    EXPECT_FALSE(same(changed, initial));
    const std::string text = write_pbrt(scene_with(changed, folder.path()));
    EXPECT_TRUE(written.insert(text).second) << "the same as without the change, or as by another one:\n" << text;
    const ReadResult again = read_pbrt_text(text, folder.path());
    ASSERT_TRUE(again.scene) << render(again.diagnostics) << text;
    EXPECT_TRUE(same(again.scene->materials.back(), changed)) << text;
    EXPECT_EQ(name_of(again.scene->materials.back().model), GetParam());
    // Displacement is known and has no effect yet.
    for (const Diagnostic& d : again.diagnostics.all())
      EXPECT_TRUE(d.severity != Severity::warning || d.message.find("'displacement'") != std::string::npos)
          << d.message << text;
  };
  MaterialDesc changed = initial;
  each_field(changed, [&]<class T>(T& field) {
    const T before = field;
    for (const T& value : changes_of(before)) {
      field = value;
      check(changed);
    }
    field = before;
    ++fields;
  });
  // A row for each field, and no other.
  EXPECT_EQ(std::size_t(fields), find_entity(material_models().specs(), GetParam())->parameters.size());
  EXPECT_GE(changes, fields);
}

std::vector<std::string_view> material_names() {
  std::vector<std::string_view> names;
  for (const EntitySpec& spec : material_models().specs())
    if (!spec.later) names.push_back(spec.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(OfTheTable, Materials, testing::ValuesIn(material_names()),
                         [](const auto& name) { return std::string(name.param); });

TEST(MaterialNames, are_one_for_each_model) {
  EXPECT_EQ(material_names().size(), std::variant_size_v<MaterialModel>);
  for (const std::string_view name : material_names()) EXPECT_EQ(name_of(material_models().initial(name).model), name);
}

// The warnings of parameters without effect: "line:column name".
std::vector<std::string> without_effect(const std::string& text) {
  const ReadResult read = read_pbrt_text("WorldBegin\n" + text, ".");
  EXPECT_TRUE(read.scene) << render(read.diagnostics);
  std::vector<std::string> all;
  for (const Diagnostic& d : read.diagnostics.all())
    if (d.message.find("has no effect here") != std::string::npos)
      all.push_back(std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + " " +
                    d.message.substr(0, d.message.find(" of ")));
  return all;
}

TEST(Roughness, of_both_directions_has_no_effect_where_each_has_its_own) {
  const std::string own = " \"float uroughness\" 0.1 \"float vroughness\" 0.2";
  for (const char* name : {"conductor", "dielectric", "coateddiffuse", "tinteddielectric"}) {
    const std::string type = "Material \"" + std::string(name) + "\"\n";
    EXPECT_EQ(without_effect(type + "\"float roughness\" 0.3" + own), std::vector<std::string>{"3:1 'roughness'"});
    EXPECT_TRUE(without_effect(type + "\"float roughness\" 0.3 \"float uroughness\" 0.1").empty());
    EXPECT_TRUE(without_effect(type + own).empty());
  }
  EXPECT_EQ(without_effect("Material \"coatedconductor\"\n\"float interface.roughness\" 0.3 \"float "
                           "interface.uroughness\" 0.1 \"float interface.vroughness\" 0.2 \"float "
                           "conductor.roughness\" 0.1 \"float conductor.uroughness\" 0.1"),
            std::vector<std::string>{"3:1 'interface.roughness'"});
}

// Defaults of attributes are copied to many materials.
TEST(Roughness, without_effect_is_warned_of_once_for_each_place) {
  EXPECT_EQ(without_effect("Attribute \"material\"\n\"float roughness\" 0.3\n"
                           "Material \"conductor\" \"float uroughness\" 0.1 \"float vroughness\" 0.2\n"
                           "Material \"dielectric\" \"float uroughness\" 0.1 \"float vroughness\" 0.2\n"
                           "Material \"dielectric\" \"float uroughness\" 0.1 \"float vroughness\" 0.2\n"
                           "\"float roughness\" 0.4"),
            (std::vector<std::string>{"3:1 'roughness'", "7:1 'roughness'"}));
}

TEST(NormalScale, has_two_values) {
  for (const char* name : {"normalscale", "coatnormalscale"})
    for (const char* values : {"2", "[ 1 2 3 ]"}) {
      const std::string row = "\"float " + std::string(name) + "\" " + values;
      const ReadResult read = read_pbrt_text("WorldBegin\nMaterial \"coatedmetallicroughness\"\n" + row, ".");
      EXPECT_FALSE(read.scene) << row;
      ASSERT_FALSE(read.diagnostics.all().empty());
      const Diagnostic& d = read.diagnostics.all().front();
      EXPECT_EQ(d.where.line, 3);
      EXPECT_NE(d.message.find(std::string(name) + "' takes 2 values; there are"), std::string::npos) << d.message;
    }
}

// Defaults of attributes may be in another colour space than what states the material itself.
TEST(Writing, keeps_each_colour_in_its_own_space) {
  const ReadResult first = read_pbrt_text(
      "WorldBegin ColorSpace \"rec2020\" Attribute \"material\" \"rgb ks\" [ 0.1 0.2 0.3 ]\n"
      "Attribute \"texture\" \"rgb tex2\" [ 0.3 0.2 0.1 ] ColorSpace \"dci-p3\"\n"
      "Texture \"board\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 0.4 0.5 0.6 ]\n"
      "Material \"phong\" \"rgb kd\" [ 0.4 0.5 0.6 ] Shape \"sphere\" ColorSpace \"srgb\"\n"
      "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.8 0.9 ] Shape \"disk\" LightSource \"point\" \"rgb I\" [ 1 2 3 "
      "]",
      ".");
  ASSERT_TRUE(first.scene);
  const ReadResult again = read_pbrt_text(write_pbrt(*first.scene), ".");
  ASSERT_TRUE(again.scene) << write_pbrt(*first.scene);
  for (const SceneDesc* scene : {&*first.scene, &*again.scene}) {
    const auto space = [](const auto& stated) {
      const SpectrumValue* value = stated.template get<SpectrumValue>();
      return value ? std::get<RgbValue>(*value).color_space : "none";
    };
    const auto& phong = std::get<PhongDesc>(scene->materials.at(1).model);
    EXPECT_EQ(space(phong.diffuse_albedo), "dci-p3");
    EXPECT_EQ(space(phong.glossy_albedo), "rec2020");
    const auto& board = std::get<CheckerboardTextureDesc>(scene->textures.at(0).model);
    EXPECT_EQ(space(board.even), "dci-p3");
    EXPECT_EQ(space(board.odd), "rec2020");
    EXPECT_EQ(space(std::get<DiffuseDesc>(scene->materials.at(2).model).albedo), "srgb");
    EXPECT_EQ(std::get<RgbValue>(std::get<PointLightDesc>(scene->lights.at(0).model).intensity).color_space, "srgb");
  }
}

}  // namespace
}  // namespace montelux::test
