// What the extensions of glTF's materials become, and which side of a surface is shown.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gltf_files.h"
#include "io/pbrt.h"
#include "io/write_pbrt.h"
#include "material/table.h"
#include "render_scenes.h"
#include "scene/prepare.h"

namespace montelux {
namespace {

using namespace test;
using test::read_text;

ReadResult with_material(const std::string& material, const std::string& node = R"("mesh": 0)",
                         const std::string& more = "") {
  return read_text(triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1, "material": 0)", node,
                                 R"(, "materials": [{)" + material + "}]" + more));
}

const MaterialDesc& material_of(const ReadResult& result) {
  EXPECT_TRUE(result.scene) << render(result.diagnostics);
  return result.scene->materials[std::size_t(result.scene->shapes.at(0).material)];
}
// Its model, which must be an M.
template <class M>
const M& model_of(const ReadResult& result) {
  const MaterialDesc& material = material_of(result);
  EXPECT_TRUE(std::holds_alternative<M>(material.model)) << name_of(material.model);
  return std::get<M>(material.model);
}

Rgb rgb_of(const SpectrumValue& value) { return std::get<RgbValue>(value).rgb; }
using Scales = std::array<float, 2>;

bool is_one_sided(const ReadResult& result) {
  EXPECT_TRUE(result.scene) << render(result.diagnostics);
  return result.scene->shapes.at(0).one_sided;
}

TEST(GltfMaterial, shows_its_back_if_it_is_double_sided_or_glass) {
  EXPECT_TRUE(is_one_sided(read_text(triangle_json())));
  EXPECT_TRUE(is_one_sided(with_material(R"("doubleSided": false)")));
  EXPECT_FALSE(is_one_sided(with_material(R"("doubleSided": true)")));
  EXPECT_FALSE(
      is_one_sided(with_material(R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}})")));
  EXPECT_TRUE(
      is_one_sided(with_material(R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 0}})")));
}

// The triangle (0, 0), (2, 0), (0, 3) of a scene, met by rays of all sorts from each side.
struct Seen {
  bool front, back;               // by the camera
  bool stops_paths, stops_light;  // from both sides
};
Seen seen(ReadResult read) {
  const TestScene scene(std::move(read));
  const Ray<float> toward{{0.5f, 0.5f, 1}, {0, 0, -1}, 100.0f, 0.0f},
      from_behind{{0.5f, 0.5f, -1}, {0, 0, 1}, 100.0f, 0.0f};
  const auto found = [&](const Ray<float>& ray, RayUse use) {
    return scene.accel().trace<float>(ray, true, use).found;
  };
  const auto stops = [&](const Ray<float>& ray) { return scene.accel().occluded<float>(ray, true); };
  return {found(toward, RayUse::camera), found(from_behind, RayUse::camera),
          found(toward, RayUse::path) && found(from_behind, RayUse::path), stops(toward) && stops(from_behind)};
}

// glTF 2.0, 3.9.6: only what faces the viewer is rendered. Light is stopped all the same, or a leaf would cast no
// shadow.
TEST(GltfFace, hides_its_back_from_the_camera_alone) {
  // Its winding is counter-clockwise as +z sees it.
  const Seen single = seen(with_material(""));
  EXPECT_TRUE(single.front && single.stops_paths && single.stops_light);
  EXPECT_FALSE(single.back);
  const Seen both = seen(with_material(R"("doubleSided": true)"));
  EXPECT_TRUE(both.front && both.back && both.stops_paths && both.stops_light);
}

TEST(GltfFace, keeps_its_front_where_its_node_mirrors) {
  // glTF 2.0, 3.7.4: a mirroring node turns the winding round, so that the front stays the front.
  const Seen mirrored = seen(with_material("", R"("mesh": 0, "scale": [1, 1, -1])"));
  EXPECT_FALSE(mirrored.front);
  EXPECT_TRUE(mirrored.back && mirrored.stops_paths && mirrored.stops_light);
  const Seen aside = seen(with_material("", R"("mesh": 0, "scale": [-1, 1, 1], "translation": [2, 0, 0])"));
  EXPECT_TRUE(aside.front && aside.stops_paths && aside.stops_light);
  EXPECT_FALSE(aside.back);
}

TEST(GltfMaterial, of_a_volume_absorbs_and_is_tinted) {
  const ReadResult result = with_material(
      R"("pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "roughnessFactor": 0.5},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.33},
         "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationColor": [0.5, 0.25, 1],
         "attenuationDistance": 2}})");
  const auto& glass = model_of<TintedDielectricDesc>(result);
  const Rgb absorption = rgb_of(glass.absorption);
  // exp(-absorption * 2) is the attenuation colour.
  EXPECT_NEAR(absorption[0], -std::log(0.5) / 2, 1e-6);
  EXPECT_NEAR(absorption[1], -std::log(0.25) / 2, 1e-6);
  EXPECT_EQ(absorption[2], 0);
  const TintedDielectricDesc expected{1.33f, RgbValue{Rgb{{1, 0.5f, 0.25f}}}, glass.absorption, {0.25f}, false};
  EXPECT_TRUE(glass == expected);
  EXPECT_TRUE(result.diagnostics.all().size() <= 2) << render(result.diagnostics);  // no light, no camera
}

