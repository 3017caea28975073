// Reservoirs that continue over a sequence, against the path tracer of each picture: image mean and blocks,
// over independent series, at one level for all. tests/full/restir does the same to a standard error of 0.2 %.
#include <gtest/gtest.h>

#include "integrator/restir/history.h"
#include "path_reuse_scenes.h"
#include "reuse_checks.h"
#include "sequence_scenes.h"

namespace montelux::test {
namespace {

constexpr int size = 24;
constexpr double level = 0.01;

// A sequence, and what the path tracer says of it.
struct Measured {
  TestScene scene;
  std::vector<PassMeans> truth;
  explicit Measured(const std::string& text)
      : scene(text), truth(measure_sequence(scene, scene.integrator("path"), {64, 48, 900})) {}
};
const Measured& direct_light() {
  static const Measured all{sequence_scene(size)};
  return all;
}
const TestScene& scene() { return direct_light().scene; }
const std::vector<PassMeans>& truth() { return direct_light().truth; }
// Where a thing moves, paths are reused between the pixels of a frame, and no history of them is: here the camera does.
const Measured& paths_past_a_box() {
  static const Measured all{sequence_scene(size, true, 3)};
  return all;
}
const Measured& paths() {
  static const Measured all{sequence_scene(size, false, 3)};
  return all;
}

struct Way {
  const Measured& (*sequence)();
  const char* name;
};
const Way unbiased[] = {
    {direct_light, "restir-di:radius=4,candidates=4"},
    {direct_light, "restir-di:radius=4,candidates=2,weights=unbiased,visibility-reuse=on"},
    {direct_light, "restir-di:neighbours=0,candidates=2,weights=generalised,visibility-reuse=on"},
    {direct_light, "restir-gi:temporal=on,neighbours=1,radius=4,candidates=2"},
    {paths_past_a_box, "restir-pt:neighbours=3,radius=4,candidates=2"},
    {paths, "restir-gi:temporal=on,neighbours=1,radius=4,candidates=2"},
    {paths, "restir-pt:temporal=on,neighbours=3,radius=2,candidates=2"},
};

TEST(Sequence, has_the_mean_of_the_path_tracer_in_every_picture) {
  std::uint32_t seed = 1;
  for (const Way& way : unbiased) {
    const Measured& m = way.sequence();
    const SequenceVerdict v = compare_sequence(measure_sequence(m.scene, m.scene.integrator(way.name), {2, 96, ++seed}),
                                               m.truth, sidak_level(level, double(std::size(unbiased))));
    EXPECT_EQ(v.differ, 0) << way.name << ": smallest p " << v.smallest_p << ", image " << 100 * v.largest_difference
                           << " %";
    EXPECT_LT(v.largest_error, 0.03) << way.name;
    EXPECT_EQ(v.non_finite, 0u) << way.name;
  }
}

// The median over pixels of the variance of a picture of 256 samples: the edges of lamps in view, which no sharing
// changes, rule the mean.
double variance_of_pixel(const TestScene& scene, const char* way) {
  RenderObserver silent;
  const Film film =
      render(scene.integrator(way).any(), scene.settings(PointSetKind::independent, {4, 64}, 5, 0), silent).film;
  std::vector<double> all;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) all.push_back(film.pixel(x, y).variance_of_mean(0));
  std::ranges::nth_element(all, all.begin() + std::ptrdiff_t(all.size() / 2));
  return all[all.size() / 2];
}
// Light that comes over walls, past a ball that moves: were paths of other moments all that neighbours have, sharing
// would change nothing.
TEST(Sequence, shares_paths_where_things_move) {
  const ReuseScene indirect = path_reuse_scenes(size)[0];
  ASSERT_EQ(indirect.name, "indirect");
  const TestScene scene(indirect.text + R"(ActiveTransform StartTime
Translate -0.4 0.3 0
ActiveTransform EndTime
Translate 0.4 0.3 0
ActiveTransform All
Shape "sphere" "float radius" [ 0.2 ]
)",
                        textures_of_reuse_scenes());
  ASSERT_TRUE(scene.scene().geometry.moves());
  EXPECT_LT(variance_of_pixel(scene, "restir-pt:direct=off"),
            0.2 * variance_of_pixel(scene, "restir-pt:direct=off,rounds=0,neighbours=0"));
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
bool differs_at_new_vertices(const Measured& m, const char* way) {
  const ChosenIntegrator chosen = m.scene.integrator(way);
  RenderObserver silent;
  const MemoryChange at_new_vertices = [&](std::shared_ptr<const SeriesMemory> memory, int picture) {
    SeriesMemories now;
    RenderSettings s = m.scene.settings(PointSetKind::blue_noise, {1, 1}, 77, 0);
    s.image.shutter = sequence_shutter(picture), s.sequence.memories = &now;
    render(chosen.any(), s, silent);
    auto wrong = std::make_shared<ReuseMemory>(dynamic_cast<const ReuseMemory&>(*memory));
    wrong->vertices = dynamic_cast<const ReuseMemory&>(*now.at(0)).vertices;
    wrong->shutter = sequence_shutter(picture);
    return std::shared_ptr<const SeriesMemory>(std::move(wrong));
  };
  return compare_sequence(measure_sequence(m.scene, chosen, {1, 96, 8}, at_new_vertices), m.truth, level).differ > 0;
}
TEST(Sequence, with_histories_at_the_new_vertices_is_biased) {
  EXPECT_TRUE(differs_at_new_vertices(direct_light(), "restir-di:neighbours=0,candidates=2,visibility-reuse=on"));
  // Of paths alone.
  EXPECT_TRUE(differs_at_new_vertices(paths(), "restir-pt:temporal=on,neighbours=0,direct=off"));
}

}  // namespace
}  // namespace montelux::test
