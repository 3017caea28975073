#include <gtest/gtest.h>

#include "api/comparison.h"
#include "temporary_folder.h"

using namespace montelux;

namespace {

// A folder with a scene and a texture beside it; whether the scene is another once the texture is.
bool follows_texture(const std::string& file, const std::string& scene, const std::string& texture) {
  const test::TemporaryFolder folder;
  folder.write(texture, "old");
  const std::string path = folder.write(file, scene);
  const std::uint64_t before = scene_fingerprint(path);
  EXPECT_EQ(scene_fingerprint(path), before);
  folder.write(texture, "new");
  return scene_fingerprint(path) != before;
}

std::string gltf_with(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"images":[{"uri":")" + uri + "\"}]}";
}

std::string glb_of(std::string json) {
  const auto word = [](std::size_t n) { return std::string{char(n), char(n >> 8), char(n >> 16), char(n >> 24)}; };
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
}

}  // namespace

TEST(SceneFingerprint, follows_every_file_that_a_scene_names_however_its_name_is_written) {
  EXPECT_TRUE(
      follows_texture("a.pbrt", "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"o k.png\"", "o k.png"));
  EXPECT_TRUE(follows_texture("a.gltf", gltf_with("o k.png"), "o k.png"));
  EXPECT_TRUE(follows_texture("a.gltf", gltf_with("o%20k.png"), "o k.png"));
  EXPECT_TRUE(follows_texture("a.gltf", gltf_with(R"(o\u0020k.png)"), "o k.png"));
  EXPECT_TRUE(follows_texture("a.gltf", gltf_with(R"(\u00f8k.png)"), "\u00f8k.png"));
  EXPECT_TRUE(follows_texture("a.glb", glb_of(gltf_with(R"(o\u0020k.png)")), "o k.png"));
}

TEST(SceneFingerprint, takes_what_is_nested_however_deep) {
  const std::string deep = std::string(1000000, '[') + "\"t.png\"" + std::string(1000000, ']');
  EXPECT_TRUE(follows_texture("a.gltf", deep, "t.png"));
  EXPECT_TRUE(follows_texture("a.gltf", std::string(1000000, '[') + "t.png", "t.png"));  // no JSON at all
}

TEST(SceneFingerprint, is_of_no_file_that_the_scene_does_not_name) {
  EXPECT_FALSE(follows_texture("a.pbrt", "WorldBegin\n", "t.png"));
  EXPECT_FALSE(follows_texture("a.gltf", gltf_with("u.png"), "t.png"));
  EXPECT_FALSE(follows_texture("a.glb", glb_of(gltf_with("u.png")), "t.png"));
}
