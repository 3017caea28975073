// Layers of integrators that follow light from both ends: they sum to the image, bounces and light groups are those of
// the path tracer, and every strategy by itself finds the closed form.
#include <gtest/gtest.h>

#include "layer_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

const std::vector<std::string> ways{"light",
                                    "light:lanes=one",
                                    "bdpt",
                                    "bdpt:mis=balance,lanes=one",
                                    "vcm:photons=2000,radius=0.1",
                                    "vcm:photons=2000,radius=0.1,connect=off"};

const std::string fog_room = std::string(small_film) + R"(
Integrator "path" "integer maxdepth" [ 4 ]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 0.4 0.3 0.2 ] "rgb sigma_a" [ 0.05 0.1 0.1 ]
    "rgb Le" [ 0.02 0.01 0.03 ]
LookAt 0 1 -3   0 1 0   0 1 0
MediumInterface "" "fog"
Camera "perspective" "float fov" [ 50 ]
WorldBegin
MediumInterface "fog" "fog"
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 5 5 4 ] "string group" "key"
  Translate 0.8 1.5 0
  Shape "sphere" "float radius" [ 0.3 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2   2 0 -2   -2 0 2   2 0 2 ]
MediumInterface "fog" ""
Material "interface"
Shape "sphere" "float radius" [ 4 ]
MediumInterface "" ""
LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ] "string group" "sky"
)";
LayerPlan plan_of(const Scene& scene, const std::string& way) {
  LayerPlan plan = all_layers(scene, 3);
  plan.techniques = false;
  if (scene.media.emits()) {
    plan.group_of_light.push_back(std::uint32_t(plan.group_names.size()));
    plan.group_names.emplace_back("media");
  }
  if (way.starts_with("path")) return plan;
  plan.strategies = 2, plan.alone = true, plan.mergings = way.starts_with("vcm");
  return plan;
}

TEST(StrategyLayers, sum_to_the_image_bit_for_bit_for_any_number_of_threads) {
  for (const std::string& text : {three_lights, fog_room}) {
    const TestScene scene(text);
    for (const std::string& way : ways) {
      if (text == fog_room && way.ends_with("connect=off")) continue;
      expect_layers_of_image(scene, way, plan_of(scene.scene(), way), 4e-6);
    }
  }
}

// Passes of an interrupted render, merged: the layers of one that was not.
TEST(StrategyLayers, merge_as_the_film_does) {
  const TestScene scene(three_lights);
  const LayerPlan plan = plan_of(scene.scene(), "bdpt");
  const Film whole = film_of(scene, "bdpt", plan, {2, 3});
  Film merged = film_of(scene, "bdpt", plan, {2, 2}, 2, 1);
  merged.merge(film_of(scene, "bdpt", plan, {2, 1}));
  const PixelBounds& b = whole.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x)
      for (int i = 0; i < plan.count(); ++i) EXPECT_EQ(whole.layers()->layer(x, y, i), merged.layers()->layer(x, y, i));
}

TEST(StrategyLayers, of_bounces_and_light_groups_are_those_of_the_path_tracer) {
  for (const std::string& text : {three_lights, fog_room}) {
    const TestScene scene(text);
    const LayerPlan plan = plan_of(scene.scene(), "path");
    const auto path = layer_means(scene, "path", plan, 64, 24);
    for (const std::string way : {"light", "bdpt"}) {
      if (text == fog_room && way == "light") continue;  // it misses what media emit
      const auto other = layer_means(scene, way, plan_of(scene.scene(), way), 32, 24);
      const double level = sidak_level(family_level, 3.0 * double(path.size() * rgb_size));
      int found = 0;
      for (std::size_t i = 0; i < path.size(); ++i)
        for (std::size_t c = 0; c < rgb_size; ++c) {
          const SampleSummary a = summarize(other[i][c]), b = summarize(path[i][c]);
          if (a.mean == b.mean) continue;  // nothing in both
          EXPECT_GT(welch_test(a, b).p_value, level)
              << way << " " << layer_names(plan)[i] << " " << a.mean << " " << b.mean;
          // A light that is counted in the group of another, and light that is lost.
          const auto turned = summarize(other[(i + 1) % path.size()][c]);
          found += welch_test(turned, b).p_value < level;
        }
      EXPECT_GT(found, int(path.size()) * 2) << way;
    }
  }
}

TEST(StrategyLayers, alone_have_the_closed_form_of_their_bounce) {
  const TestScene scene(furnace);
  for (const std::string way : {"light", "bdpt", "bdpt:mis=balance", "vcm:photons=4000,radius=0.02,alpha=1"}) {
    const LayerPlan plan = plan_of(scene.scene(), way);
    const auto means = layer_means(scene, way, plan, 16, 16);
    const std::vector<std::string> names = layer_names(plan);
    const double level = sidak_level(family_level, 4 * 3 * 12);
    int strategies = 0, faults = 0;
    for (int bounce = 0; bounce <= 2; ++bounce)
      for (const bool merged : {false, true})
        for (int s = merged ? 2 : 0; s <= bounce + 1; ++s) {
          if (merged && !plan.mergings) continue;
          const int t = bounce + (merged ? 3 : 2) - s;
          const std::string name =
              (merged ? "alone_merging_s" : "alone_s") + std::to_string(s) + "_t" + std::to_string(t);
          const LayerMeans& layer = means[std::size_t(layer_number(plan, name))];
          // `light` connects all vertices with the lens, the others leave light that is seen to paths from the eye.
          const bool is_used = way == "light" ? t == 1 : !(s == 1 && t == 1);
          for (std::size_t c = 0; c < rgb_size; ++c) {
            const SampleSummary m = summarize(layer[c]);
            if (!is_used) {
              EXPECT_EQ(m.mean, 0) << way << " " << name;
              continue;
            }
            const double truth = emitted[c] * std::pow(reflected[c], bounce);
            const auto p = [&](double value) {
              if (std::abs(m.mean - value) <= 1e-5 * value) return 1.0;
              return 2 * student_t_cdf(-std::abs(m.mean - value) / m.standard_error(), double(layer[c].size()) - 1);
            };
            EXPECT_GT(p(truth), level) << way << " " << name << " " << m.mean << " where " << truth << " is right";
            ++strategies, faults += p(1.1 * truth) < level;
          }
        }
    EXPECT_EQ(strategies, way == "light" ? 9 : way.starts_with("bdpt") ? 24 : 33) << way;
    // A tenth more is found in nearly all.
    EXPECT_GT(faults, strategies * 3 / 4) << way;
  }
}

}  // namespace

}  // namespace montelux::test
