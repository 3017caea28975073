// The same question as full/coverage at a cost that every check can bear: fewer seeds and samples, wider ranges.
#include "error_bars.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace montelux::test {

namespace {

constexpr int seeds = 40, samples = 64;
constexpr PointSetKind point_sets[] = {PointSetKind::independent, PointSetKind::sobol, PointSetKind::blue_noise};
constexpr double low = 0.92, high = 0.98;

struct Decision {
  bool pixels, image, error;
  bool all() const { return pixels && image && error; }
};

// Whether pixels and image are covered within the range and the estimated error is the true one.
Decision decide(const Coverage& c) {
  const double level = sidak_level(family_level, 3.0 * std::size(point_sets) * double(error_bar_scenes().size()));
  return {c.pixels_p_value(low, high) >= level, binomial_p_value(c.images, c.seeds, low, high) >= level,
          c.ratio_p_value(1, 1) >= level};
}

class ErrorBarsOf : public testing::TestWithParam<ErrorBarScene> {};

TEST_P(ErrorBarsOf, the_scene_cover_the_truth) {
  const TestScene scene(GetParam().text);
  const Truth truth = truth_of(scene, {256, 16});
  for (PointSetKind set : point_sets) {
    const Coverage c = measure_coverage(scene, truth, set, plan_passes(samples, set), seeds);
    const Decision d = decide(c);
    EXPECT_TRUE(d.pixels) << name_of(set) << ": " << c.pixels / c.pixel_intervals << " of the pixels are covered";
    EXPECT_TRUE(d.image) << name_of(set) << ": " << c.images / c.seeds << " of the image means are covered";
    EXPECT_TRUE(d.error) << name_of(set) << ": estimated over true error " << c.ratio();
  }
}

TEST_P(ErrorBarsOf, the_scene_show_when_they_are_too_short_or_too_long) {
  const TestScene scene(GetParam().text);
  const Truth truth = truth_of(scene, {256, 16});
  const PassPlan plan = plan_passes(samples, PointSetKind::blue_noise);
  for (double fault : {0.75, 1.4})
    EXPECT_FALSE(decide(measure_coverage(scene, truth, PointSetKind::blue_noise, plan, seeds, fault)).all())
        << "errors times " << fault << " pass";
}

std::string test_name(const testing::TestParamInfo<ErrorBarScene>& scene) { return scene.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, ErrorBarsOf, testing::ValuesIn(error_bar_scenes()), test_name);

}  // namespace

// All pixels of a pass share its maps of photons: passes do not. The truth is the integrator's own mean.
TEST(ErrorBarsOfPhotonMaps, cover_their_own_mean) {
  const TestScene scene(error_bar_scenes().front().text);
  const char* const way = "photonmap:photons=2000,caustic-photons=500,radius=0.2,caustic-radius=0.1,gather-rays=1";
  constexpr PassPlan plan{2, 16};
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  const Truth truth =
      truth_of(render(chosen.any(), scene.settings(PointSetKind::padded_sobol, {2, 2048}, 0x7257u, 0), silent).film);
  const auto held = [&](double fault) {
    const Coverage c = measure_coverage(scene, truth, way, plan, 2 * seeds, fault);
    const double level = sidak_level(family_level, 3);
    return Decision{c.pixels_p_value(low, high) >= level, binomial_p_value(c.images, c.seeds, low, high) >= level,
                    c.ratio_p_value(1, 1) >= level};
  };
  const Decision d = held(1);
  EXPECT_TRUE(d.pixels);
  EXPECT_TRUE(d.image);
  EXPECT_TRUE(d.error);
  for (const double fault : {0.7, 1.5}) EXPECT_FALSE(held(fault).all()) << "errors times " << fault << " pass";
}

TEST(BinomialTest, agrees_with_exact_tails) {
  // 9 or more of 10 with p = 0.5: 11 / 1024; 1 or fewer the same.
  EXPECT_NEAR(binomial_p_value(9, 10, 0.5, 0.5), 22.0 / 1024, 1e-12);
  EXPECT_NEAR(binomial_p_value(1, 10, 0.5, 0.5), 22.0 / 1024, 1e-12);
  EXPECT_NEAR(binomial_p_value(10, 10, 0.2, 0.5), 2.0 / 1024, 1e-12);
  EXPECT_EQ(binomial_p_value(5, 10, 0.4, 0.6), 1);
}

}  // namespace montelux::test
