// Error bars hold what they promise: 95 % intervals of pixels and of the image mean cover 93 % to 97 %, and the
// estimated mean squared error of the image is the true one within a tenth, for every point set. A figure fails where
// its own interval excludes the range, at 1 % for all figures together. Prints the table of docs/error-bars.md.
#include "error_bars.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace montelux::test {

namespace {

// An image gives one interval of its mean and many of its pixels: small images serve the former.
constexpr int seeds = 200, seeds_of_small_images = 800, samples = 256;
constexpr double low = 0.93, high = 0.97, ratio_low = 0.9, ratio_high = 1.1;
constexpr double family = 0.01;

class ErrorBars : public testing::TestWithParam<ErrorBarScene> {};

TEST_P(ErrorBars, cover_the_truth_as_often_as_they_say) {
  const TestScene scene(GetParam().text), small(GetParam().text, ".", std::pair{8, 8});
  const Truth truth = truth_of(scene, {2048, 16}), small_truth = truth_of(small, {2048, 16});
  const double decisions = 3.0 * double(point_set_names.size() * error_bar_scenes().size());
  const double level = sidak_level(family, decisions);
  for (const NamedPointSet& set : point_set_names) {
    const PassPlan plan = plan_passes(samples, set.kind);
    const Coverage c = measure_coverage(scene, truth, set.kind, plan, seeds);
    const Coverage s = measure_coverage(small, small_truth, set.kind, plan, seeds_of_small_images);
    const double pixels = c.pixels / c.pixel_intervals, held = c.images + s.images, images = c.seeds + s.seeds;
    std::printf("| %s | %s | %d x %d | %.1f %% | %.1f %% | %.3f |\n", GetParam().name.c_str(),
                std::string(set.name).c_str(), plan.passes, plan.samples_per_pass, 100 * pixels, 100 * held / images,
                c.ratio());
    std::fflush(stdout);
    EXPECT_GE(c.pixels_p_value(low, high), level) << set.name << ": pixels " << pixels;
    EXPECT_GE(binomial_p_value(held, images, low, high), level) << set.name << ": image " << held / images;
    EXPECT_GE(c.ratio_p_value(ratio_low, ratio_high), level) << set.name << ": estimated over true " << c.ratio();
  }
}

// Standard errors that are a quarter too small or three quarters too large fail by each of the three figures.
TEST_P(ErrorBars, that_are_slightly_wrong_are_found) {
  const TestScene scene(GetParam().text), small(GetParam().text, ".", std::pair{8, 8});
  const Truth truth = truth_of(scene, {2048, 16}), small_truth = truth_of(small, {2048, 16});
  const double level = sidak_level(family, 3.0 * double(point_set_names.size() * error_bar_scenes().size()));
  const PointSetKind set = PointSetKind::blue_noise;
  for (const double fault : {0.75, 1.75}) {
    const Coverage c = measure_coverage(scene, truth, set, plan_passes(samples, set), seeds, fault);
    const Coverage s =
        measure_coverage(small, small_truth, set, plan_passes(samples, set), seeds_of_small_images, fault);
    const double held = c.images + s.images, images = c.seeds + s.seeds;
    EXPECT_LT(c.pixels_p_value(low, high), level) << fault << ": pixels " << c.pixels / c.pixel_intervals;
    EXPECT_LT(binomial_p_value(held, images, low, high), level) << fault << ": image " << held / images;
    EXPECT_LT(c.ratio_p_value(ratio_low, ratio_high), level) << fault << ": estimated over true " << c.ratio();
  }
}

// Where a pixel's light comes by few samples, the mean of a pass is far from normal and its interval covers too seldom;
// the image mean and the mean squared error are not touched by that.
TEST(ErrorBarsOfSpecks, cover_the_image_and_estimate_its_error) {
  const ErrorBarScene specks = specks_scene();
  const TestScene scene(specks.text);
  const Truth truth = truth_of(scene, {2048, 16});
  const double level = sidak_level(family, 9);
  for (int n : {64, 256, 1024}) {
    const PassPlan plan = plan_passes(n, PointSetKind::blue_noise);
    const Coverage c = measure_coverage(scene, truth, PointSetKind::blue_noise, plan, 100);
    std::printf("| specks | blue-noise | %d x %d | %.1f %% | %.1f %% | %.3f |\n", plan.passes, plan.samples_per_pass,
                100 * c.pixels / c.pixel_intervals, 100 * c.images / c.seeds, c.ratio());
    std::fflush(stdout);
    EXPECT_GE(c.pixels_p_value(0.85, high), level);
    EXPECT_GE(binomial_p_value(c.images, c.seeds, low, high), level);
    EXPECT_GE(c.ratio_p_value(ratio_low, ratio_high), level);
  }
}

std::string test_name(const testing::TestParamInfo<ErrorBarScene>& scene) { return scene.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, ErrorBars, testing::ValuesIn(error_bar_scenes()), test_name);

}  // namespace

}  // namespace montelux::test
