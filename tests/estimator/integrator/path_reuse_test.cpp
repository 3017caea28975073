// Reuse of paths by reservoirs against the path tracer on small scenes of several bounces: image mean and blocks, over
// independent passes, at one level for all. tests/full/restir does the same to a standard error of 0.2 %.
#include <gtest/gtest.h>

#include <memory>

#include "pass_means.h"
#include "path_reuse_scenes.h"

namespace montelux::test {
namespace {

constexpr int size = 16, passes = 96;
constexpr double level = 0.01;
const char* const unbiased[] = {
    "restir-gi:radius=4,candidates=4,neighbours=3",
    "restir-pt:radius=4,candidates=4,neighbours=3,similar=off",
    // Half of the paths are joined, and for many it differs from pixel to pixel.
    "restir-pt:radius=6,candidates=4,neighbours=4,similar=off,footprint=0.3,temporal=off,chain=4",
    "restir-pt:radius=6,candidates=4,neighbours=4,similar=off,footprint=0.05,temporal=off,chain=4,rounds=2",
    "restir-pt:radius=4,candidates=4,neighbours=2,weights=generalised,footprint=0.05",
    "restir-pt:radius=4,candidates=4,neighbours=2,weights=unbiased,shift=replay,replayed=3,direct=off",
};
std::string folder() { return std::string(MONTELUX_SOURCE_DIR) + "/scenes/analytic"; }

// A scene, and what the path tracer says of it.
struct Measured {
  ReuseScene text;
  TestScene scene;
  PassMeans truth;
  explicit Measured(const ReuseScene& t)
      : text(t), scene(t.text, folder()), truth(measure_passes(scene, scene.integrator("path"), 256, passes, 100)) {}
};
const std::vector<std::unique_ptr<Measured>>& scenes() {
  static const auto all = [] {
    std::vector<std::unique_ptr<Measured>> made;
    for (const ReuseScene& text : path_reuse_scenes(size)) made.push_back(std::make_unique<Measured>(text));
    return made;
  }();
  return all;
}

TEST(PathReuse, has_the_mean_of_the_path_tracer_in_every_scene) {
  const double own = sidak_level(level, double(scenes().size() * std::size(unbiased)));
  std::uint32_t seed = 1;
  for (const auto& measured : scenes()) {
    const auto& [text, scene, truth] = *measured;
    for (const char* way : unbiased) {
      const PassMeans reuse = measure_passes(scene, scene.integrator(way), 16, passes, ++seed);
      const MeansVerdict v = compare_means(reuse, truth, own);
      EXPECT_FALSE(v.differ) << text.name << ", " << way << ": image " << 100 * v.image_difference << " % +- "
                             << 100 * v.image_error << " %, smallest p " << v.smallest_p << " at " << v.where;
      EXPECT_LT(v.image_error, 0.03) << text.name << ", " << way;
      EXPECT_EQ(reuse.non_finite, 0u) << text.name << ", " << way;
    }
  }
}

// Neighbours that could not have made a path are counted as if they could: light is lost.
TEST(PathReuse, by_naive_weights_is_too_dark) {
  for (const auto& measured : scenes()) {
    const auto& [text, scene, truth] = *measured;
    const ChosenIntegrator naive =
        scene.integrator("restir-pt:radius=4,candidates=4,weights=naive,similar=off,direct=off");
    const MeansVerdict v =
        compare_means(measure_passes(scene, naive, 16, passes / 4, 7), truth, level / double(scenes().size()));
    EXPECT_TRUE(v.differ) << text.name;
    EXPECT_LT(v.image_difference, 0) << text.name;
  }
}

}  // namespace
}  // namespace montelux::test
