// Every integrator of light finds the closed forms of scenes/analytic, and they agree with each other in a closed room.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
constexpr int passes = 32;
constexpr double rounding = 1e-5;

struct Expected {
  std::string scene;
  double value = 0;
};

std::vector<Expected> expected_means() {
  std::vector<Expected> all;
  for (const nlohmann::json& e : nlohmann::json::parse(read_text(folder / "expected.json")))
    all.push_back({e.at("scene"), e.at("value").get<double>()});
  return all;
}

// Scenes with direct light only: rough surfaces that see the lamp or the sky, and nothing else.
const std::vector<std::string> direct_scenes{
    "alpha-shadow.pbrt",       "cylinder-around.pbrt",      "disk-light-aside.pbrt",       "disk-light-axis.pbrt",
    "distant-light.pbrt",      "goniometric-light.pbrt",    "instance-shadow.pbrt",        "kinds-of-lights.pbrt",
    "point-light.pbrt",        "many-point-lights.pbrt",    "one-sided-light.pbrt",        "projection-light.pbrt",
    "rectangle-light.pbrt",    "rectangle-light-near.pbrt", "rectangle-light-tilted.pbrt", "sky-two-tone.pbrt",
    "rough-metal-45.pbrt",     "sky-two-tone-tilted.pbrt",  "sphere-light.pbrt",           "sphere-light-near.pbrt",
    "spot-light-core.pbrt",    "triangle-light.pbrt",       "triangle-light-far.pbrt",     "translucent-sheet.pbrt",
    "mixed-sheet-shadow.pbrt", "mixed-sheet-in-place.pbrt", "half-open-ball.pbrt",         "sphere-light-inside.pbrt",
    "one-sided-sheets.pbrt"};
const std::vector<std::string> direct_ways{
    "direct:strategy=light-area",
    "direct:strategy=light-solid-angle",
    "direct:strategy=uniform",
    "direct:strategy=cosine",
    "direct:strategy=bsdf",
    "direct:strategy=mis",
    "direct:strategy=mis,mis=balance,shadow-rays=3",
    "direct:strategy=mis,mis=maximum",
    "direct:strategy=mis,mis=cutoff",
    "direct:strategy=ris,candidates=4",
    "direct:strategy=light-area,shadow-rays=9,pattern=stratified",
    "direct:strategy=cosine,shadow-rays=8,pattern=sobol",
    "direct:strategy=light-solid-angle,shadow-rays=4,pattern=random",
};
const std::vector<std::string> full_ways{"distribution:branching=2/1,shadow-rays=1",
                                         "distribution:branching=1,shadow-rays=0",
                                         "tracepath",
                                         "naive",
                                         "path:nee=off,roulette=proportional",
                                         "path:mis=off,light-selection=uniform",
                                         "path:mis=balance,light-selection=power,roulette=fixed:0.6",
                                         "path:roulette=fixed:0.4,roulette-depth=0",
                                         "path:roulette=efficiency",
                                         "naive:roulette=efficiency,roulette-depth=0",
                                         "path:light-selection=ris:5",
                                         "path:guiding=on,guiding-paths=4096",
                                         "path:guiding=on,guiding-paths=4096,mis=balance,light-selection=ris:3",
                                         "path:sky-learning=on,sky-paths=4096",
                                         "path:sky-learning=on,sky-paths=4096,mis=balance,light-selection=ris:3",
                                         "path:light-selection=learned,light-paths=4096",
                                         "path:light-selection=learned,light-paths=4096,mis=balance,sky-learning=on,"
                                         "sky-paths=4096",
                                         "path:light-selection=ris:3,mis=off",
                                         "tracepath:p-emit=0.5,roulette-depth=0",
                                         "bdpt",
                                         "bdpt:mis=balance,roulette-depth=0",
                                         "metropolis",
                                         "metropolis:large-step=0.9,bootstrap=2,roulette-depth=0",
                                         "metropolis:strategies=bdpt",
                                         "metropolis:strategies=bdpt,large-step=0.8,roulette-depth=0",
                                         "restir-di:radius=3",
                                         "restir-di:weights=pairwise,radius=3",
                                         "restir-di:weights=unbiased,temporal=off,rounds=2,radius=2,power-candidates=2",
                                         "restir-di:weights=generalised,visibility-reuse=on,candidates=2,radius=2",
                                         "restir-di:groups=off,bsdf=off,temporal=off,neighbours=2,radius=2",
                                         "restir-di:visibility-reuse=off,temporal=off,rounds=0,candidates=1",
                                         "restir-gi:radius=3,neighbours=2",
                                         "restir-pt:radius=2,neighbours=3,footprint=0.1",
                                         "restir-pt:shift=replay,weights=generalised,neighbours=1,radius=2"};

