// Roulette for efficiency: the factors make variance times cost least, and are the same in every run.
#include "integrator/path/survival.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mc/random.h"
#include "mc/roulette.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// Paths of one pixel block with two decisions each: throughputs fall, what is gathered after them varies. `light` says
// how much lies behind the second decision.
std::vector<PilotPath> paths_of(float behind) {
  std::vector<PilotPath> paths;
  const RandomStream<float> random(3, 4);
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const auto u = [&](std::uint32_t k) { return random.at(8 * i + k); };
    PilotPath p;
    const float t1 = 0.2f + 0.6f * u(0), t2 = t1 * (0.1f + 0.8f * u(1));
    const float first = 0.3f * u(2), second = first + 0.4f * t1 * u(3);
    p.decisions = {{t1, first}, {t2, second}};
    p.light = second + behind * t2 * (u(4) < 0.3f ? 1.0f : 0.0f);
    p.pixel = int(i) / 8;
    paths.push_back(p);
  }
  return paths;
}

// Variance (relative to the block's mean) times cost of the paths, straight from the definition of roulette.
double variance_times_cost(const std::vector<PilotPath>& paths, const SurvivalMap& map, double scale1, double scale2) {
  double square = 0, cost = 0, sum = 0;
  for (const PilotPath& p : paths) {
    const double t1 = double(p.decisions[0].throughput), t2 = double(p.decisions[1].throughput);
    const auto probability = [&](double t, double scale, std::uint32_t depth) {
      return std::clamp(t * scale * double(map.factor<float>(0u, 0u, depth)), double(min_survival),
                        double(max_survival));
    };
    const double q1 = probability(t1, scale1, 1), q2 = probability(t2 / q1, scale2, 2);
    const double a = double(p.decisions[0].gathered), b = double(p.decisions[1].gathered) - a,
                 c = double(p.light) - a - b;
    // Three outcomes: ended at once, after one more event, or not.
    square +=
        (1 - q1) * a * a + q1 * (1 - q2) * std::pow(a + b / q1, 2) + q1 * q2 * std::pow(a + b / q1 + c / (q1 * q2), 2);
    cost += 1 + q1 + q1 * q2;
    sum += double(p.light);
  }
  const double n = double(paths.size());
  return (square / n - sum * sum / (n * n)) * cost / n;
}

TEST(SurvivalMap, makes_variance_times_cost_least) {
  for (float behind : {0.2f, 1.0f, 3.0f}) {
    const auto paths = paths_of(behind);
    const SurvivalMap map = survival_from(paths, PilotBlocks::of(8, 8), 0);
    const double smallest = variance_times_cost(paths, map, 1, 1);
    for (double scale : {0.6, 1.7}) {
      EXPECT_GT(variance_times_cost(paths, map, scale, scale), smallest) << behind << " " << scale;
      EXPECT_GT(variance_times_cost(paths, map, scale, 1), smallest) << behind << " " << scale;
    }
    // Far better than to let all of them live on, and than to let one in twenty.
    EXPECT_LT(smallest, variance_times_cost(paths, map, 1e6, 1e6));
    EXPECT_LT(smallest, variance_times_cost(paths, map, 1e-6, 1e-6));
  }
}

TEST(SurvivalMap, spares_paths_that_have_more_ahead_of_them) {
  const auto factor = [](float behind) {
    const auto paths = paths_of(behind);
    const SurvivalMap map = survival_from(paths, PilotBlocks::of(8, 8), 0);
    return map.factor<float>(0u, 0u, 2u) / map.factor<float>(0u, 0u, 1u);
  };
  EXPECT_LT(factor(0.2f), factor(1.0f));
  EXPECT_LT(factor(1.0f), factor(3.0f));
}

TEST(SurvivalMap, leaves_the_decision_to_the_throughput_where_the_pilot_saw_no_light) {
  auto paths = paths_of(0.0f);
  for (PilotPath& p : paths) {
    p.light = 0;
    for (PilotPath::Decision& d : p.decisions) d.gathered = 0;
  }
  const SurvivalMap dark = survival_from(paths, PilotBlocks::of(8, 8), 0);
  const SurvivalMap none = survival_from({}, PilotBlocks::of(64, 8), 0);
  for (std::uint32_t depth : {1u, 2u, 3u, 40u}) EXPECT_EQ(dark.factor<float>(3u, 3u, depth), 1.0f);
  EXPECT_GT(none.factor<float>(63u, 7u, 1u), 0.0f);
}

TEST(SurvivalMap, blocks_cover_the_picture) {
  for (auto [width, height] : {std::pair{1, 1}, {8, 8}, {9, 7}, {640, 480}, {1920, 1080}, {16384, 3}}) {
    const PilotBlocks b = PilotBlocks::of(width, height);
    EXPECT_LE(b.across, 16);
    EXPECT_LE(b.down, 16);
    EXPECT_EQ((width - 1) >> b.bits, b.across - 1);
    EXPECT_EQ((height - 1) >> b.bits, b.down - 1);
  }
}

TEST(PathRouletteEfficiency, gives_the_same_bits_for_any_number_of_threads_and_in_every_run) {
  const std::filesystem::path room = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/first-light";
  const TestScene scene(read_text(room / "first-light.pbrt"), room.string(), std::pair(37, 21));
  const auto mean = [&](int threads, PixelBounds crop) {
    const ChosenIntegrator chosen = scene.integrator("path:roulette=efficiency");
    RenderSettings settings = scene.settings(PointSetKind::blue_noise, {2, 3}, 5, threads);
    settings.image.bounds = crop;
    RenderObserver silent;
    const Film film = render(*chosen.integrator, settings, silent).film;
    std::vector<double> all;
    for (int y = 4; y < 12; ++y)
      for (int x = 8; x < 24; ++x) all.push_back(film.pixel(x, y).mean[0]);
    return all;
  };
  const PixelBounds whole{0, 0, 37, 21};
  const auto one = mean(1, whole);
  EXPECT_EQ(one, mean(3, whole));
  EXPECT_EQ(one, mean(2, PixelBounds{8, 4, 24, 12}));
  RenderObserver silent;
  const ChosenIntegrator other = scene.integrator("path");
  const Film film = render(*other.integrator, scene.settings(PointSetKind::blue_noise, {2, 3}, 5), silent).film;
  bool differs = false;
  std::size_t i = 0;
  for (int y = 4; y < 12; ++y)
    for (int x = 8; x < 24; ++x) differs = differs || film.pixel(x, y).mean[0] != one[i++];
  EXPECT_TRUE(differs);
}

TEST(PathRouletteEfficiency, is_among_the_choices_and_its_misspelling_is_not) {
  const TestScene scene("Film \"rgb\" \"integer xresolution\" [ 4 ] \"integer yresolution\" [ 4 ]\nWorldBegin\n");
  EXPECT_NO_THROW(scene.integrator("naive:roulette=efficiency"));
  EXPECT_THROW(scene.integrator("path:roulette=eficiency"), std::runtime_error);
  EXPECT_THROW(scene.integrator("path:roulette=efficiency:0.5"), std::runtime_error);
}

}  // namespace
}  // namespace montelux::test
