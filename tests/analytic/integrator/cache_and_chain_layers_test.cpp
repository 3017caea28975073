// Layers of the irradiance cache and of Markov chains: they sum to the image, and those of bounces, light groups and
// strategies are known.
#include <gtest/gtest.h>

#include "layer_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

const std::string by_strategies = "metropolis:strategies=bdpt";

// Chains over strategies have their layers, too.
LayerPlan plan_of(const Scene& scene, const std::string& way, int bounces) {
  LayerPlan plan = all_layers(scene, bounces);
  if (way.starts_with(by_strategies)) plan.strategies = 2, plan.alone = true;
  return plan;
}

TEST(CacheAndChainLayers, sum_to_the_image_bit_for_bit_for_any_number_of_threads) {
  // A filter that is not a box, records that count for paths of any length, and those of one length alone.
  const std::string blurred =
      replaced(replaced(three_lights, "\"box\"", "\"gaussian\""), "\"integer maxdepth\" [ 5 ]", "");
  for (const std::string& text : {three_lights, blurred}) {
    const TestScene scene(text);
    for (const std::string way :
         {"irradiance-cache:samples=64", "irradiance-cache:samples=64,accuracy=0.8,gradients=off,lanes=one",
          "metropolis", "metropolis:large-step=0.6", "metropolis:strategies=bdpt"})
      expect_layers_of_image(scene, way, plan_of(scene.scene(), way, 3), 1e-5);
  }
}

// Light that exact sums cannot hold makes samples that do not count: they are in no layer.
TEST(CacheAndChainLayers, leave_out_samples_that_do_not_count) {
  const TestScene scene(replaced(three_lights, "[ 5 5 4 ]", "[ 1e20 1e20 1e20 ]"));
  for (const std::string way : {"irradiance-cache:samples=64", "metropolis", "metropolis:strategies=bdpt"})
    expect_uncounted_in_no_layer(scene, way, plan_of(scene.scene(), way, 2), {3, 2}, 5);
}

double t_test_p_value(const SampleSummary& m, double truth) {
  if (std::abs(m.mean - truth) <= 1e-5 * truth) return 1;
  return 2 * student_t_cdf(-std::abs(m.mean - truth) / m.standard_error(), m.count - 1);
}

// Records that all depths share, and such as only one has; each bounce has L r^b in each of three colours.
TEST(CacheAndChainLayers, of_bounces_have_the_closed_form_of_a_furnace) {
  const std::string endless = replaced(furnace, "\"integer maxdepth\" [ 12 ]", "");
  for (const std::string& text : {furnace, endless}) {
    const TestScene scene(text);
    for (const std::string way :
         {"irradiance-cache:samples=64,max-spacing=0.5", "irradiance-cache:samples=64,max-spacing=0.5,gradients=off",
          "metropolis", "metropolis:strategies=bdpt"}) {
      const auto means = layer_means(scene, way, plan_of(scene.scene(), way, 4), way == by_strategies ? 48 : 8, 24);
      const double level = sidak_level(family_level, 2 * 4 * 3 * 5);
      int faults = 0;
      for (int bounce = 0; bounce < 5; ++bounce)
        for (std::size_t c = 0; c < rgb_size; ++c) {
          const SampleSummary m = summarize(means[std::size_t(bounce)][c]);
          const double truth = emitted[c] * std::pow(reflected[c], bounce);
          EXPECT_GT(t_test_p_value(m, truth), level) << way << " bounce " << bounce << ": " << m.mean << " +- "
                                                     << m.standard_error() << " where " << truth << " is right";
          // What is counted as the light of one bounce more.
          faults += t_test_p_value(m, truth * reflected[c]) < level;
        }
      EXPECT_EQ(faults, 15) << way;
    }
  }
}

TEST(CacheAndChainLayers, of_light_groups_and_techniques_are_those_of_the_path_tracer) {
  const TestScene scene(three_lights);
  const LayerPlan plan = all_layers(scene.scene(), 3);
  const auto path = layer_means(scene, "path", plan, 64, 24);
  const std::vector<std::string> names = layer_names(plan);
  for (const std::string way :
       {"irradiance-cache:accuracy=0.1,samples=256", "metropolis", "metropolis:strategies=bdpt"}) {
    const auto other = layer_means(scene, way, plan, 32, 24);
    const double level = sidak_level(family_level, 3.0 * double(path.size() * rgb_size));
    const bool interpolates = way.starts_with("irradiance");
    int tests = 0, found = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      // Bidirectional strategies share light otherwise.
      if (way == by_strategies && names[i].starts_with("technique")) continue;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const SampleSummary a = summarize(other[i][c]), b = summarize(path[i][c]);
        if (a.mean == b.mean) continue;  // nothing in both
        // Interpolation smooths the contact of ball and floor: less than a hundredth of the mean.
        const double off = std::max(0.0, std::abs(a.mean - b.mean) - (interpolates ? 0.01 * b.mean : 0));
        EXPECT_GT(2 * normal_cdf(-off / std::hypot(a.standard_error(), b.standard_error())), level)
            << way << " " << names[i] << " " << a.mean << " " << b.mean;
        // Light that is counted in the next layer.
        ++tests, found += welch_test(summarize(other[(i + 1) % path.size()][c]), b).p_value < level;
      }
    }
    EXPECT_GT(found, tests * 2 / 3) << way;
  }
}

// Every strategy by itself finds the light of its bounce, and with its weight its part of it.
TEST(CacheAndChainLayers, of_strategies_alone_have_the_closed_form_of_their_bounce) {
  const TestScene scene(furnace);
  const LayerPlan plan = plan_of(scene.scene(), by_strategies, 4);
  const auto means = layer_means(scene, by_strategies, plan, 64, 24);
  const double level = sidak_level(family_level, 24);
  int strategies = 0, faults = 0;
  for (int bounce = 0; bounce <= 2; ++bounce)
    for (int s = 0; s <= bounce + 1; ++s) {
      const std::string name = "alone_s" + std::to_string(s) + "_t" + std::to_string(bounce + 2 - s);
      const LayerMeans& layer = means[std::size_t(layer_number(plan, name))];
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const SampleSummary m = summarize(layer[c]);
        if (bounce == 0 && s == 1) {
          EXPECT_EQ(m.mean, 0);  // light that is seen is found from the eye alone
          continue;
        }
        const double truth = emitted[c] * std::pow(reflected[c], bounce);
        EXPECT_GT(t_test_p_value(m, truth), level)
            << name << " " << m.mean << " +- " << m.standard_error() << " where " << truth << " is right";
        ++strategies, faults += t_test_p_value(m, 1.5 * truth) < level;
      }
    }
  EXPECT_EQ(strategies, 24);
  EXPECT_GT(faults, strategies * 3 / 4);
}

}  // namespace

}  // namespace montelux::test
