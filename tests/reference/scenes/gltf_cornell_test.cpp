// The Cornell box in glTF, its colours made grey, against another renderer's picture of the same box in its own format:
// orientation, camera, units and emission of the glTF reader have to be right for that.
#include <gtest/gtest.h>

#include <algorithm>

#include "io/gltf.h"
#include "reference_scenes.h"

namespace montelux::test {
namespace {

SpectrumValue made_gray(const SpectrumValue& value) { return gray_value(luminance(std::get<RgbValue>(value).rgb)); }

// As the grey twin has it: colours by their luminance, and emission in the same way.
SceneDesc made_gray(SceneDesc scene) {
  for (MaterialDesc& m : scene.materials)
    if (auto* diffuse = std::get_if<DiffuseDesc>(&m.model))
      diffuse->albedo = made_gray(std::get<SpectrumValue>(diffuse->albedo.value));
  for (ShapeDesc& shape : scene.shapes)
    if (shape.area_light) shape.area_light->radiance = made_gray(shape.area_light->radiance);
  scene.filter.sigma = 0.5f;
  scene.integrator.max_depth = 16;
  return scene;
}

TEST(GltfCornellBox, agrees_with_the_reference_of_its_twin) {
  for (const ReferenceScene& s : reference_scenes()) {
    if (s.name != "cornell-box-gray") continue;
    ReadResult read = read_gltf((s.scene.parent_path() / "cornell-box.gltf").string());
    ASSERT_TRUE(read.scene);
    read.scene = made_gray(*std::move(read.scene));
    const TestScene scene(std::move(read), std::pair{128, 128});
    constexpr int samples = 128;
    const PassPlan plan{samples / reference_passes, reference_passes};
    const GrayPicture ours = gray_picture(render_independent_pixels(scene, plan, 2, 0).film);
    const GrayPicture reference = read_reference(s);
    const Comparison c = compare(ours, reference);
    std::printf("%s\n%s\n", table_head, table_row("cornell-box.gltf", c, samples, reference_level).c_str());
    EXPECT_TRUE(c.agrees(reference_level));
    EXPECT_LE(c.relative_error(), 0.003);

    // Mirrored, or with its lamp 3 % too bright, it must not agree.
    GrayPicture mirrored = ours;
    for (int y = 0; y < ours.height; ++y)
      std::reverse(mirrored.mean.begin() + y * ours.width, mirrored.mean.begin() + (y + 1) * ours.width);
    EXPECT_FALSE(compare(mirrored, reference).agrees(reference_level));
    EXPECT_FALSE(compare(scaled(ours, 1.03, 0, 0, ours.width, ours.height), reference).agrees(reference_level));
    return;
  }
  ASSERT_FALSE(reference_folder());
  GTEST_SKIP() << "no folder of reference scenes: set MONTELUX_SCENES";
}

}  // namespace
}  // namespace montelux::test
