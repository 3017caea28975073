// Reuse by reservoirs against the path tracer on small scenes: image mean and blocks, over independent passes, at one
// level for all. tests/full/restir does the same to a standard error of 0.2 %, with more settings.
#include <gtest/gtest.h>

#include "reuse_checks.h"

namespace montelux::test {
namespace {

constexpr int size = 16, passes = 48;
constexpr double level = 0.01;
const char* const unbiased[] = {
    "restir-di:radius=4,candidates=4",
    "restir-di:weights=pairwise,radius=4,visibility-reuse=off",
    "restir-di:radius=4,candidates=4,weights=unbiased,visibility-reuse=off,rounds=2",
    "restir-di:radius=4,candidates=2,weights=generalised,visibility-reuse=on,similar=off,power-candidates=2",
    "restir-di:candidates=4,rounds=0",
};

TEST(RestirDirect, has_the_mean_of_the_path_tracer_in_every_scene) {
  const std::vector<ReuseScene> scenes = reuse_scenes(size);
  const double own = sidak_level(level, double(scenes.size() * std::size(unbiased)));
  std::uint32_t seed = 1;
  for (const ReuseScene& text : scenes) {
    const TestScene scene(text.text, textures_of_reuse_scenes());
    const PassMeans truth = measure_passes(scene, scene.integrator("path"), 64, passes, 100);
    for (const char* way : unbiased) {
      // Pass means of 1/Z weights have long tails: few passes do not show their spread.
      const int enough = std::string_view(way).find("weights=unbiased") != std::string_view::npos ? 4 * passes : passes;
      const PassMeans reuse = measure_passes(scene, scene.integrator(way), 16, enough, ++seed);
      expect_mean(text.name, way, reuse, truth, {own, 0.03});
    }
  }
}

// Behind slats some pixels see a lamp and their neighbours do not: what these could not make is lost.
TEST(RestirDirect, by_naive_weights_is_too_dark_behind_blockers) {
  const ReuseScene text = reuse_scenes(size)[1];
  ASSERT_EQ(text.name, "blockers");
  const TestScene scene(text.text, textures_of_reuse_scenes());
  const PassMeans truth = measure_passes(scene, scene.integrator("path"), 64, passes, 100);
  const ChosenIntegrator naive =
      scene.integrator("restir-di:radius=4,candidates=4,weights=naive,visibility-reuse=on,similar=off");
  expect_too_dark(text.name, measure_passes(scene, naive, 8, passes, 7), truth, level);
}

}  // namespace
}  // namespace montelux::test
