// Error bars of bidirectional path tracing, whose pixels share splats, of Markov chains, whose pixels share chains, of
// paths with chains to lights, which divide by estimated probabilities, and of ways with a bias, about their own mean:
// 95 % intervals of pixels and of the image mean cover 93 % to 97 %, and the estimated mean squared error is the true
// one within a tenth. Prints the table of docs/error-bars.md.
#include <gtest/gtest.h>

#include "error_bars.h"

namespace montelux::test {

namespace {

constexpr PassPlan plan{16, 8};
// Few chains visit a pixel in a pass of 16 samples: its means are so skewed that Student's intervals of 8 passes cover
// too little. A sample of chains over strategies is a single strategy, so that they need more.
constexpr PassPlan plan_of_chains{64, 8}, plan_of_strategies{256, 8};
// Light from a wide sky seldom comes to what the camera sees.
constexpr PassPlan plan_of_light{128, 8}, plan_of_light_from_sky{4096, 8};
// An image gives one interval of its mean and many of its pixels: small images serve the former.
constexpr int seeds = 100, seeds_of_small_images = 700;
constexpr int seeds_of_chains = 50, small_seeds_of_chains = 150, seeds_of_strategies = 15,
              small_seeds_of_strategies = 50, seeds_with_bias = 50, small_seeds_with_bias = 300;
constexpr double low = 0.93, high = 0.97, ratio_low = 0.9, ratio_high = 1.1;
constexpr double family = 0.01;

// Light of lamps without a size by way of flat mirrors and panes. What curved ones focus has no finite variance.
const std::vector<ErrorBarScene>& scenes_of_chains() {
  const std::string head = error_bar_head + R"(
LookAt 0 0.6 -2.8  0 -0.3 0  0 1 0
Camera "perspective" "float fov" [ 45 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.05 0.05 0.05 ]
)";
  const std::string floor = R"(
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
Shape "bilinearmesh" "point3 P" [ -2 -1 -2  2 -1 -2  -2 -1 2  2 -1 2 ]
Translate -0.4 -0.7 0
Shape "sphere" "float radius" [ 0.3 ]
)",
                    wall = R"(Shape "bilinearmesh" "point3 P" [ 1.2 -1 -1  1.2 -1 1  1.2 1 -1  1.2 1 1 ])",
                    pane = R"(Shape "bilinearmesh" "point3 P" [ -1 0.5 -1  1 0.5 -1  -1 0.5 1  1 0.5 1 ])";
  static const std::vector<ErrorBarScene> scenes{
      {"mirror", head + R"(LightSource "spot" "rgb I" [ 4 4 4 ] "point3 from" [ -0.5 1.5 -0.3 ] "point3 to" [ 1.2 0 0 ]
Material "conductor" "float roughness" [ 0 ]
)" + wall + floor},
      {"pane", head + R"(LightSource "distant" "rgb L" [ 1 1 1 ] "point3 from" [ 0.4 1 -0.2 ] "point3 to" [ 0 0 0 ]
Material "thindielectric"
)" + pane + floor},
      {"frosted pane", head + R"(LightSource "point" "rgb I" [ 3 3 3 ] "point3 from" [ 0.3 2 0 ]
Material "dielectric" "float roughness" [ 0.05 ] "bool remaproughness" false
)" + pane + floor}};
  return scenes;
}

// What the intervals should hold: the light of the scene, by path tracing or by the way itself where paths do not find
// it; or, of a way with a bias, the mean of its passes.
enum class Held { light, own_light, own_mean };
struct Case {
  const char* way;
  const std::vector<ErrorBarScene>& scenes;
  PassPlan plan;
  int seeds, small_seeds;
  Held held = Held::light;
};
// Else the names of tests would show the bytes of the case.
void PrintTo(const Case& c, std::ostream* out) { *out << c.way; }
const std::vector<Case>& cases() {
  static const std::vector<ErrorBarScene> box{error_bar_scenes()[0]}, sky{error_bar_scenes()[1]},
      box_and_lamps{error_bar_scenes()[0], error_bar_scenes()[2]};
  static const std::vector<Case> all{
      {"path:manifold=1,manifold-roughness=0.1", scenes_of_chains(), plan, seeds, seeds_of_small_images,
       Held::own_light},
      {"sppm:photons=2000", box_and_lamps, plan, seeds_with_bias, small_seeds_with_bias, Held::own_mean},
      {"sppm:photons=30000", sky, plan, seeds_with_bias, small_seeds_with_bias, Held::own_mean},
      {"photonmap:photons=2000", error_bar_scenes(), plan, seeds_with_bias, small_seeds_with_bias, Held::own_mean},
      {"vcm:photons=2000", error_bar_scenes(), plan, seeds_with_bias, small_seeds_with_bias, Held::own_mean},
      {"irradiance-cache", error_bar_scenes(), plan, seeds_with_bias, small_seeds_with_bias, Held::own_mean},
      {"bdpt", error_bar_scenes(), plan, seeds, seeds_of_small_images},
      {"light", box_and_lamps, plan_of_light, seeds_of_chains, small_seeds_of_chains},
      {"light", sky, plan_of_light_from_sky, seeds_of_strategies, small_seeds_of_strategies},
      {"metropolis", error_bar_scenes(), plan_of_chains, seeds_of_chains, small_seeds_of_chains},
      {"metropolis:strategies=bdpt", box, plan_of_strategies, seeds_of_strategies, small_seeds_of_strategies}};
  return all;
}
double level_of_a_figure() {
  double figures = 0;
  for (const Case& c : cases()) figures += 3 * double(c.scenes.size());
  return sidak_level(family, figures);
}

class ErrorBarsOfLightPaths : public testing::TestWithParam<Case> {};

TEST_P(ErrorBarsOfLightPaths, cover_the_truth_as_often_as_they_say) {
  const auto& [way, scenes, passes, own_seeds, small_seeds, what] = GetParam();
  const double level = level_of_a_figure();
  for (const ErrorBarScene& s : scenes) {
    const TestScene scene(s.text), small(s.text, ".", std::pair{8, 8});
    const auto truth_of_pixels = [&, what = what, way = way, passes = passes](const TestScene& of) {
      if (what == Held::own_mean) return truth_of(of, {passes.samples_per_pass, 512}, way);
      return what == Held::own_light ? truth_of(of, {512, 16}, way) : truth_of(of, {2048, 16});
    };
    const Truth truth = truth_of_pixels(scene), small_truth = truth_of_pixels(small);
    const Coverage c = measure_coverage(scene, truth, way, passes, own_seeds),
                   of_small = measure_coverage(small, small_truth, way, passes, small_seeds);
    const double held = c.images + of_small.images, images = c.seeds + of_small.seeds;
    const ShareInterval of_pixels = mean_interval(c.pixel_share, 0.05),
                        of_images = binomial_interval(held, images, 0.05);
    std::printf("| %s | `%s` | %d x %d | %.1f %% (%.1f to %.1f) | %.1f %% (%.1f to %.1f) | %.3f |\n", s.name.c_str(),
                way, passes.passes, passes.samples_per_pass, 100 * c.pixels / c.pixel_intervals, 100 * of_pixels.low,
                100 * of_pixels.high, 100 * held / images, 100 * of_images.low, 100 * of_images.high, c.ratio());
    std::fflush(stdout);
    EXPECT_GE(c.pixels_p_value(low, high), level) << s.name << ": pixels";
    EXPECT_GE(binomial_p_value(held, images, low, high), level) << s.name << ": image means";
    EXPECT_GE(c.ratio_p_value(ratio_low, ratio_high), level) << s.name << ": estimated over true";
  }
}

TEST(ErrorBarsOfLightPathsPlanted, that_are_a_quarter_too_small_are_found) {
  const TestScene scene(error_bar_scenes()[0].text);
  const Coverage c = measure_coverage(scene, truth_of(scene, {2048, 16}), "bdpt", plan, seeds, 0.75);
  EXPECT_LT(c.pixels_p_value(low, high), level_of_a_figure());
  EXPECT_LT(c.ratio_p_value(ratio_low, ratio_high), level_of_a_figure());
}

// The skew of short passes, which the plan above avoids: intervals are then too narrow, whose variance is right.
TEST(ErrorBarsOfChains, cover_too_little_where_passes_are_short) {
  const TestScene scene(error_bar_scenes()[0].text);
  const Coverage c = measure_coverage(scene, truth_of(scene, {2048, 16}), "metropolis", plan, seeds);
  EXPECT_LT(c.pixels_p_value(low, high), level_of_a_figure()) << 100 * c.pixels / c.pixel_intervals << " %";
  EXPECT_GE(c.ratio_p_value(ratio_low, ratio_high), level_of_a_figure()) << c.ratio();
}

std::string test_name(const testing::TestParamInfo<Case>& c) {
  std::string name = std::string(c.param.way) + "_" + std::to_string(c.param.plan.samples_per_pass);
  for (char& letter : name)
    if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Ways, ErrorBarsOfLightPaths, testing::ValuesIn(cases()), test_name);

}  // namespace

}  // namespace montelux::test