struct Measured {
  double mean = 0, standard_error = 0;
  std::uint64_t non_finite = 0;
};

Measured measure(const TestScene& scene, const std::string& way, int samples_per_pass, std::uint32_t seed = 3) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  const RenderResult result =
      render(chosen.any(), scene.settings(PointSetKind::independent, {samples_per_pass, passes}, seed), silent);
  const ImageEstimate image = result.film.image();
  return {image.mean[0], image.standard_error[0], result.film.non_finite()};
}

bool agrees(const Measured& m, double value, double level) {
  const double distance = std::max(0.0, std::abs(m.mean - value) - rounding * std::abs(value));
  if (distance == 0) return true;
  return m.standard_error > 0 && 2 * student_t_cdf(-distance / m.standard_error, passes - 1) >= level;
}

// 1/Z weights have tails so long that the spread of a few passes says nothing: with frames that reuse those
// before, in coated furnaces (in these the standard error of a render grows with its samples), and in the corner of two
// squares. Their mean is right over thousands (tests/estimator/integrator and tests/full/restir hold these weights).
bool has_an_error(const std::string& way, const std::string& scene) {
  return way.find("weights=unbiased") == std::string::npos || scene != "corner-squares.pbrt";
}

// Holds every way against the closed form of every scene. Each way would be detected, in most of the scenes, if its
// means were a tenth too large or too small.
void hold_to_closed_forms(const std::vector<Expected>& scenes, const std::vector<std::string>& ways, int samples) {
  const double level = sidak_level(family_level, double(scenes.size() * ways.size()));
  std::map<std::string, int> caught, tests;
  for (const Expected& e : scenes) {
    const TestScene scene(read_text(folder / e.scene), folder.string());
    for (const std::string& way : ways) {
      if (!has_an_error(way, e.scene)) continue;
      const Measured m = measure(scene, way, samples);
      EXPECT_TRUE(agrees(m, e.value, level))
          << way << " in " << e.scene << ": " << m.mean << " +- " << m.standard_error << " where " << e.value
          << " is right (" << (m.mean - e.value) / m.standard_error << " standard errors)";
      EXPECT_EQ(m.non_finite, 0u) << way << " in " << e.scene;
      for (const double fault : {0.9, 1.1}) caught[way] += !agrees(m, e.value * fault, level), ++tests[way];
    }
  }
  for (const auto& [way, count] : tests) EXPECT_GT(caught[way], 0.6 * count) << way;
}

TEST(DirectStrategies, find_the_closed_forms_of_scenes_with_direct_light_alone) {
  std::vector<Expected> scenes;
  for (const Expected& e : expected_means())
    if (std::ranges::find(direct_scenes, e.scene) != direct_scenes.end()) scenes.push_back(e);
  EXPECT_EQ(scenes.size(), direct_scenes.size());
  hold_to_closed_forms(scenes, direct_ways, 16);
}

TEST(FullIntegrators, find_the_closed_form_of_every_scene) { hold_to_closed_forms(expected_means(), full_ways, 16); }

