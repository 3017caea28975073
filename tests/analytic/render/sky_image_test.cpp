// A plane under an image of the sky, in closed form: next-event estimation samples the bright part of the image, and
// other techniques find the rest.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "colour_means.h"
#include "temporary_folder.h"

namespace montelux::test {

namespace {

constexpr std::array<std::array<float, 3>, 4> quadrants{
    {{0.1f, 0.2f, 0.3f}, {4, 2, 1}, {0.3f, 0.1f, 0.05f}, {0.2f, 0.3f, 0.6f}}};
constexpr std::array<double, 3> reflectance{0.5, 0.3, 0.8};

// Two by two texels: each is the sky over a quadrant of the plane, and under it.
std::string image() {
  std::string file = "PF\n2 2\n-1.0\n";
  for (const auto& texel : quadrants)
    for (const float channel : texel) {
      const auto bits = std::bit_cast<std::uint32_t>(channel);
      for (int byte = 0; byte < 4; ++byte) file += char(bits >> (8 * byte) & 0xffu);
    }
  return file;
}

constexpr const char* plane = R"(
LookAt 0 0 3  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -0.5 0.5 -0.5 0.5 ]
Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
WorldBegin
LightSource "infinite" "string filename" "sky.pfm"
Material "diffuse" "rgb reflectance" [ 0.5 0.3 0.8 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]
)";

// What a quadrant sends to the plane is a quarter of what the same radiance from everywhere would.
double truth(std::size_t c) {
  double sum = 0;
  for (const auto& texel : quadrants) sum += double(texel[c]);
  return reflectance[c] * sum / 4;
}

}  // namespace

TEST(SkyImage, lights_a_plane_as_all_of_its_quadrants_do) {
  const TemporaryFolder folder;
  folder.write("sky.pfm", image());
  const TestScene scene(plane, folder.path());
  const std::array ways{"path",
                        "path:mis=power",
                        "path:mis=balance",
                        "path:mis=off",
                        "path:nee=off",
                        "path:sky-learning=on,sky-paths=2000",
                        "path:light-selection=ris:4",
                        "naive",
                        "bdpt",
                        "bdpt:mis=balance",
                        "vcm",
                        "metropolis:strategies=bdpt",
                        "restir-di",
                        "restir-di:bsdf=off",
                        "restir-gi",
                        "restir-pt"};
  const double level = sidak_level(family_level, double(3 * ways.size()));
  for (const char* way : ways) {
    const Mean m = measure(scene, way, 32, 5);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_GT(p_value(m.mean[c], m.standard_error[c], truth(c)), level)
          << way << " " << c << ": " << m.mean[c] << " +- " << m.standard_error[c] << " for " << truth(c);
    // Planted: what next-event estimation alone would find, the brightest quadrant: half of the blue light.
    EXPECT_LT(p_value(m.mean[2], m.standard_error[2], reflectance[2] * double(quadrants[1][2]) / 4), level) << way;
  }
}

}  // namespace montelux::test
