// What it costs to cut N samples into P passes, each a randomisation of its own: the true relative mean squared error
// over seeds, against that of one long randomisation. Prints the tables of docs/error-bars.md, and holds plan_passes to
// what they say.
#include <gtest/gtest.h>

#include "error_bars.h"

namespace montelux::test {

namespace {

constexpr int splits[] = {1, 4, 8, 16, 32};

// Mean and spread over seeds of the true relative squared error of the image.
SampleSummary true_error(const TestScene& scene, const Truth& truth, PointSetKind set, PassPlan plan, int seeds) {
  std::vector<double> errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Film film = scene.render(set, plan, std::uint32_t(1000 * seed + plan.passes), Lanes::native, 0).film;
    const PixelBounds& b = film.bounds();
    double sum = 0;
    std::size_t i = 0;
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x, ++i) {
        const double off = film.pixel(x, y).mean[0] - truth.mean[i];
        sum += (off * off - truth.variance[i]) / (truth.mean[i] * truth.mean[i] + 0.01);
      }
    errors.push_back(sum / double(b.area()));
  }
  return summarize(errors);
}

class Replicates : public testing::TestWithParam<ErrorBarScene> {};

TEST_P(Replicates, cost_what_the_plan_accepts) {
  const TestScene scene(GetParam().text);
  const Truth truth = truth_of(scene, {4096, 16});
  const double level = sidak_level(family_level, 3.0 * double(point_set_names.size() * error_bar_scenes().size()));
  for (int n : {64, 256, 1024})
    for (const NamedPointSet& set : point_set_names) {
      const int seeds = n == 1024 ? 8 : 24;
      const SampleSummary one = true_error(scene, truth, set.kind, {n, 1}, seeds);
      std::printf("| %s | %d | %s | %.2g |", GetParam().name.c_str(), n, std::string(set.name).c_str(), one.mean);
      for (int passes : splits) {
        if (passes == 1) continue;
        std::printf(" %.2f |", true_error(scene, truth, set.kind, {n / passes, passes}, seeds).mean / one.mean);
      }
      std::printf("\n");
      std::fflush(stdout);
      const SampleSummary planned = true_error(scene, truth, set.kind, plan_passes(n, set.kind), seeds);
      // Not proven to be above 2.5 times that of one randomisation.
      const double error = std::sqrt(planned.variance / planned.count + 6.25 * one.variance / one.count);
      EXPECT_GT(at_most_p_value(planned.mean - 2.5 * one.mean, error, 0), level) << set.name << ", " << n << " samples";
    }
}

std::string test_name(const testing::TestParamInfo<ErrorBarScene>& scene) { return scene.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, Replicates, testing::ValuesIn(error_bar_scenes()), test_name);

}  // namespace

}  // namespace montelux::test