// What light finds is right, in every scene of which it names nothing as missing. Where the camera looks at so little
// that hardly a path arrives there is nothing to test.
TEST(LightTracing, finds_the_closed_form_of_every_scene_that_it_sees_whole) {
  const std::vector<Expected> scenes = expected_means();
  const double level = sidak_level(family_level, double(scenes.size()));
  int tested = 0, caught = 0;
  for (const Expected& e : scenes) {
    const TestScene scene(read_text(folder / e.scene), folder.string());
    ChosenIntegrator chosen = scene.integrator("light");
    const bool biased = !chosen.biases.empty() && chosen.biases.front().find("maxdepth") == std::string::npos;
    note_missing_light(chosen, {{}, {}, scene.picture().width, scene.picture().height}, scene.scene(), scene.accel());
    if (!chosen.missing.empty() || biased) continue;
    const Measured m = measure(scene, "light", 64);
    EXPECT_EQ(m.non_finite, 0u) << e.scene;
    if (e.value != 0 && !(m.standard_error > 0 && m.standard_error < 0.05 * e.value)) continue;
    SCOPED_TRACE(e.scene);
    EXPECT_TRUE(agrees(m, e.value, level))
        << e.scene << ": " << m.mean << " +- " << m.standard_error << " where " << e.value << " is right ("
        << (m.mean - e.value) / m.standard_error << " standard errors)";
    ++tested, caught += !agrees(m, 0.9 * e.value, level) + !agrees(m, 1.1 * e.value, level);
  }
  EXPECT_GT(tested, 15);
  EXPECT_GT(caught, 1.2 * tested);
}

// Likewise photons, in scenes where enough of them arrive; with a radius so small that its bias is below the noise.
TEST(Photons, find_the_closed_form_of_every_scene_where_enough_of_them_arrive) {
  for (const std::string way :
       {"sppm:radius=0.02,alpha=1", "vcm:radius=0.02,alpha=1", "photonmap:radius=0.02,caustic-radius=0.02"}) {
    const std::vector<Expected> scenes = expected_means();
    const double level = sidak_level(family_level, double(scenes.size()));
    int tested = 0, caught = 0;
    for (const Expected& e : scenes) {
      const TestScene scene(read_text(folder / e.scene), folder.string());
      const ChosenIntegrator chosen = scene.integrator(way);
      if (!chosen.missing.empty()) continue;
      const Measured m = measure(scene, way, 2);
      EXPECT_EQ(m.non_finite, 0u) << way << " in " << e.scene;
      const bool arrives = m.standard_error < 0.05 * e.value && (m.standard_error > 0 || m.mean > 0);
      if (e.value != 0 && !arrives) continue;
      EXPECT_TRUE(agrees(m, e.value, level))
          << way << " in " << e.scene << ": " << m.mean << " +- " << m.standard_error << " where " << e.value
          << " is right (" << (m.mean - e.value) / m.standard_error << " standard errors)";
      ++tested, caught += !agrees(m, 0.9 * e.value, level) + !agrees(m, 1.1 * e.value, level);
    }
    EXPECT_GT(tested, 50);
    EXPECT_GT(caught, 1.2 * tested);
  }
}

// Likewise interpolated irradiance, where nothing moves: where it changes over a surface it is interpolated so closely
// that the bias is below the noise.
TEST(IrradianceCache, finds_the_closed_form_of_every_scene_without_motion) {
  const std::vector<Expected> scenes = expected_means();
  const double level = sidak_level(family_level, double(scenes.size()));
  const std::string way = "irradiance-cache:accuracy=0.05,samples=64";
  int tested = 0, caught = 0;
  for (const Expected& e : scenes) {
    const TestScene scene(read_text(folder / e.scene), folder.string());
    if (scene.scene().geometry.moves()) {
      EXPECT_THROW(scene.integrator(way), std::runtime_error) << e.scene;
      continue;
    }
    const Measured m = measure(scene, way, 16);
    EXPECT_EQ(m.non_finite, 0u) << e.scene;
    EXPECT_TRUE(agrees(m, e.value, level))
        << e.scene << ": " << m.mean << " +- " << m.standard_error << " where " << e.value << " is right ("
        << (m.mean - e.value) / m.standard_error << " standard errors)";
    ++tested, caught += !agrees(m, 0.9 * e.value, level) + !agrees(m, 1.1 * e.value, level);
  }
  EXPECT_GT(tested, 60);
  EXPECT_GT(caught, 1.2 * tested);
}

