#include "integrator/catalogue.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "integrator/direct/settings.h"
#include "integrator/restir/settings.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

const char* room = R"(Camera "perspective" WorldBegin LightSource "infinite" Shape "sphere")";

std::string failure_of(const TestScene& scene, const std::string& text) {
  try {
    scene.integrator(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(IntegratorCatalogue, makes_every_integrator_by_its_name_alone) {
  const TestScene scene(room);
  for (const EntitySpec& spec : integrator_catalogue()) EXPECT_EQ(scene.integrator(spec.name).name, spec.name);
}

TEST(IntegratorCatalogue, states_what_each_integrator_can_do) {
  const TestScene scene(room), fog(R"(Camera "perspective" WorldBegin LightSource "infinite"
MakeNamedMedium "fog" "string type" "homogeneous" MediumInterface "" "fog" Shape "sphere")");
  const auto can = [](Ability ability, std::string_view name) {
    return std::ranges::count(integrators_with(ability), name) > 0;
  };
  for (const EntitySpec& spec : integrator_catalogue()) {
    const ChosenIntegrator chosen = scene.integrator(spec.name);
    TilePass pass{{0, 0, 1, 1}, {PointSetKind::independent, 1, 0, 1}};
    pass.only = 0;
    EXPECT_EQ(can(Ability::layers, spec.name), chosen.any().has_layers()) << spec.name;
    EXPECT_EQ(can(Ability::paths, spec.name), chosen.integrator && chosen.integrator->trace_path(pass)) << spec.name;
    EXPECT_EQ(can(Ability::media, spec.name), failure_of(fog, std::string(spec.name)).empty()) << spec.name;
  }
  EXPECT_GT(integrators_with(Ability::layers).size(), 3u);
}

// A value of a setting that is not its default.
std::string value_of(const ParameterSpec& row) {
  const std::string name(row.name);
  if (name == "branching" || (name == "shadow-rays" && row.types.front() == ParameterType::string)) return "2/1";
  if (name == "roulette") return "proportional";
  if (name == "light-selection") return "power";
  if (name == "among") return "restir-di";
  if (row.types.front() == ParameterType::boolean) return row.meaning.ends_with("default off") ? "on" : "off";
  if (row.types.front() == ParameterType::string) return std::string(row.choices.front());
  return fmt::format("{}", std::clamp(row.types.front() == ParameterType::integer ? 3.0 : 0.75, row.low, row.high));
}

// What a setting needs beside it.
std::string companions(const EntitySpec& integrator, const ParameterSpec& row) {
  const std::string name(row.name);
  if (name == "guiding-paths") return ",guiding=on";
  if (name == "sky-paths") return ",sky-learning=on";
  if (name == "light-paths") return ",light-selection=learned";
  if (name == "manifold-roughness") return ",manifold=1";
  if (!integrator.name.starts_with("restir")) return "";
  if (name == "m-cap" || name == "warm-up" || name == "carry") return ",temporal=on";
  return "";
}

TEST(IntegratorCatalogue, reads_every_setting) {
  const TestScene empty(room), fog(R"(MakeNamedMedium "fog" "string type" "homogeneous" MediumInterface "" "fog"
)" + std::string(room));
  int count = 0;
  for (const EntitySpec& spec : integrator_catalogue())
    for (const ParameterSpec& row : spec.parameters) {
      const std::string text = fmt::format("{}:{}={}{}", spec.name, row.name, value_of(row), companions(spec, row));
      const bool of_media = row.name == "medium-radius";
      EXPECT_EQ(failure_of(of_media ? fog : empty, text), "") << text;
      if (of_media) {
        EXPECT_NE(failure_of(empty, text), "") << text;
      }
      ++count;
    }
  EXPECT_GT(count, 90);
}

TEST(IntegratorCatalogue, knows_settings_by_their_earlier_names) {
  const ChoiceText choice = with_present_names({"restir-di", {{"chain", "4"}, {"rounds", "2"}}});
  EXPECT_EQ(choice.settings, (std::vector<Setting>{{"frames", "4"}, {"rounds", "2"}}));
  EXPECT_EQ(with_present_names({"none", {{"chain", "4"}}}).settings, (std::vector<Setting>{{"chain", "4"}}));
  const TestScene scene(room);
  EXPECT_EQ(scene.integrator("restir-di:chain=4").coupled->frames(), 4);
}

TEST(IntegratorCatalogue, states_the_defaults_of_the_settings_themselves) {
  const auto meaning = [](std::string_view integrator, std::string_view setting) {
    for (const EntitySpec& spec : integrator_catalogue())
      if (spec.name == integrator) return find_parameter(spec, setting)->meaning;
    return std::string();
  };
  EXPECT_TRUE(meaning("path", "roulette-depth").ends_with("; default 2"));
  EXPECT_TRUE(meaning("tracepath", "roulette-depth").ends_with("; default 1"));
  EXPECT_TRUE(meaning("restir-di", "neighbours").ends_with("; default 15, without groups 5"));
  EXPECT_TRUE(meaning("restir-pt", "neighbours").ends_with("; default 7, without groups 4"));
  EXPECT_TRUE(meaning("restir-pt", "shift").ends_with("; default hybrid"));
  EXPECT_TRUE(meaning("restir-gi", "footprint").ends_with("; default 0.001"));
  EXPECT_TRUE(meaning("distribution", "branching").ends_with("; default 8/4/1"));
}

TEST(IntegratorCatalogue, makes_every_preset) {
  const TestScene scene(room);
  for (const DirectPreset& preset : direct_presets()) EXPECT_NO_THROW(scene.integrator(preset.integrator));
}

TEST(IntegratorCatalogue, names_the_nearest_of_what_it_does_not_know) {
  const TestScene scene(room);
  EXPECT_NE(failure_of(scene, "pth").find("did you mean \"path\""), std::string::npos);
  EXPECT_NE(failure_of(scene, "direct:strategy=riss").find("light-area, light-solid-angle"), std::string::npos);
  EXPECT_NE(failure_of(scene, "direct:shadowrays=2").find("did you mean \"shadow-rays\""), std::string::npos);
}

TEST(IntegratorCatalogue, says_how_lights_can_be_chosen) {
  const TestScene scene(room);
  EXPECT_EQ(failure_of(scene, "path:light-selection=ris:16"), "");
  EXPECT_NE(failure_of(scene, "path:light-selection=nearest").find("uniform, power, bvh, learned or ris:"),
            std::string::npos);
  for (const char* bad : {"ris:", "ris:0", "ris:x", "ris:1e9", "ris:-3"})
    EXPECT_NE(failure_of(scene, std::string("path:light-selection=") + bad).find("from 1 to 4096"), std::string::npos);
  EXPECT_NE(failure_of(scene, "path:light-selection=ris:8,nee=off").find("nee must be on"), std::string::npos);
  EXPECT_EQ(failure_of(scene, "path:light-selection=learned,light-paths=1024"), "");
  EXPECT_NE(failure_of(scene, "path:light-paths=4096").find("light-selection=learned"), std::string::npos);
  EXPECT_NE(failure_of(scene, "path:light-selection=learned,light-paths=10").find("1024"), std::string::npos);
}

TEST(IntegratorCatalogue, says_what_reuse_takes) {
  const TestScene scene(room);
  EXPECT_EQ(failure_of(scene,
                       "restir-di:candidates=32,neighbours=5,radius=30,rounds=1,temporal=on,m-cap=20,"
                       "weights=pairwise,visibility-reuse=off,frames=16"),
            "");
  EXPECT_NE(failure_of(scene, "restir-di:weights=biased").find("naive, unbiased, pairwise"), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-di:groups=on,weights=pairwise").find("needs groups=off"), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-di:neighbors=3").find("did you mean \"neighbours\""), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-di:weights=pairwse").find("did you mean \"pairwise\""), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-pt:shift=hybird").find("did you mean \"hybrid\""), std::string::npos);
  EXPECT_EQ(failure_of(scene, "restir-pt:shift=zzzzzzzz").find("did you mean"), std::string::npos);
  EXPECT_NE(failure_of(scene, "path:light-selection=bvhh").find("did you mean \"bvh\""), std::string::npos);
  EXPECT_NE(failure_of(scene, "path:roulette=thruput").find("did you mean \"throughput\""), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-di:neighbours=99").find("from 0 to 16"), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-di:frames=0").find("from 1 to 1024"), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-di:radius=0.5").find("from 1 to 4096"), std::string::npos);
  for (const char* idle : {"m-cap=5", "warm-up=3", "carry=on"})
    EXPECT_NE(failure_of(scene, std::string("restir-di:temporal=off,") + idle).find("needs temporal=on"),
              std::string::npos)
        << idle;
  EXPECT_NE(failure_of(scene, "restir-pt:warm-up=12").find("needs temporal=on"), std::string::npos);
  EXPECT_EQ(failure_of(scene, "restir-di:temporal=off,warm-up=0,carry=off"), "");
  for (const char* idle : {"rounds=0,radius=3", "neighbours=0,similar=off"})
    EXPECT_NE(failure_of(scene, std::string("restir-di:") + idle).find("one round and one neighbour"),
              std::string::npos)
        << idle;
  EXPECT_NE(failure_of(scene, "restir-di:candidates=0").find("must be at least 1"), std::string::npos);
  EXPECT_TRUE(scene.integrator("restir-di").biases.empty());
  EXPECT_EQ(scene.integrator("restir-di:weights=naive").biases, std::vector<std::string>{"weights=naive"});
  EXPECT_TRUE(scene.integrator("restir-di:weights=naive,temporal=off,rounds=0").biases.empty());
}

