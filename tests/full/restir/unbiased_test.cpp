// Reuse by reservoirs against the path tracer: image mean and blocks of 8x8 pixels, at a standard error of the image of
// 0.2 % or less, at one level for all tests together. What theory says to be biased must fail.
#include <gtest/gtest.h>

#include "pass_means.h"
#include "reuse_scenes.h"

namespace montelux::test {
namespace {

constexpr int size = 32;
constexpr double level = 0.01, wanted_error = 0.002;
const char* const unbiased[] = {
    "restir-di:radius=6",
    "restir-di:visibility-reuse=off,candidates=8,radius=6",
    "restir-di:weights=unbiased,visibility-reuse=off,candidates=8,radius=6,rounds=2",
    "restir-di:weights=generalised,visibility-reuse=off,candidates=8,radius=6,power-candidates=2",
    "restir-di:weights=unbiased,candidates=8,radius=6,similar=off",
    "restir-di:weights=generalised,radius=6,similar=off,candidates=2",
    "restir-di:bsdf=off,visibility-reuse=off,candidates=8,similar=off,radius=6,m-cap=5",
};

const std::vector<ReuseScene>& scenes() {
  static const std::vector<ReuseScene> all = reuse_scenes(size);
  return all;
}
std::string folder() { return std::string(MONTELUX_SOURCE_DIR) + "/scenes/analytic"; }

class Reuse : public testing::TestWithParam<std::size_t> {};

TEST_P(Reuse, has_the_mean_of_the_path_tracer) {
  const ReuseScene& text = scenes()[GetParam()];
  const TestScene scene(text.text, folder());
  const PassMeans truth = measure_to(wanted_error, scene, scene.integrator("path"), 64, 100);
  const double own = sidak_level(level, double(scenes().size() * std::size(unbiased)));
  std::uint32_t seed = 1;
  for (const char* way : unbiased) {
    const PassMeans reuse = measure_to(wanted_error, scene, scene.integrator(way), 16, seed += 10);
    const MeansVerdict v = compare_means(reuse, truth, own);
    printf("%-18s %-80s image %+.3f %% +- %.3f %%, smallest p %.3g at %zu (%+.4f %%), %zu passes\n", text.name.c_str(),
           way, 100 * v.image_difference, 100 * v.image_error, v.smallest_p, v.where, 100 * v.difference,
           reuse.values[0].size());
    EXPECT_FALSE(v.differ) << text.name << ", " << way << ": image " << 100 * v.image_difference << " % +- "
                           << 100 * v.image_error << " %, smallest p " << v.smallest_p << " at " << v.where;
    EXPECT_LE(v.image_error, wanted_error) << text.name << ", " << way;
    EXPECT_EQ(reuse.non_finite, 0u) << text.name << ", " << way;
  }
}

// Naive weights lose light where neighbours could not have made the sample. With visibility in the targets that is so
// wherever shadows end.
TEST_P(Reuse, by_naive_weights_is_biased) {
  const ReuseScene& text = scenes()[GetParam()];
  const TestScene scene(text.text, folder());
  const PassMeans truth = measure_to(wanted_error, scene, scene.integrator("path"), 64, 100);
  const PassMeans reuse =
      measure_to(wanted_error, scene, scene.integrator("restir-di:weights=naive,visibility-reuse=on,radius=6"), 16, 7);
  const MeansVerdict v = compare_means(reuse, truth, level / double(scenes().size()));
  printf("%-18s naive: image %+.3f %% +- %.3f %%, smallest p %.3g at %zu\n", text.name.c_str(),
         100 * v.image_difference, 100 * v.image_error, v.smallest_p, v.where);
  EXPECT_TRUE(v.differ) << text.name;
  EXPECT_LT(v.image_difference, 0) << text.name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Reuse, testing::Range(std::size_t(0), scenes().size()),
                         [](const testing::TestParamInfo<std::size_t>& scene) {
                           std::string name = scenes()[scene.param].name;
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace montelux::test
