// Layers of light: they sum to the picture, and each holds what it says.
#include <gtest/gtest.h>

#include "layer_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
const std::vector<std::string> layered_ways{"path",
                                            "path:lanes=one,mis=off",
                                            "path:light-selection=ris:4",
                                            "naive",
                                            "direct",
                                            "direct:strategy=ris,candidates=3",
                                            "direct:strategy=cosine,shadow-rays=3",
                                            "direct:strategy=bsdf",
                                            "distribution:branching=2/1,shadow-rays=2/1"};

RenderResult render_layers(const TestScene& scene, const PixelIntegrator& integrator, const LayerPlan& plan,
                           PassPlan passes, int threads = 1, int first_pass = 0) {
  RenderSettings settings = scene.settings(PointSetKind::independent, passes, 5, threads);
  settings.image.layers = plan;
  settings.plan.first_pass = first_pass;
  RenderObserver silent;
  return render(integrator, settings, silent);
}

// What goes wrong when a contribution is booked wrongly: at every pixel, a tenth of layer `from` is lost, or found
// again in layer `to`.
class Misbooked final : public PixelIntegrator {
 public:
  Misbooked(const PixelIntegrator& inner, int from, std::optional<int> to) : inner_(inner), from_(from), to_(to) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override { return inner_.trace(pass, out); }
  bool has_layers() const override { return true; }
  RayCounts trace_layers(const TilePass& pass, const LayerPlan& plan, std::span<PixelSample> out,
                         std::span<ExactRgb> sums) const override {
    const RayCounts counts = inner_.trace_layers(pass, plan, out, sums);
    const std::size_t stride = std::size_t(plan.count()) + 1;
    for (std::size_t first = 1; first < sums.size(); first += stride)
      for (int c = 0; c < rgb_size; ++c) {
        ExactSum& light = sums[first + std::size_t(from_)].c[c];
        ExactSum part;
        part.add(0.1f * float(light.value()));
        light -= part;
        if (to_) sums[first + std::size_t(*to_)].c[c] += part;
      }
    return counts;
  }

 private:
  const PixelIntegrator& inner_;
  int from_;
  std::optional<int> to_;
};

const std::string lights_and_glass = three_lights + R"(
Material "dielectric"
AttributeBegin
  Translate 0.5 0.4 -0.3
  Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
)";

TEST(Layers, sum_to_the_picture_bit_for_bit_in_every_integrator) {
  const TestScene scene(lights_and_glass);
  const LayerPlan plan = all_layers(scene.scene(), 2);
  EXPECT_EQ(plan.group_names, (std::vector<std::string>{"key", "sky", "default"}));
  for (const std::string& way : layered_ways) {
    const ChosenIntegrator chosen = scene.integrator(way);
    const RenderResult result = render_layers(scene, *chosen.integrator, plan, {2, 4});
    EXPECT_TRUE(families_sum_to_all(result.film, plan)) << way;
    EXPECT_EQ(result.film.non_finite(), 0u);
    // A contribution that is lost in one layer is missed; and so is one that is counted twice.
    const Misbooked lossy(*chosen.integrator, layer_number(plan, "bounce1"), {});
    EXPECT_FALSE(families_sum_to_all(render_layers(scene, lossy, plan, {2, 4}).film, plan)) << way;
  }
}

TEST(Layers, leave_the_picture_what_it_is_without_them) {
  const TestScene scene(lights_and_glass);
  const LayerPlan plan = all_layers(scene.scene(), 2);
  for (const std::string& way : layered_ways) {
    const ChosenIntegrator chosen = scene.integrator(way);
    const Film film = render_layers(scene, *chosen.integrator, plan, {2, 4}).film;
    RenderObserver silent;
    const Film plain = render(*chosen.integrator, scene.settings(PointSetKind::independent, {2, 4}, 5), silent).film;
    const PixelBounds& b = film.bounds();
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x)
        for (int c = 0; c < 3; ++c) {
          const PixelEstimate &p = film.pixel(x, y), &q = plain.pixel(x, y);
          // Floats are summed along a path in one case and by recursion in the other.
          EXPECT_NEAR(film.layers()->mean(x, y, c), q.mean[c], 2e-6 * q.mean[c]) << way;
          EXPECT_NEAR(p.mean[c], film.layers()->mean(x, y, c), 1e-14 * q.mean[c]) << way;
          EXPECT_NEAR(p.variance_of_mean(c), q.variance_of_mean(c), 1e-5 * (q.mean[c] * q.mean[c])) << way;
          // The co-moments of a family sum to the picture's own.
          for (const LayerFamily& family : layer_families(plan)) {
            double sum = 0;
            for (int i = 0; i < family.count; ++i) sum += film.layers()->spread(x, y, family.first + i).co_moment[c];
            EXPECT_NEAR(sum, p.m2[c], 1e-11 * (p.m2[c] + p.mean[c] * p.mean[c])) << way << " " << family.name;
          }
        }
  }
}

