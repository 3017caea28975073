// A tabulated material lights a scene as the closed form does from which it was tabulated.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "measured_files.h"
#include "pass_means.h"
#include "temporary_folder.h"

namespace montelux {
namespace {

using namespace test;

constexpr double level = 1e-3;

// A ball on a floor, under a ceiling of light in a dim sky.
std::string scene_of(const std::string& material) {
  return fmt::format(R"(Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
Integrator "path" "integer maxdepth" [ 4 ]
LookAt 0 1.5 -4   0 0 0   0 1 0
Camera "perspective" "float fov" [ 40 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.3 0.4 0.6 ]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 4 3 2 ]
Shape "bilinearmesh" "point3 P" [ -2 3 -2  2 3 -2  -2 3 1  2 3 1 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ]
Material {}
Shape "sphere"
)",
                     material);
}
const std::string measured = "\"measured\" \"string filename\" \"table.bsdf\"";

PassMeans means_of(const TestScene& scene, const std::string& integrator, std::uint32_t seed, int passes = 64) {
  return measure_passes(scene, scene.integrator(integrator), 16, passes, seed);
}

struct Pair {
  ClosedLobe lobe;
  std::string material, fault;
};
const Pair pairs[] = {
    {{0.7, 0.7, {0.8, 0.5, 0.2}, {}},
     "\"diffuse\" \"rgb reflectance\" [ 0.8 0.5 0.2 ]",
     "\"diffuse\" \"rgb reflectance\" [ 0.82 0.5 0.2 ]"},
    {{0.4, 0.4, {}, {1, 1, 1}, {{{0.2, 3.9}, {0.92, 2.45}, {1.1, 2.14}}}},
     "\"conductor\" \"rgb eta\" [ 0.2 0.92 1.1 ] \"rgb k\" [ 3.9 2.45 2.14 ] \"float roughness\" 0.4 \"bool "
     "remaproughness\" false",
     "\"conductor\" \"rgb eta\" [ 0.2 0.92 1.1 ] \"rgb k\" [ 3.9 2.45 2.14 ] \"float roughness\" 0.45 \"bool "
     "remaproughness\" false"}};

TEST(MeasuredMaterial, lights_a_scene_as_its_closed_form_does) {
  for (const Pair& pair : pairs) {
    const TemporaryFolder folder;
    folder.write("table.bsdf", measured_file(pair.lobe, {.elevations = 33, .facets = 97, .values = 65}));
    const TestScene table(scene_of(measured), folder.path()), closed(scene_of(pair.material)),
        fault(scene_of(pair.fault));
    const PassMeans a = means_of(table, "path", 1);
    EXPECT_EQ(a.non_finite, 0u);
    const MeansVerdict same = compare_means(a, means_of(closed, "path", 2), level),
                       other = compare_means(a, means_of(fault, "path", 3), level);
    EXPECT_FALSE(same.differ) << pair.material << " p " << same.smallest_p << ", " << same.difference << " at "
                              << same.where << ", image " << same.image_difference << " +- " << same.image_error;
    EXPECT_TRUE(other.differ) << pair.fault << " " << other.smallest_p;
  }
}

// A coarse table is not reciprocal, so that paths from the lights agree only if they scatter importance the other way.
TEST(MeasuredMaterial, is_the_same_for_paths_from_the_lights) {
  ClosedLobe lobe{0.4, 0.4, {0.2, 0.2, 0.2}, {0.6, 0.5, 0.3}};
  const auto table = [&] { return measured_file(lobe, {.elevations = 4, .facets = 17, .values = 5}); };
  const TemporaryFolder folder;
  folder.write("table.bsdf", table());
  const TestScene scene(scene_of(measured), folder.path());
  const PassMeans path = means_of(scene, "path", 4, 96);
  lobe.glossy[0] *= 1.03;
  folder.write("table.bsdf", table());
  const TestScene fault(scene_of(measured), folder.path());
  for (const char* integrator : {"bdpt", "light"}) {
    const PassMeans other = means_of(scene, integrator, 5, 96);
    EXPECT_EQ(other.non_finite, 0u);
    const MeansVerdict verdict = compare_means(other, path, level);
    EXPECT_FALSE(verdict.differ) << integrator << " p " << verdict.smallest_p << ", " << verdict.difference << " at "
                                 << verdict.where << ", image " << verdict.image_difference << " +- "
                                 << verdict.image_error;
    EXPECT_TRUE(compare_means(means_of(fault, integrator, 6, 96), path, level).differ) << integrator;
  }
}

// Materials that name a file twice, in different words, share its table.
TEST(MeasuredMaterial, shares_the_table_of_a_file) {
  const TemporaryFolder folder;
  for (const char* file : {"a.bsdf", "b.bsdf"})
    folder.write(file, measured_file({}, {.elevations = 2, .facets = 3, .values = 2}));
  std::string text = "WorldBegin\n";
  for (const char* file : {"a.bsdf", "./a.bsdf", "b.bsdf"})
    text += fmt::format("Material \"measured\" \"string filename\" \"{}\"\nShape \"sphere\"\n", file);
  const TestScene scene(text, folder.path());
  const MaterialSet& materials = scene.scene().materials;
  ASSERT_EQ(materials.size(), 4u);
  EXPECT_EQ(materials[1].table, materials[2].table);
  EXPECT_NE(materials[1].table, materials[3].table);
}

}  // namespace
}  // namespace montelux
