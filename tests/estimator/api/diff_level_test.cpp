// Pictures of one expectation are not different, whatever their numbers of samples; pictures of two are.
#include <gtest/gtest.h>

#include "picture_pairs.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

const std::filesystem::path first_light =
    std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes" / "first-light" / "first-light.pbrt";

TEST(DiffLevel, unequal_samples_of_one_scene_are_not_different) {
  const PictureScene scene(first_light, 40, 30);
  std::vector<PicturePair> pairs{{{"path", "blue-noise", 16}, {"path", "blue-noise", 256}},
                                 {{"path", "blue-noise", 16}, {"path", "sobol", 256}},
                                 {{"path", "sobol", 16}, {"path", "blue-noise", 256}},
                                 {{"path", "halton", 16}, {"path", "halton", 256}},
                                 {{"path", "independent", 16}, {"path", "sobol", 256}},
                                 {{"path", "sobol", 64}, {"path", "independent", 16}},
                                 {{"path", "blue-noise", 16}, {"path", "blue-noise", 64}},
                                 {{"restir-di", "sobol", 64}, {"path", "sobol", 256}},
                                 {{"path", "sobol", 64}, {"path", "sobol", 64}},
                                 {{"naive", "sobol", 64}, {"path", "blue-noise", 64}}};
  // Where pixels share samples, a comparison is careful with blocks of pixels.
  EXPECT_LE(differing_pairs(scene, pairs, 900).differ, 1);
  for (PicturePair& pair : pairs) pair.a.shared_filters = pair.b.shared_filters = false;
  const DifferingPairs count = differing_pairs(scene, pairs, 700);
  // At level 1 %, more than one of ten comes with probability 0.4 %.
  EXPECT_LE(count.differ, 1);
  EXPECT_GE(count.differ_with_smaller_errors, 5) << "errors that are a third of the true ones pass";
}

TEST(DiffLevel, a_ball_that_is_a_tenth_brighter_and_a_lamp_that_is_a_fiftieth_brighter_are_found) {
  const TemporaryFolder folder;
  const std::string text = read_text(first_light);
  const auto picture = [&](const std::string& name, const std::string& content, std::uint32_t seed) {
    folder.write(name, content);
    return PictureScene(std::filesystem::path(folder.path()) / name, 80, 60).picture({"path", "sobol", 256}, seed);
  };
  const PictureEstimate before = picture("a.pbrt", text, 1), again = picture("b.pbrt", text, 2);
  EXPECT_FALSE(welch_of(before, again).differs);
  const WelchReport ball =
      welch_of(before, picture("ball.pbrt", replaced(text, "[ 0.10 0.17 0.55 ]", "[ 0.12 0.21 0.68 ]"), 3));
  EXPECT_TRUE(ball.blocks.differs);
  EXPECT_FALSE(ball.image.differs);
  const WelchReport lamp =
      welch_of(before, picture("lamp.pbrt", replaced(text, "[ 17 15 12 ]", "[ 17.34 15.3 12.24 ]"), 4));
  EXPECT_TRUE(lamp.image.differs);
}

}  // namespace
}  // namespace montelux::test