TEST(Layers, are_the_same_bits_for_any_number_of_threads_and_any_merge) {
  const TestScene scene(lights_and_glass);
  const LayerPlan plan = all_layers(scene.scene(), 3);
  const ChosenIntegrator chosen = scene.integrator("path");
  const Film whole = render_layers(scene, *chosen.integrator, plan, {2, 6}).film;
  const Film threads = render_layers(scene, *chosen.integrator, plan, {2, 6}, 3).film;
  Film last = render_layers(scene, *chosen.integrator, plan, {2, 3}, 1, 3).film;
  Film merged = render_layers(scene, *chosen.integrator, plan, {2, 3}).film, reversed = last;
  reversed.merge(merged);
  merged.merge(last);
  EXPECT_TRUE(families_sum_to_all(merged, plan));
  const PixelBounds& b = whole.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x)
      for (int i = 0; i < plan.count(); ++i) {
        EXPECT_EQ(whole.layers()->layer(x, y, i), threads.layers()->layer(x, y, i));
        EXPECT_EQ(whole.layers()->layer(x, y, i), merged.layers()->layer(x, y, i));
        EXPECT_EQ(whole.layers()->layer(x, y, i), reversed.layers()->layer(x, y, i));
        const double variance = whole.layers()->variance_of_mean(x, y, i, 0);
        EXPECT_NEAR(merged.layers()->variance_of_mean(x, y, i, 0), variance, 1e-12 * (1 + variance));
      }
}

// The bounces that have layers of their own, and the expectation of each.
struct Series {
  std::string scene;
  std::vector<double> bounces;
  double rest;
};

std::vector<Series> known_series() {
  std::vector<Series> all{{"closed-furnace-sphere.pbrt", {}, 0.5 * std::pow(0.6, 5) / 0.4},
                          {"closed-furnace-box.pbrt", {}, 0.6 * std::pow(0.5, 5) / 0.5},
                          {"integrating-sphere.pbrt", {0}, 0.5 / (4 * double(pi)) * std::pow(0.5, 4) / 0.5}};
  for (int k = 0; k < 5; ++k) {
    all[0].bounces.push_back(0.5 * std::pow(0.6, k));
    all[1].bounces.push_back(0.6 * std::pow(0.5, k));
    if (k > 0) all[2].bounces.push_back(0.5 / (4 * double(pi)) * std::pow(0.5, k - 1));
  }
  return all;
}

double bounce_p_value(const LayerPicture& p, double truth) {
  const double distance = std::max(0.0, std::abs(p.image_mean - truth) - 1e-5 * truth);
  if (distance == 0) return 1;
  return z_test(distance, p.image_standard_error, 0).p_value;
}

TEST(Layers, of_bounces_are_the_terms_of_the_neumann_series_where_they_are_known) {
  const std::vector<std::string> ways{"path", "naive", "distribution:branching=2/1,shadow-rays=1"};
  const double level = sidak_level(family_level, 6 * 8);
  for (const Series& series : known_series()) {
    const TestScene scene(read_text(folder / series.scene), folder.string());
    const LayerPlan plan = all_layers(scene.scene(), 4);
    for (const std::string& way : ways) {
      const ChosenIntegrator chosen = scene.integrator(way);
      // The twin books a tenth of the second bounce as the third.
      const Misbooked wrong(*chosen.integrator, 2, 3);
      const Film film = render_layers(scene, *chosen.integrator, plan, {16, 32}).film;
      const Film twin = render_layers(scene, wrong, plan, {16, 32}).film;
      EXPECT_TRUE(families_sum_to_all(twin, plan)) << "the twin's fault is one that sums do not show";
      for (int k = 0; k < 5; ++k) {
        const LayerPicture p = layer_picture(film, k);
        EXPECT_GE(bounce_p_value(p, series.bounces[std::size_t(k)]), level)
            << series.scene << " " << way << " bounce" << k << ": " << p.image_mean << " +- " << p.image_standard_error
            << " where " << series.bounces[std::size_t(k)] << " is right";
      }
      EXPECT_GE(bounce_p_value(layer_picture(film, 5), series.rest), level) << series.scene << " " << way;
      for (int k = 2; k < 4; ++k)
        EXPECT_LT(bounce_p_value(layer_picture(twin, k), series.bounces[std::size_t(k)]), level)
            << series.scene << " " << way << " bounce" << k;
    }
  }
}

