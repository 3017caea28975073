// Error bars hold what they promise: 95 % intervals of pixels and of the image mean cover 93 % to 97 % over 200 seeds,
// and the estimated mean squared error of the image is the true one within a tenth, for every point set. Prints the
// table of docs/error-bars.md.
#include "error_bars.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace montelux::test {

namespace {

constexpr int seeds = 200, samples = 256;
constexpr double low = 0.93, high = 0.97;

class ErrorBars : public testing::TestWithParam<ErrorBarScene> {};

TEST_P(ErrorBars, cover_the_truth_as_often_as_they_say) {
  const TestScene scene(GetParam().text);
  const Truth truth = truth_of(scene, {2048, 16});
  const double decisions = 3.0 * double(point_set_names.size() * error_bar_scenes().size());
  const double level = sidak_level(family_level, decisions);
  for (const NamedPointSet& set : point_set_names) {
    const PassPlan plan = plan_passes(samples, set.kind);
    const Coverage c = measure_coverage(scene, truth, set.kind, plan, seeds);
    const SampleSummary pixels = summarize(c.pixel_share);
    const double ratio = c.estimated_mse / c.true_mse;
    std::printf("| %s | %s | %d x %d | %.1f %% | %.1f %% | %.3f |\n", GetParam().name.c_str(),
                std::string(set.name).c_str(), plan.passes, plan.samples_per_pass, 100 * pixels.mean,
                100 * c.images / c.seeds, ratio);
    // The nearest share in the range, and how far the measured one may be from it by chance.
    const double nearest = std::clamp(pixels.mean, low, high);
    EXPECT_GE(t_test(pixels, nearest).p_value, level) << set.name << ": pixels " << pixels.mean;
    EXPECT_GE(binomial_p_value(c.images, c.seeds, low, high), level) << set.name << ": image " << c.images / c.seeds;
    EXPECT_GT(ratio, 0.9) << set.name;
    EXPECT_LT(ratio, 1.1) << set.name;
  }
}

// Where a pixel's light comes by few samples, the mean of a pass is far from normal and its interval covers too seldom;
// the image mean and the mean squared error are not touched by that.
TEST(ErrorBarsOfSpecks, cover_the_image_and_estimate_its_error) {
  const ErrorBarScene specks = specks_scene();
  const TestScene scene(specks.text);
  const Truth truth = truth_of(scene, {2048, 16});
  for (int n : {64, 256, 1024}) {
    const PassPlan plan = plan_passes(n, PointSetKind::blue_noise);
    const Coverage c = measure_coverage(scene, truth, PointSetKind::blue_noise, plan, 100);
    const double pixels = c.pixels / c.pixel_intervals, ratio = c.estimated_mse / c.true_mse;
    std::printf("| specks | blue-noise | %d x %d | %.1f %% | %.1f %% | %.3f |\n", plan.passes, plan.samples_per_pass,
                100 * pixels, 100 * c.images / c.seeds, ratio);
    EXPECT_GT(pixels, 0.85);
    EXPECT_GE(binomial_p_value(c.images, c.seeds, low, high), family_level);
    EXPECT_GT(ratio, 0.9);
    EXPECT_LT(ratio, 1.1);
  }
}

std::string test_name(const testing::TestParamInfo<ErrorBarScene>& scene) { return scene.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, ErrorBars, testing::ValuesIn(error_bar_scenes()), test_name);

}  // namespace

}  // namespace montelux::test
