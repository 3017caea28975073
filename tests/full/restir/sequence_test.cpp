// Reservoirs that continue over a sequence, against the path tracer of each picture, at a standard error of
// the image of 0.2 % or less, at one level for all tests together. Planted faults must be found.
#include <gtest/gtest.h>

#include "sequence_scenes.h"

namespace montelux::test {
namespace {

constexpr int size = 32;
constexpr double level = 0.01, wanted_error = 0.002;

// With enough passes for the wanted error in each picture.
std::vector<PassMeans> measured_well(const TestScene& scene, const ChosenIntegrator& chosen, SequencePlan plan) {
  const auto largest_spread = [&](int passes) {
    plan.passes = passes;
    double largest = 0;
    for (const PassMeans& picture : measure_sequence(scene, chosen, plan))
      largest = std::max(largest, relative_spread(picture));
    ++plan.seed;
    return largest;
  };
  plan.passes = enough_passes(wanted_error, plan.passes, largest_spread);
  return measure_sequence(scene, chosen, plan);
}

struct SequenceCase {
  const char* name;
  bool box_moves;
  int max_depth;
  std::vector<const char*> ways;
};
const std::vector<SequenceCase>& cases() {
  static const std::vector<SequenceCase> all{
      {"direct_light_with_a_box_that_moves",
       true,
       2,
       {"restir-di", "restir-di:weights=generalised,neighbours=0,candidates=2,visibility-reuse=on",
        "restir-di:weights=unbiased,radius=6"}},
      {"paths_with_a_camera_that_moves",
       false,
       3,
       {"restir-gi:temporal=on,neighbours=2,radius=6", "restir-pt:temporal=on,neighbours=2,radius=6",
        "restir-pt:temporal=on,neighbours=0,shift=replay,visibility-reuse=on"}},
      {"paths_with_a_box_that_moves", true, 3, {"restir-pt:temporal=on,neighbours=3,radius=6"}},
  };
  return all;
}

class SequenceWithHistory : public testing::TestWithParam<std::size_t> {};

TEST_P(SequenceWithHistory, has_the_mean_of_the_path_tracer) {
  const SequenceCase& c = cases()[GetParam()];
  std::size_t ways = 0;
  for (const SequenceCase& each : cases()) ways += each.ways.size();
  const TestScene scene(sequence_scene(size, c.box_moves, c.max_depth));
  const std::vector<PassMeans> truth = measured_well(scene, scene.integrator("path"), {64, 48, 500});
  std::uint32_t seed = 100;
  for (const char* way : c.ways) {
    const std::vector<PassMeans> reuse = measured_well(scene, scene.integrator(way), {4, 96, seed += 10});
    const SequenceVerdict v = compare_sequence(reuse, truth, sidak_level(level, double(ways)));
    printf("%-40s %-80s image %+.3f %% at most, +- %.3f %%, smallest p %.3g, %zu passes\n", c.name, way,
           100 * v.largest_difference, 100 * v.largest_error, v.smallest_p, reuse[0].values[0].size());
    EXPECT_EQ(v.differ, 0) << way;
    EXPECT_LE(v.largest_error, wanted_error) << way;
    EXPECT_EQ(v.non_finite, 0u) << way;
  }
}

TEST(SequenceHistory, by_naive_weights_is_biased) {
  const TestScene scene(sequence_scene(size));
  const std::vector<PassMeans> truth = measured_well(scene, scene.integrator("path"), {64, 48, 500});
  const SequenceVerdict v = compare_sequence(
      measured_well(scene, scene.integrator("restir-di:neighbours=0,weights=naive,visibility-reuse=on"), {4, 48, 7}),
      truth, level);
  printf("naive: image %+.3f %% +- %.3f %%, smallest p %.3g\n", 100 * v.largest_difference, 100 * v.largest_error,
         v.smallest_p);
  EXPECT_EQ(v.differ, sequence_pictures - 1);
  EXPECT_LT(v.largest_difference, 0);
}

INSTANTIATE_TEST_SUITE_P(Cases, SequenceWithHistory, testing::Range(std::size_t(0), cases().size()),
                         [](const testing::TestParamInfo<std::size_t>& c) {
                           return std::string(cases()[c.param].name);
                         });

}  // namespace
}  // namespace montelux::test
