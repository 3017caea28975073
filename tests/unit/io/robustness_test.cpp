// Thousands of damaged inputs, the same in every run: reading them must end, and without a crash.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "damage.h"
#include "io/pbrt.h"
#include "io/ply.h"
#include "io/report.h"

namespace montelux {
namespace {

using Random = test::DamageRandom;
using test::below;
using test::damage;

constexpr std::string_view seed_scene = R"(# a scene with a bit of everything
Option "integer seed" 3
Integrator "path" "integer maxdepth" [ 6 ] "string lightsampler" "power"
Sampler "halton" "integer pixelsamples" 16
PixelFilter "gaussian" "float xradius" 2
Film "rgb" "integer xresolution" [ 64 ] "integer yresolution" [ 48 ] "float cropwindow" [ 0 1 0 0.5 ]
ColorSpace "srgb"
Scale -1 1 1
LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" [ 40 ]
WorldBegin
Attribute "shape" "float radius" 0.5
Texture "t" "spectrum" "checkerboard" "rgb tex1" [ .1 .2 .3 ] "float uscale" 8
Texture "u" "spectrum" "scale" "texture tex" "t" "float scale" 0.5
MakeNamedMaterial "glass" "string type" "dielectric" "spectrum eta" "glass-BK7" "float roughness" 0.1
MakeNamedMaterial "both" "string type" "mix" "string materials" [ "glass" "glass" ] "float amount" 0.25
MediumInterface "" ""
LightSource "infinite" "spectrum L" [ 400 1 500 2 600 3 ] "float illuminance" 3
AttributeBegin
  ReverseOrientation
  ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
  AreaLightSource "diffuse" "blackbody L" 6500 "bool twosided" true
  Shape "sphere" "float radius" 1.5 "float zmin" -1
AttributeEnd
ObjectBegin "thing"
  Material "diffuse" "texture reflectance" "u"
  Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] "integer indices" [ 0 1 2 1 3 2 ] "point2 uv" [ 0 0 1 0 0 1 1 1 ]
  Shape "loopsubdiv" "integer levels" 2 "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] "integer indices" [ 0 1 2 0 2 3 0 3 1 1 3 2 ]
ObjectEnd
TransformBegin
  Rotate 30 0 1 0 ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1 ]
  CoordinateSystem "c" ObjectInstance "thing" CoordSysTransform "c"
TransformEnd
NamedMaterial "both"
Shape "curve" "point3 P" [ 0 0 0 1 0 0 2 0 0 3 0 0 ] "string type" "ribbon" "normal N" [ 0 1 0 0 1 0 ]
Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] "texture alpha" "f"
Include "missing.pbrt"
)";

TEST(DamagedScenes, end_in_a_scene_or_in_errors) {
  Random random(20240131);
  int whole = 0;
  for (int i = 0; i < 6000; ++i) {
    std::string text(seed_scene);
    for (std::size_t n = 1 + below(random, 6); n > 0; --n) damage(text, random);
    for (bool lenient : {false, true}) {
      ReadResult result = read_pbrt_text(text, "/nonexistent", {lenient});
      ASSERT_EQ(result.scene.has_value(), !result.diagnostics.has_errors());
      whole += result.scene.has_value();
      for (const Diagnostic& d : result.diagnostics.all()) ASSERT_FALSE(d.message.empty());
      if (i % 50 == 0) {
        ASSERT_FALSE(render(result.diagnostics).empty() && !result.scene);
      }
    }
  }
  SUCCEED() << whole << " were still scenes";
}

TEST(DamagedScenes, of_random_tokens_end_too) {
  static constexpr std::array<std::string_view, 26> tokens{"Shape",
                                                           "\"sphere\"",
                                                           "\"float radius\"",
                                                           "[",
                                                           "]",
                                                           "1",
                                                           "-2.5",
                                                           "WorldBegin",
                                                           "AttributeBegin",
                                                           "AttributeEnd",
                                                           "Material",
                                                           "\"mix\"",
                                                           "ObjectBegin",
                                                           "\"a\"",
                                                           "ObjectEnd",
                                                           "ObjectInstance",
                                                           "Transform",
                                                           "Translate",
                                                           "LookAt",
                                                           "Texture",
                                                           "\"float\"",
                                                           "NamedMaterial",
                                                           "MakeNamedMaterial",
                                                           "\"string type\"",
                                                           "TransformBegin",
                                                           "TransformEnd"};
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    std::string text = "WorldBegin ";
    for (std::size_t n = below(random, 120); n > 0; --n)
      text += std::string(tokens[below(random, tokens.size())]) + " ";
    ReadResult result = read_pbrt_text(text, "/nonexistent");
    ASSERT_EQ(result.scene.has_value(), !result.diagnostics.has_errors());
  }
}

TEST(DamagedScenes, may_nest_deeply) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 200000; ++i) text += "AttributeBegin ";
  EXPECT_FALSE(read_pbrt_text(text, ".").scene);
  EXPECT_FALSE(read_pbrt_text("WorldBegin " + std::string(1000000, '['), ".").scene);
}

TEST(DamagedMeshes, end_in_a_mesh_or_in_an_error) {
  std::string seed =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\n"
      "property float ny\nproperty float nz\nelement extra 1\nproperty list uchar float stuff\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n2 5 6\n"
      "3 0 1 2\n4 0 1 2 3\n";
  Random random(99);
  for (std::string_view format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (int i = 0; i < 1500; ++i) {
      std::string text = seed;
      text.replace(text.find("ascii"), 5, format);
      for (std::size_t n = 1 + below(random, 5); n > 0; --n) damage(text, random);
      Diagnostics diagnostics;
      auto mesh = read_ply_bytes(text, "mesh", {}, diagnostics);
      ASSERT_EQ(mesh.has_value(), !diagnostics.has_errors());
      if (!mesh) continue;
      for (std::uint32_t index : mesh->triangles) ASSERT_LT(index, mesh->positions.size());
      for (std::uint32_t index : mesh->quads) ASSERT_LT(index, mesh->positions.size());
    }
}

}  // namespace
}  // namespace montelux