// The layer of a group is the picture of the scene without the other lights.
TEST(Layers, of_a_light_group_are_the_picture_with_the_other_lights_removed) {
  const std::string all = lights_and_glass;
  const std::string key = R"(  AreaLightSource "diffuse" "rgb L" [ 5 5 4 ] "string group" "key"
)";
  const std::string sky = R"(LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ] "string group" "sky"
)";
  const std::string point = R"(LightSource "point" "rgb I" [ 2 1 1 ] "point3 from" [ -1 2 -1 ]
)";
  // Black lamps stay where they are, since their sphere is in the way of light.
  const std::string no_key = R"(  AreaLightSource "diffuse" "rgb L" [ 0 0 0 ]
)";
  const struct {
    const char* group;
    std::string text;
  } alone[] = {{"Combined_key", replaced(replaced(all, sky, ""), point, "")},
               {"Combined_sky", replaced(replaced(all, key, no_key), point, "")},
               {"Combined_default", replaced(replaced(all, key, no_key), sky, "")}};
  const TestScene scene(all);
  const LayerPlan plan = all_layers(scene.scene(), 1);
  for (const std::string way :
       {"path", "path:light-selection=ris:4", "naive", "direct", "distribution:branching=2/1,shadow-rays=1"}) {
    const Film film = render_layers(scene, *scene.integrator(way).integrator, plan, {8, 32}).film;
    LayerPicture before;
    for (const auto& [group, text] : alone) {
      const TestScene lone(text);
      RenderSettings settings = lone.settings(PointSetKind::independent, {8, 32}, 99);
      settings.image.layers = all_layers(lone.scene(), 0);
      RenderObserver silent;
      const ChosenIntegrator other = lone.integrator(way);
      const LayerPicture truth = layer_picture(render(*other.integrator, settings, silent).film, -1);
      const LayerPicture layer = layer_picture(film, layer_number(plan, group));
      const WelchReport report = welch_test(layer.estimate(), truth.estimate(), family_level / 15);
      EXPECT_FALSE(report.image.differs) << way << " " << group << " t = " << report.image.t;
      EXPECT_FALSE(report.blocks.differs) << way << " " << group << " p = " << report.blocks.smallest_p;
      // Another group's light is not it.
      if (before.passes > 0) {
        EXPECT_TRUE(welch_test(before.estimate(), truth.estimate(), family_level / 15).image.differs) << way << group;
      }
      before = layer;
    }
  }
}

// In a room with a mirror-like ball and a glass one.
TEST(Layers, of_the_first_bounce_are_the_light_of_the_direct_integrator) {
  const std::filesystem::path room = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/first-light";
  const TestScene scene(read_text(room / "first-light.pbrt"), room.string(), std::pair(24, 18));
  const LayerPlan plan = all_layers(scene.scene(), 2);
  const auto film_of = [&](const char* way) {
    return render_layers(scene, *scene.integrator(way).integrator, plan, {8, 32}).film;
  };
  const Film path = film_of("path"), other_numbers = film_of("direct:strategy=light-area"), naive = film_of("naive");
  for (int bounce : {0, 1}) {
    const LayerPicture by_path = layer_picture(path, bounce), direct = layer_picture(other_numbers, bounce),
                       by_naive = layer_picture(naive, bounce);
    EXPECT_FALSE(welch_test(by_path.estimate(), direct.estimate(), family_level / 4).image.differs) << bounce;
    EXPECT_FALSE(welch_test(by_naive.estimate(), direct.estimate(), family_level / 4).image.differs) << bounce;
  }
  EXPECT_TRUE(welch_test(layer_picture(path, 2).estimate(), layer_picture(other_numbers, 1).estimate(), family_level)
                  .image.differs);
  EXPECT_EQ(layer_picture(other_numbers, 2).image_mean, 0);
  // What lamps the camera sees is emission; what light samples find is never the environment of a closed room.
  const int emission = layer_number(plan, "technique_emission");
  EXPECT_EQ(layer_picture(path, emission).image_mean, layer_picture(path, 0).image_mean);
  EXPECT_EQ(layer_picture(path, layer_number(plan, "technique_environment")).image_mean, 0);
  EXPECT_EQ(layer_picture(naive, layer_number(plan, "technique_light-sampling")).image_mean, 0);
}

TEST(Layers, are_had_by_integrators_that_gather_light_along_paths_and_by_no_others) {
  const TestScene scene(lights_and_glass);
  for (const std::string& way : layered_ways) EXPECT_TRUE(scene.integrator(way).integrator->has_layers()) << way;
  for (const char* way : {"tracepath", "ao", "normal", "path:maxcomponent=3"}) {
    const ChosenIntegrator chosen = scene.integrator(way);
    EXPECT_FALSE(chosen.integrator->has_layers()) << way;
    EXPECT_THROW(chosen.integrator->trace_layers({}, {}, {}, {}), std::logic_error);
  }
}

}  // namespace

}  // namespace montelux::test
