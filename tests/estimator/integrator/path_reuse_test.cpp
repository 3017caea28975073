// Reuse of paths by reservoirs against the path tracer on small scenes of several bounces: image mean and blocks, over
// independent passes, at one level for all. tests/full/restir does the same to a standard error of 0.2 %, with more
// settings.
#include <gtest/gtest.h>

#include <memory>

#include "path_reuse_scenes.h"
#include "reuse_checks.h"

namespace montelux::test {
namespace {

constexpr int size = 16, passes = 64;
constexpr double level = 0.01;
const char* const unbiased[] = {
    "restir-gi:radius=4,candidates=4,neighbours=3",
    "restir-pt:radius=4,candidates=4,neighbours=5,temporal=on",
    // Half of the paths are joined, and for many it differs from pixel to pixel.
    "restir-pt:weights=pairwise,radius=6,candidates=4,neighbours=4,footprint=0.3,similar=off,rounds=2",
    "restir-pt:radius=4,candidates=4,neighbours=2,weights=unbiased,shift=replay,replayed=3,direct=off",
};

// A scene, and what the path tracer says of it.
struct Measured {
  ReuseScene text;
  TestScene scene;
  PassMeans truth;
  explicit Measured(const ReuseScene& t)
      : text(t),
        scene(t.text, textures_of_reuse_scenes()),
        truth(measure_passes(scene, scene.integrator("path"), 64, passes, 100)) {}
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
      expect_mean(text.name, way, reuse, truth, {own, 0.03});
    }
  }
}

// Neighbours that could not have made a path are counted as if they could: light is lost.
TEST(PathReuse, by_naive_weights_is_too_dark) {
  for (const auto& measured : scenes()) {
    const auto& [text, scene, truth] = *measured;
    const ChosenIntegrator naive =
        scene.integrator("restir-pt:radius=4,candidates=4,weights=naive,similar=off,direct=off");
    expect_too_dark(text.name, measure_passes(scene, naive, 16, passes / 4, 7), truth, level / double(scenes().size()));
  }
}

}  // namespace
}  // namespace montelux::test