TEST(DirectStrategies, with_fixed_shadow_rays_are_biased_and_say_so) {
  const TestScene scene(read_text(folder / "rectangle-light-near.pbrt"), folder.string());
  EXPECT_EQ(scene.integrator("direct:pattern=fixed").biases,
            (std::vector<std::string>{"direct light only", "fixed shadow rays"}));
  double value = 0;
  for (const Expected& e : expected_means())
    if (e.scene == "rectangle-light-near.pbrt") value = e.value;
  EXPECT_FALSE(agrees(measure(scene, "direct:strategy=light-area,pattern=fixed", 16), value, family_level));
}

// Three quarters of the lamp are holes: a quarter of the light is left, and not what sampling the lamp without regard
// to its holes would find.
TEST(FullIntegrators, find_emitters_with_holes_as_bright_as_they_are) {
  std::string text = read_text(folder / "rectangle-light.pbrt");
  const std::string lamp = "Shape \"trianglemesh\"";
  ASSERT_NE(text.find(lamp), std::string::npos);
  text.insert(text.find(lamp) + lamp.size(), " \"float alpha\" [ 0.25 ]");
  const TestScene scene(text, folder.string());
  double whole = 0;
  for (const Expected& e : expected_means())
    if (e.scene == "rectangle-light.pbrt") whole = e.value;
  const double level = sidak_level(family_level, double(full_ways.size()));
  for (const std::string& way : full_ways) {
    // It leaves them to nobody, and says so.
    if (way.find("bsdf=off") != std::string::npos) {
      EXPECT_EQ(scene.integrator(way).biases, std::vector<std::string>{"bsdf=off with masked emitters"});
      continue;
    }
    EXPECT_TRUE(scene.integrator(way).biases.empty()) << way;
    const Measured m = measure(scene, way, 64);
    EXPECT_TRUE(agrees(m, 0.25 * whole, level)) << way << ": " << m.mean << " +- " << m.standard_error;
    EXPECT_FALSE(agrees(m, whole, level)) << way;
    EXPECT_FALSE(agrees(m, 0.5 * whole, level)) << way;
  }
}

// A closed room with a lamp, a mirror-like ball and a glass ball: the whole transport, and no closed form.
TEST(FullIntegrators, agree_pairwise_in_a_closed_room) {
  const std::filesystem::path room = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/first-light";
  const TestScene scene(read_text(room / "first-light.pbrt"), room.string(), std::pair(24, 18));
  std::vector<std::string> ways = full_ways;
  ways.push_back("path");
  std::vector<Measured> means;
  // With seeds of their own: by one seed all would share their camera rays.
  for (const std::string& way : ways) means.push_back(measure(scene, way, 4, std::uint32_t(means.size())));
  const double level = sidak_level(0.01, double(ways.size() * (ways.size() - 1)) / 2);
  const auto differ = [&](const Measured& a, const Measured& b) {
    return welch_test({a.mean, a.standard_error * a.standard_error * passes, passes},
                      {b.mean, b.standard_error * b.standard_error * passes, passes})
               .p_value < level;
  };
  for (std::size_t i = 0; i < ways.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(differ(means[i], means[j]))
          << ways[i] << " " << means[i].mean << " +- " << means[i].standard_error << ", " << ways[j] << " "
          << means[j].mean << " +- " << means[j].standard_error;
  // The light of the first scattering event alone is another picture.
  EXPECT_TRUE(differ(measure(scene, "direct", 4), means.back()));
}

TEST(Distribution, counts_its_rays_by_depth) {
  const TestScene scene(read_text(folder / "closed-furnace-box.pbrt"), folder.string());
  const ChosenIntegrator chosen = scene.integrator("distribution:branching=3/2,maxdepth=3");
  RenderObserver silent;
  const RayCounts rays = render(chosen.any(), scene.settings(PointSetKind::independent, {1, 2}, 3), silent).rays;
  // Nothing leaves a closed box, so the tree is complete.
  EXPECT_EQ(rays.by_depth[1], 3 * rays.by_depth[0]);
  EXPECT_EQ(rays.by_depth[2], 6 * rays.by_depth[0]);
  EXPECT_EQ(rays.by_depth[3], 12 * rays.by_depth[0]);
  EXPECT_EQ(rays.by_depth[4], 0u);
}

}  // namespace

}  // namespace montelux::test