TEST(GltfMaterial, of_a_pane_is_tinted) {
  const ReadResult result = with_material(
      R"("pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "roughnessFactor": 0},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}})");
  const ThinDielectricDesc expected{1.5f, RgbValue{Rgb{{1, 0.5f, 0.25f}}}, 0.0f, false};
  EXPECT_TRUE(model_of<ThinDielectricDesc>(result) == expected);
}

TEST(GltfMaterial, has_a_clear_coat_and_a_grain) {
  const ReadResult result = with_material(
      R"("pbrMetallicRoughness": {"metallicFactor": 0.25}, "extensions": {
         "KHR_materials_clearcoat": {"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.125},
         "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1.5707963267948966}})");
  const auto& material = model_of<CoatedMetallicRoughnessDesc>(result);
  const RgbValue white{gray_rgb(1.0f)};
  CoatedMetallicRoughnessDesc expected{{white, 0.25f, 1.0f, 1.0f, white, 1.5f}, 0.75f, 0.125f, {}, 0.5f, 0};
  EXPECT_NEAR(material.grain_rotation, 90, 1e-4);
  expected.grain_rotation = material.grain_rotation;
  EXPECT_TRUE(material == expected);
  model_of<MetallicRoughnessDesc>(
      with_material(R"("extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0}})"));
}

// Materials with an image.
ReadResult with_image(const std::string& material, const std::string& node = R"("mesh": 0)") {
  return with_material(material, node,
                       R"(, "images": [{"uri": "data:image/png;base64,AAAA"}], "textures": [{"source": 0}])");
}

// KHR_materials_clearcoat: without a map of its own the coat has no map, even where the base has one.
TEST(GltfMaterial, has_a_clear_coat_with_normals_of_its_own) {
  const ReadResult both = with_image(
      R"("normalTexture": {"index": 0, "scale": 0.25}, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1,
         "clearcoatNormalTexture": {"index": 0, "scale": 0.5}}})");
  const NormalMapDesc &normals = material_of(both).normals,
                      &coat_normals = model_of<CoatedMetallicRoughnessDesc>(both).coat_normals;
  EXPECT_TRUE(normals.texture && normals.texture->get<TextureName>());
  EXPECT_TRUE(coat_normals.texture && coat_normals.texture->get<TextureName>());
  EXPECT_EQ(normals.scale, (Scales{0.25f, 0.25f}));
  EXPECT_EQ(coat_normals.scale, (Scales{0.5f, 0.5f}));
  EXPECT_EQ(render(both.diagnostics).find("warning"), std::string::npos) << render(both.diagnostics);
  const ReadResult base = with_image(R"("normalTexture": {"index": 0}, "extensions": {"KHR_materials_clearcoat":
         {"clearcoatFactor": 1}})");
  EXPECT_FALSE(model_of<CoatedMetallicRoughnessDesc>(base).coat_normals.texture);
}

// Where a node mirrors, the maps' y and the grain lie the other way round, of glass, too.
TEST(GltfMaterial, turns_its_maps_round_where_its_node_mirrors) {
  const std::string mirrored = R"("mesh": 0, "scale": [-1, 1, 1])";
  const ReadResult coated = with_image(
      R"("normalTexture": {"index": 0, "scale": 0.25}, "extensions": {"KHR_materials_anisotropy":
         {"anisotropyStrength": 1}, "KHR_materials_clearcoat": {"clearcoatFactor": 1,
         "clearcoatNormalTexture": {"index": 0}}})",
      mirrored);
  const auto& material = model_of<CoatedMetallicRoughnessDesc>(coated);
  EXPECT_EQ(material_of(coated).normals.scale, (Scales{0.25f, -0.25f}));
  EXPECT_EQ(material.coat_normals.scale, (Scales{1, -1}));
  EXPECT_TRUE(material.grain_is_mirrored);
  const ReadResult glass = with_image(
      R"("normalTexture": {"index": 0, "scale": 0.25}, "extensions": {"KHR_materials_transmission":
         {"transmissionFactor": 1}})",
      mirrored);
  model_of<ThinDielectricDesc>(glass);
  EXPECT_EQ(material_of(glass).normals.scale, (Scales{0.25f, -0.25f}));
}