// Surfaces that are there for some rays only: what a ray has passed by chance must not be requested by chance again.
TEST(IntegratorCatalogue, takes_visibility_into_targets_where_surfaces_are_half_there) {
  const std::string ball = "Shape \"sphere\" \"float radius\" [ 0.1 ]";
  const TestScene whole(std::string(room) + ball + "\n"), half(std::string(room) + ball + " \"float alpha\" [ 0.5 ]\n");
  const auto is_reported = [](const TestScene& scene, const char* text) {
    return std::ranges::any_of(scene.integrator(text).notes, [](const std::string& note) {
      return note.find("visibility-reuse is on") != std::string::npos;
    });
  };
  EXPECT_TRUE(is_reported(half, "restir-di:visibility-reuse=off"));
  EXPECT_FALSE(is_reported(half, "restir-di:visibility-reuse=off,bsdf=off"));
  EXPECT_FALSE(is_reported(half, "restir-di"));
  EXPECT_FALSE(is_reported(whole, "restir-di:visibility-reuse=off"));
}

RestirSettings reuse_settings(const EntitySpec& spec, const std::string& settings) {
  const auto choice = parse_choice(std::string(spec.name) + settings);
  const auto list = read_settings(spec, choice.value().settings, "integrator");
  return restir_settings(spec.name, list.value(), {}).value();
}

