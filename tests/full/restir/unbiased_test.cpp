// Reuse by reservoirs against the path tracer: image mean and blocks of 8x8 pixels, at a standard error of the image of
// 0.2 % or less, at one level for all tests of direct light, and one for all of paths. What theory says to be biased
// must fail.
#include <gtest/gtest.h>

#include "path_reuse_scenes.h"
#include "reuse_checks.h"

namespace montelux::test {
namespace {

constexpr int size = 32;
constexpr double level = 0.01, wanted_error = 0.002;
const char* const direct_ways[] = {
    "restir-di",
    "restir-di:visibility-reuse=off,candidates=8,radius=4,rounds=2,similar=off",
    "restir-di:weights=pairwise,radius=6",
    "restir-di:weights=pairwise,visibility-reuse=off,candidates=8,radius=6",
    "restir-di:weights=unbiased,visibility-reuse=off,candidates=8,radius=6,rounds=2",
    "restir-di:weights=generalised,visibility-reuse=off,candidates=8,radius=6,power-candidates=2",
    "restir-di:weights=unbiased,candidates=8,radius=6,similar=off",
    "restir-di:weights=generalised,radius=6,similar=off,candidates=2",
    "restir-di:weights=pairwise,bsdf=off,visibility-reuse=off,candidates=8,similar=off,radius=6,m-cap=5",
};
const char* const path_ways[] = {
    "restir-gi",
    "restir-pt",
    "restir-pt:weights=pairwise,radius=6",
    "restir-pt:radius=6,neighbours=2,weights=unbiased,footprint=0.02,similar=off",
    "restir-pt:radius=6,neighbours=2,weights=generalised,footprint=0.1,similar=off",
    "restir-pt:radius=3,neighbours=2,shift=replay",
    "restir-pt:temporal=on,frames=4,warm-up=2",
    "restir-gi:temporal=on,groups=off,weights=generalised,neighbours=1,radius=4,m-cap=4",
};

class Reuse : public testing::TestWithParam<ReuseScene> {};

TEST_P(Reuse, has_the_mean_of_the_path_tracer) {
  MeasuredScene(GetParam(), wanted_error)
      .expect_mean_by(direct_ways, sidak_level(level, double(reuse_scenes(size).size() * std::size(direct_ways))));
}

// Naive weights lose light where neighbours could not have made the sample. With visibility in the targets that is so
// wherever shadows end.
TEST_P(Reuse, by_naive_weights_is_biased) {
  MeasuredScene(GetParam(), wanted_error)
      .expect_too_dark_by("restir-di:weights=naive,visibility-reuse=on,radius=6",
                          level / double(reuse_scenes(size).size()));
}

class PathReuse : public testing::TestWithParam<ReuseScene> {};

TEST_P(PathReuse, has_the_mean_of_the_path_tracer) {
  MeasuredScene(GetParam(), wanted_error)
      .expect_mean_by(path_ways, sidak_level(level, double(path_reuse_scenes(size).size() * std::size(path_ways))));
}

// Neighbours that could not have made a path are counted as if they could.
TEST_P(PathReuse, by_naive_weights_is_biased) {
  MeasuredScene(GetParam(), wanted_error)
      .expect_too_dark_by("restir-pt:weights=naive,radius=6,direct=off",
                          level / double(path_reuse_scenes(size).size()));
}

std::string test_name(const testing::TestParamInfo<ReuseScene>& scene) { return test_name_of(scene.param); }

INSTANTIATE_TEST_SUITE_P(Scenes, Reuse, testing::ValuesIn(reuse_scenes(size)), test_name);
INSTANTIATE_TEST_SUITE_P(Scenes, PathReuse, testing::ValuesIn(path_reuse_scenes(size)), test_name);

}  // namespace
}  // namespace montelux::test