// KHR_materials_transmission: what goes through is as rough as what is reflected, by factor and texture.
TEST(GltfMaterial, of_glass_is_as_rough_as_stated) {
  const std::string volume = R"(, "KHR_materials_volume": {"thicknessFactor": 1})";
  for (const bool is_solid : {false, true}) {
    const std::string glass = R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1})" +
                              (is_solid ? volume : std::string()) + "}";
    const ReadResult plain = with_material(R"("pbrMetallicRoughness": {"roughnessFactor": 0.5}, )" + glass);
    // Its roughness is alpha itself.
    const auto roughness = [&](const ReadResult& result) {
      const MaterialModel& model = material_of(result).model;
      const auto* solid = std::get_if<TintedDielectricDesc>(&model);
      const auto* pane = std::get_if<ThinDielectricDesc>(&model);
      EXPECT_TRUE(is_solid ? solid && !solid->maps_roughness : pane && !pane->maps_roughness) << name_of(model);
      return solid ? solid->facets.roughness : pane ? pane->roughness : NumberInput();
    };
    EXPECT_TRUE(roughness(plain) == NumberInput(0.25f));
    EXPECT_EQ(render(plain.diagnostics).find("warning"), std::string::npos) << render(plain.diagnostics);
    const ReadResult mapped = with_image(
        R"("pbrMetallicRoughness": {"roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0}}, )" + glass);
    const NumberInput map = roughness(mapped);
    const auto* name = map.get<TextureName>();
    ASSERT_TRUE(name) << render(mapped.diagnostics);
    EXPECT_EQ(render(mapped.diagnostics).find("warning"), std::string::npos) << render(mapped.diagnostics);
    // The square of the green channel, scaled.
    const auto texture = [&](const std::string& wanted) -> const TextureModel& {
      for (const auto& t : mapped.scene->textures)
        if (t.name == wanted) return t.model;
      throw std::runtime_error("no texture " + wanted);
    };
    const auto& square = std::get<ScaleTextureDesc>(texture(name->name));
    const auto* factor = square.factor.get<TextureName>();
    ASSERT_TRUE(factor);
    EXPECT_TRUE(square.texture == ValueInput(*factor));
    const auto& channel = std::get<ImageTextureDesc>(texture(factor->name));
    EXPECT_EQ(channel.channel, ImageChannel::g);
    EXPECT_EQ(channel.scale, 0.5f);
    EXPECT_EQ(channel.encoding, ColorEncoding{});
  }
}

TEST(GltfExtension, that_is_not_read_is_warned_of) {
  const ReadResult result = with_material(R"("extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}})",
                                          R"("mesh": 0)", R"(, "extensionsUsed": ["KHR_materials_sheen"])");
  EXPECT_NE(render(result.diagnostics).find("\"KHR_materials_sheen\" is not supported: the scene is shown without it"),
            std::string::npos);
}

// What the reader of glTF fills in, a file of pbrt can state.
TEST(GltfMaterial, is_written_for_pbrt_and_read_again) {
  const std::string glass = R"("KHR_materials_transmission": {"transmissionFactor": 0.5})";
  const std::string volume =
      R"("KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.5, 0.25, 1]})";
  const std::string coat = R"("KHR_materials_clearcoat": {"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.5},
      "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1})";
  const std::string facets =
      R"("pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0.5,
      "roughnessFactor": 0.375}, "extensions": {"KHR_materials_ior": {"ior": 1.25},
      "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 2, 0.5]})";
  const std::string lambert = R"("pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
      "KHR_materials_specular": {"specularFactor": 0}})";
  const std::string mirrored = R"("mesh": 0, "scale": [-1, 1, 1])";
  std::set<std::string_view> seen;
  for (const std::string& material :
       {std::string(), facets + "}", facets + ", " + coat + "}", facets + ", " + glass + "}",
        facets + ", " + glass + ", " + volume + "}", lambert}) {
    const ReadResult first = with_material(material, mirrored);
    ASSERT_TRUE(first.scene) << render(first.diagnostics);
    const std::string text = write_pbrt(*first.scene);
    const ReadResult second = read_pbrt_text(text, ".");
    ASSERT_TRUE(second.scene) << render(second.diagnostics) << text;
    ASSERT_EQ(first.scene->materials.size(), second.scene->materials.size());
    for (std::size_t i = 0; i < first.scene->materials.size(); ++i) {
      const MaterialDesc &a = first.scene->materials[i], &b = second.scene->materials[i];
      EXPECT_TRUE(a.model == b.model && a.normals == b.normals && a.name == b.name) << text;
      seen.insert(name_of(a.model));
    }
  }
  EXPECT_EQ(seen, (std::set<std::string_view>{"coatedmetallicroughness", "diffuse", "metallicroughness", "mix",
                                              "thindielectric", "tinteddielectric"}));
}

// Nothing that the reader of glTF states is left unused.
TEST(GltfMaterial, states_what_is_used) {
  for (const char* material :
       {"", R"("doubleSided": true)", R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}})",
        R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume":
           {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0.5, 0.5, 0.5]}})",
        R"("extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}, "KHR_materials_anisotropy":
           {"anisotropyStrength": 1}})",
        R"("extensions": {"KHR_materials_unlit": {}})", R"("emissiveFactor": [1, 1, 1])"}) {
    ReadResult result = with_material(material);
    ASSERT_TRUE(result.scene) << render(result.diagnostics);
    EXPECT_TRUE(prepare(*result.scene, {}, result.diagnostics));
    EXPECT_EQ(render(result.diagnostics).find("no effect"), std::string::npos) << material << ":\n"
                                                                               << render(result.diagnostics);
  }
}

}  // namespace
}  // namespace montelux