TEST(IntegratorCatalogue, shares_in_groups_unless_weights_are_stated) {
  const RestirSettings groups = reuse_settings(restir_di_spec(), "");
  EXPECT_TRUE(groups.groups);
  EXPECT_EQ(groups.neighbours, 15);
  EXPECT_EQ(groups.radius, 2);
  for (const NamedReuseWeights& entry : reuse_weight_names) {
    const std::string stated = fmt::format(":weights={}", entry.name);
    // Neighbours are then those that do best without groups.
    const RestirSettings own = reuse_settings(restir_di_spec(), stated);
    EXPECT_FALSE(own.groups) << entry.name;
    EXPECT_EQ(own.weights, entry.weights) << entry.name;
    EXPECT_EQ(own.neighbours, 5) << entry.name;
    EXPECT_EQ(own.radius, 8) << entry.name;
    const RestirSettings paths = reuse_settings(restir_pt_spec(), stated);
    EXPECT_FALSE(paths.groups) << entry.name;
    EXPECT_EQ(paths.rounds, 2) << entry.name;
    EXPECT_FALSE(paths.similar) << entry.name;
  }
  EXPECT_FALSE(reuse_settings(restir_di_spec(), ":groups=off").groups);
  const RestirSettings both = reuse_settings(restir_di_spec(), ":groups=on,weights=generalised");
  EXPECT_TRUE(both.groups);
  EXPECT_EQ(both.weights, ReuseWeights::generalised);
  EXPECT_EQ(both.neighbours, 15);
}

