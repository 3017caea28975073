// Layers of integrators that gather photons: they sum to the image, and those of bounces and light groups are known.
#include <gtest/gtest.h>

#include "layer_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

const std::vector<std::string> ways{"sppm:photons=2000,radius=0.1", "sppm:photons=2000,radius=0.1,nee=off,lanes=one",
                                    "photonmap:photons=2000,caustic-photons=2000,radius=0.2,caustic-radius=0.1",
                                    "photonmap:photons=2000,gather-rays=3,nearest=20,radius=0.3,caustic-radius=0.1",
                                    "photonmap:photons=2000,gather-rays=0,radius=0.1"};

TEST(PhotonLayers, sum_to_the_image_bit_for_bit_for_any_number_of_threads) {
  const TestScene scene(three_lights);
  const LayerPlan plan = all_layers(scene.scene(), 3);
  for (const std::string& way : ways) expect_layers_of_image(scene, way, plan, 1e-5);
}

TEST(PhotonLayers, sum_to_the_image_in_fog) {
  const std::string fog =
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ .2 .1 .1 ] \"rgb sigma_s\" [ .2 .1 .3 "
      "]\n"
      "MediumInterface \"\" \"fog\"\n";
  std::string text = three_lights;
  const TestScene scene(text.insert(text.find("Camera"), fog));
  const LayerPlan plan = all_layers(scene.scene(), 3);
  for (const std::string way :
       {"sppm:photons=2000,radius=0.1,medium-radius=0.3",
        "photonmap:photons=2000,caustic-photons=2000,radius=0.2,caustic-radius=0.1,medium-radius=0.3"})
    expect_layers_of_image(scene, way, plan, 1e-5);
}

// Light that exact sums cannot hold makes samples that do not count: they are in no layer, whichever part of them it
// was.
TEST(PhotonLayers, leave_out_samples_that_do_not_count) {
  const TestScene scene(replaced(three_lights, "[ 5 5 4 ]", "[ 1e20 1e20 1e20 ]"));
  const LayerPlan plan = all_layers(scene.scene(), 2);
  for (const std::string& way : ways) expect_uncounted_in_no_layer(scene, way, plan, {1, 2}, 31);
}

// The kernel lies on a sphere of radius 1, whose curvature changes densities by less than its square.
TEST(PhotonLayers, of_bounces_have_the_closed_form_of_a_furnace) {
  const TestScene scene(furnace);
  LayerPlan plan = all_layers(scene.scene(), 4);
  for (const std::string way :
       {"sppm:photons=8000,radius=0.03,alpha=1", "sppm:photons=8000,radius=0.03,alpha=1,nee=off",
        "photonmap:photons=8000,gather-rays=2,radius=0.03,caustic-radius=0.03",
        "photonmap:photons=8000,gather-rays=0,radius=0.03"}) {
    const auto means = layer_means(scene, way, plan, 8, 16);
    const double level = sidak_level(family_level, 4 * 3 * 5);
    int faults = 0;
    for (int bounce = 0; bounce < 5; ++bounce)
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const SampleSummary m = summarize(means[std::size_t(bounce)][c]);
        const double truth = emitted[c] * std::pow(reflected[c], bounce);
        const auto p = [&](double value) {
          const double distance = std::max(0.0, std::abs(m.mean - value) - 0.001 * value);
          return distance == 0 ? 1.0
                               : 2 * student_t_cdf(-distance / m.standard_error(), double(means[0][c].size()) - 1);
        };
        EXPECT_GT(p(truth), level) << way << " bounce " << bounce << ": " << m.mean << " where " << truth
                                   << " is right";
        // What is counted as the light of one bounce more or less.
        faults += p(truth * reflected[c]) < level;
      }
    EXPECT_EQ(faults, 15) << way;
  }
}

TEST(PhotonLayers, of_light_groups_are_the_picture_of_each_light_alone) {
  const TestScene scene(three_lights);
  const LayerPlan plan = all_layers(scene.scene(), 1);
  const auto path = layer_means(scene, "path", plan, 64, 24);
  for (const std::string way : {"sppm:photons=4000,radius=0.02,alpha=1",
                                "photonmap:photons=8000,gather-rays=2,radius=0.05,caustic-radius=0.02"}) {
    const auto other = layer_means(scene, way, plan, 16, 24);
    const double level = sidak_level(family_level, 2 * 3 * 3);
    for (const char* group : {"Combined_key", "Combined_sky", "Combined_default"}) {
      const auto number = std::size_t(layer_number(plan, group));
      const auto next =
          std::size_t(layer_number(plan, std::string(group) == "Combined_key" ? "Combined_sky" : "Combined_key"));
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const SampleSummary a = summarize(other[number][c]), b = summarize(path[number][c]);
        // The kernel blurs the shadow's edge and the contact of ball and floor: less than a hundredth of the mean.
        const double distance = std::max(0.0, std::abs(a.mean - b.mean) - 0.01 * b.mean);
        const double error = std::hypot(a.standard_error(), b.standard_error());
        EXPECT_GT(2 * normal_cdf(-distance / error), level) << way << " " << group << " " << a.mean << " " << b.mean;
        EXPECT_LT(welch_test(summarize(other[next][c]), b).p_value, level) << way << " " << group;
      }
    }
  }
}

}  // namespace

}  // namespace montelux::test
