// Reservoirs that go on over the pictures of a sequence against the path tracer of each picture: image mean and blocks,
// over independent chains, at one level for all. tests/full/restir does the same to a standard error of 0.2 %.
#include <gtest/gtest.h>

#include "integrator/restir/history.h"
#include "sequence_scenes.h"

namespace montelux::test {
namespace {

constexpr int size = 24;
constexpr double level = 0.01;

const TestScene& scene() {
  static const TestScene s{sequence_scene(size)};
  return s;
}
const std::vector<PassMeans>& truth() {
  static const std::vector<PassMeans> t = measure_sequence(scene(), scene().integrator("path"), {64, 48, 900});
  return t;
}

const char* const unbiased[] = {
    "restir-di:radius=4,candidates=4",
    "restir-di:radius=4,candidates=2,weights=unbiased,visibility-reuse=on",
    "restir-di:neighbours=0,candidates=2,weights=generalised,visibility-reuse=on",
    "restir-gi:temporal=on,neighbours=1,radius=4,candidates=2",
};

TEST(Sequence, has_the_mean_of_the_path_tracer_in_every_picture) {
  std::uint32_t seed = 1;
  for (const char* way : unbiased) {
    const SequenceVerdict v = compare_sequence(measure_sequence(scene(), scene().integrator(way), {2, 96, ++seed}),
                                               truth(), sidak_level(level, double(std::size(unbiased))));
    EXPECT_EQ(v.differ, 0) << way << ": smallest p " << v.smallest_p << ", image " << 100 * v.largest_difference
                           << " %";
    EXPECT_LT(v.largest_error, 0.03) << way;
    EXPECT_EQ(v.non_finite, 0u) << way;
  }
}

// What a history could not have made is lost: planted, and found.
TEST(Sequence, by_naive_weights_is_too_dark) {
  const ChosenIntegrator naive =
      scene().integrator("restir-di:neighbours=0,candidates=4,weights=naive,visibility-reuse=on");
  const SequenceVerdict v = compare_sequence(measure_sequence(scene(), naive, {1, 96, 7}), truth(), level);
  EXPECT_GT(v.differ, 0);
  EXPECT_LT(v.largest_difference, 0);
}

// The history's reservoirs at the vertices of the new picture instead of their own.
TEST(Sequence, with_histories_at_the_new_vertices_is_biased) {
  const ChosenIntegrator chosen = scene().integrator("restir-di:neighbours=0,candidates=2,visibility-reuse=on");
  RenderObserver silent;
  const MemoryChange at_new_vertices = [&](std::shared_ptr<const ChainMemory> memory, int picture) {
    ChainMemories now;
    RenderSettings s = scene().settings(PointSetKind::blue_noise, {1, 1}, 77, 0);
    s.shutter = sequence_shutter(picture), s.memories = &now;
    render(chosen.any(), s, silent);
    auto wrong = std::make_shared<ReuseMemory>(dynamic_cast<const ReuseMemory&>(*memory));
    wrong->vertices = dynamic_cast<const ReuseMemory&>(*now.at(0)).vertices;
    wrong->shutter = sequence_shutter(picture);
    return std::shared_ptr<const ChainMemory>(std::move(wrong));
  };
  const SequenceVerdict v =
      compare_sequence(measure_sequence(scene(), chosen, {1, 96, 8}, at_new_vertices), truth(), level);
  EXPECT_GT(v.differ, 0);
}

}  // namespace
}  // namespace montelux::test