// What lies beyond finding light in each frame: a stage for every round, and one for the picture where groups reach
// over tiles.
TEST(IntegratorCatalogue, makes_reuse_with_the_stages_that_it_needs) {
  const TestScene scene(room);
  const auto stages = [&](const char* text) { return scene.integrator(text).coupled->stages(); };
  EXPECT_EQ(stages("restir-di"), 3);
  EXPECT_EQ(stages("restir-di:groups=on,weights=generalised"), 3);
  EXPECT_EQ(stages("restir-di:weights=generalised"), 2);
  EXPECT_EQ(stages("restir-di:groups=off,rounds=3"), 4);
  EXPECT_EQ(stages("restir-pt"), 5);
  // Somebody must show what was found.
  EXPECT_EQ(stages("restir-di:rounds=0"), 2);
  EXPECT_EQ(stages("restir-di:rounds=0,groups=off"), 2);
}

TEST(IntegratorCatalogue, says_what_the_reuse_of_paths_takes) {
  const TestScene scene(room);
  EXPECT_EQ(failure_of(scene, "restir-gi:direct=off,footprint=0.01,radius=5"), "");
  EXPECT_EQ(failure_of(scene, "restir-pt:shift=replay,replayed=3"), "");
  EXPECT_EQ(failure_of(scene, "restir-pt:shift=reconnection"), "");
  EXPECT_NE(failure_of(scene, "restir-pt:shift=reconnection,replayed=3").find("needs shift=replay or shift=hybrid"),
            std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-pt:shift=replay,footprint=0.1").find("needs shift=reconnection or shift=hybrid"),
            std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-pt:shift=reply").find("reconnection, replay, hybrid"), std::string::npos);
  EXPECT_NE(failure_of(scene, "restir-gi:shift=replay"), "");
  EXPECT_NE(failure_of(scene, "restir-di:direct=off"), "");
  EXPECT_NE(failure_of(scene, "restir-pt:footprint=-1"), "");
  EXPECT_NE(failure_of(scene, "restir-pt:candidates=0").find("restir-pt needs candidates"), std::string::npos);
  EXPECT_EQ(scene.integrator("restir-gi:weights=naive").biases, std::vector<std::string>{"weights=naive"});
}

TEST(IntegratorCatalogue, refuses_a_tree_that_never_ends) {
  const TestScene scene(room);
  EXPECT_NE(failure_of(scene, "distribution:branching=4/2").find("never ends"), std::string::npos);
  EXPECT_EQ(failure_of(scene, "distribution:branching=4/2,maxdepth=3"), "");
  for (const char* text : {"", "0", "4/", "4/x", "-1/1", "1/5000"})
    EXPECT_NE(failure_of(scene, std::string("distribution:branching=") + text), "") << text;
}

TEST(IntegratorCatalogue, records_what_is_biased) {
  const TestScene scene(room);
  EXPECT_TRUE(scene.integrator("path").biases.empty());
  EXPECT_EQ(scene.integrator("path:maxdepth=3").biases, std::vector<std::string>{"maxdepth=3"});
  EXPECT_EQ(scene.integrator("tracepath:maxcomponent=2").biases, std::vector<std::string>{"maxcomponent=2"});
  EXPECT_EQ(scene.integrator("ao").biases, std::vector<std::string>{"no picture of light"});
}

}  // namespace
}  // namespace montelux::test
