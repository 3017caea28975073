// Reuse by reservoirs against the path tracer, over independent passes.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <span>

#include "pass_means.h"
#include "reuse_scenes.h"

namespace montelux::test {

inline std::string textures_of_reuse_scenes() { return std::string(MONTELUX_SOURCE_DIR) + "/scenes/analytic"; }

// The level of one comparison, and the standard error of the difference of image means that it must reach.
struct MeansCriterion {
  double level, largest_error;
};

// Image, blocks and colour have the mean of the truth, which would be seen, and every sample is finite.
inline void expect_mean(const std::string& scene, const char* way, const PassMeans& reuse, const PassMeans& truth,
                        const MeansCriterion& criterion) {
  const MeansVerdict v = compare_means(reuse, truth, criterion.level);
  EXPECT_FALSE(v.differ) << scene << ", " << way << ": image " << 100 * v.image_difference << " % +- "
                         << 100 * v.image_error << " %, smallest p " << v.smallest_p << " at " << v.where << " ("
                         << 100 * v.difference << " %)";
  EXPECT_LE(v.image_error, criterion.largest_error) << scene << ", " << way;
  EXPECT_TRUE(compare_means(without_colour(reuse), truth, criterion.level).differ) << scene << ", " << way;
  EXPECT_TRUE(compare_means(with_components_turned(reuse), truth, criterion.level).differ) << scene << ", " << way;
  EXPECT_EQ(reuse.non_finite, 0u) << scene << ", " << way;
}

// Light is lost, and the loss is found.
inline void expect_too_dark(const std::string& scene, const PassMeans& reuse, const PassMeans& truth, double level) {
  const MeansVerdict v = compare_means(reuse, truth, level);
  EXPECT_TRUE(v.differ) << scene;
  EXPECT_LT(v.image_difference, 0) << scene;
}

// Many ways of reuse in one scene against the path tracer, at a relative standard error of the image that is wanted.
class MeasuredScene {
 public:
  MeasuredScene(const ReuseScene& text, double wanted_error)
      : name_(text.name),
        wanted_error_(wanted_error),
        scene_(text.text, textures_of_reuse_scenes()),
        truth_(measure_to(wanted_error, scene_, scene_.integrator("path"), 64, 100)) {}

  // Each way at this level.
  void expect_mean_by(std::span<const char* const> ways, double level) const {
    std::uint32_t seed = 1;
    for (const char* way : ways) {
      const PassMeans reuse = measure(way, seed += 10, level);
      expect_mean(name_, way, reuse, truth_, {level, wanted_error_});
    }
  }
  void expect_too_dark_by(const char* way, double level) const {
    expect_too_dark(name_, measure(way, 7, level), truth_, level);
  }

 private:
  PassMeans measure(const char* way, std::uint32_t seed, double level) const {
    PassMeans reuse = measure_to(wanted_error_, scene_, scene_.integrator(way), 16, seed);
    const MeansVerdict v = compare_means(reuse, truth_, level);
    std::printf("%-18s %-80s image %+.3f %% +- %.3f %%, smallest p %.3g at %zu (%+.4f %%), %zu passes\n", name_.c_str(),
                way, 100 * v.image_difference, 100 * v.image_error, v.smallest_p, v.where, 100 * v.difference,
                reuse.values[0].size());
    return reuse;
  }

  std::string name_;
  double wanted_error_;
  TestScene scene_;
  PassMeans truth_;
};

// The name of a test that has the number of a scene.
inline std::string test_name_of(const ReuseScene& scene) {
  std::string name = scene.name;
  std::ranges::replace(name, ' ', '_');
  return name;
}

}  // namespace montelux::test
