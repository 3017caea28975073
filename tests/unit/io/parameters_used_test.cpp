// Every parameter that the tables accept is used, or a warning at its place says that it is not.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "api/render.h"
#include "io/checks.h"
#include "io/pbrt.h"
#include "io/pbrt/parameters.h"
#include "io/pbrt/picture.h"
#include "io/read_model.h"
#include "light/table.h"
#include "material/table.h"
#include "mc/point_set.h"
#include "parameter_scenes.h"
#include "scene/prepare.h"
#include "temporary_folder.h"

namespace montelux::test {

namespace {

// What was said of the third line.
struct Said {
  bool ready = false, no_effect = false, of_no_effect_elsewhere = false;
  std::string all;
};

Said say(const std::string& text, const std::string& folder) {
  ReadResult read = read_pbrt_text(text, folder);
  Said said;
  if (read.scene) said.ready = prepare(*read.scene, {}, read.diagnostics).has_value();
  for (const Diagnostic& d : read.diagnostics.all()) {
    said.all += std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + " " + d.message + "\n";
    const bool no_effect = d.message.find("has no effect") != std::string::npos;
    const bool here = d.where.line == 3 && d.where.column == 1;
    said.no_effect |= no_effect && here, said.of_no_effect_elsewhere |= no_effect && !here;
  }
  return said;
}

class Parameters : public testing::TestWithParam<Family> {};

TEST_P(Parameters, are_used_or_warned_of) {
  TemporaryFolder folder;
  write_files(folder);
  const Family family = GetParam();
  int count = 0;
  for (const EntitySpec& entity : table_of(family)) {
    if (entity.later) continue;  // refused as a whole
    for (const ParameterSpec& spec : entity.parameters)
      for (const ParameterType type : spec.types) {
        // Some textures are of numbers or of spectra alone.
        Said said;
        for (bool spectra : {false, true})
          if (!said.ready || said.no_effect)
            said = say(scene_text(family, entity,
                                  entity_text(family, entity, spec, type_text(type),
                                              value_of(std::string(entity.name), spec, type, spectra)),
                                  spectra),
                       folder.path());
        ++count;
        EXPECT_TRUE(said.ready) << entity.name << " " << spec.name << ":\n" << said.all;
        EXPECT_EQ(said.no_effect, spec.later) << entity.name << " " << spec.name << ":\n" << said.all;
        EXPECT_FALSE(said.of_no_effect_elsewhere) << entity.name << " " << spec.name << ":\n" << said.all;
      }
  }
  EXPECT_GE(count, 2);
}

// A default that the meaning of a row states, as a file states it: type and value. Nothing for "default none" and the
// like.
std::optional<std::pair<std::string, std::string>> stated_default(const ParameterSpec& spec, bool spectra) {
  static const std::regex pattern("default (\\S+?(?: [-0-9.]+)*)(?:$|[;,)]| \\()");
  std::smatch match;
  if (!std::regex_search(spec.meaning, match, pattern)) return std::nullopt;
  const std::string value = match[1];
  static const std::regex numbers("[-0-9.e]+( [-0-9.e]+)*");
  const bool is_numbers = std::regex_match(value, numbers);
  const auto takes = [&](ParameterType type) { return std::ranges::find(spec.types, type) != spec.types.end(); };
  const std::size_t count = std::size_t(std::ranges::count(value, ' ')) + 1;
  if (takes(ParameterType::boolean) && (value == "true" || value == "false")) return std::pair{"bool", value};
  if (takes(ParameterType::string) && std::ranges::find(spec.choices, value) != spec.choices.end())
    return std::pair{"string", "\"" + value + "\""};
  const bool is_spectrum = takes(ParameterType::spectrum) && (spectra || !takes(ParameterType::number));
  if (is_spectrum && value.starts_with("metal-")) return std::pair{"spectrum", "\"" + value + "\""};
  if (!is_numbers) return std::nullopt;
  if (is_spectrum) return std::pair{"rgb", "[ " + (count == 3 ? value : value + " " + value + " " + value) + " ]"};
  return std::pair{type_text(spec.types.front()), "[ " + value + " ]"};
}

TEST_P(Parameters, have_the_defaults_that_the_tables_state) {
  TemporaryFolder folder;
  write_files(folder);
  const Family family = GetParam();
  int tried = 0, seen = 0;
  for (const EntitySpec& entity : table_of(family)) {
    if (entity.later) continue;
    for (const ParameterSpec& spec : entity.parameters)
      for (bool spectra : {false, true}) {
        const auto stated = stated_default(spec, spectra);
        if (spec.later || !stated || (spectra && family != Family::texture)) continue;
        const auto picture = [&](const std::string& value) {
          return picture_of(
              folder, scene_text(family, entity, entity_text(family, entity, spec, stated->first, value), spectra));
        };
        const std::vector<float> without = picture("");
        if (without.empty()) continue;  // a texture of the other kind
        EXPECT_TRUE(picture(stated->second) == without) << entity.name << " " << spec.name << " " << stated->second;
        ++tried;
        // The twin: most other values make another picture, so that another default would be found.
        const bool has_own_type = stated->first == type_text(spec.types.front());
        if (has_own_type)
          seen += picture(value_of(std::string(entity.name), spec, spec.types.front(), spectra)) != without;
      }
  }
  if (family == Family::material || family == Family::texture || family == Family::light || family == Family::shape) {
    EXPECT_GE(tried, 15);
    EXPECT_GE(seen, tried / 3) << tried;
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheTables, Parameters,
                         testing::Values(Family::material, Family::texture, Family::light, Family::area_light,
                                         Family::shape, Family::camera, Family::filter, Family::film, Family::sampler,
                                         Family::integrator, Family::accelerator, Family::medium, Family::option),
                         [](const auto& family) {
                           std::string name(name_of(family.param));
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

// The planted fault: a table takes a parameter that nothing reads.
TEST(Parameter, that_nothing_reads_is_reported) {
  ReadResult read = read_pbrt_text("WorldBegin Shape \"sphere\" LightSource \"point\"", ".");
  ASSERT_TRUE(read.scene);
  const SourceLocation where{std::make_shared<const std::string>("room.pbrt"), 7, 9};
  const Parameter planted{"grain", ParameterType::number, std::vector<float>{1}, where};
  SceneDesc& scene = *read.scene;
  const auto expect_one = [](const Diagnostics& said, const std::string& owner) {
    ASSERT_EQ(said.all().size(), 1u) << owner;
    EXPECT_EQ(said.all()[0].where.line, 7);
    EXPECT_EQ(said.all()[0].where.column, 9);
    EXPECT_NE(said.all()[0].message.find("'grain' of " + owner), std::string::npos) << said.all()[0].message;
  };
  for (const EntitySpec& spec : material_models().specs()) {
    Diagnostics said;
    Reporter report(said, false);
    Entity stated{std::string(spec.name), {}, where};
    stated.parameters.add(planted);
    // Once, however many materials it is copied to.
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(read_model(material_models(), Family::material, stated, report));
    expect_one(said, "material '" + stated.type + "'");
  }
  {
    Diagnostics said;
    Reporter report(said, false);
    Entity lamp{"point", {}, where};
    lamp.parameters.add(planted);
    ASSERT_TRUE(read_model(light_models(), Family::light, lamp, report));
    expect_one(said, "light 'point'");
    // A default that several lights share is reported once.
    ASSERT_TRUE(read_model(light_models(), Family::light, Entity(lamp), report));
    expect_one(said, "light 'point'");
  }
  // The words of a file that are read into the description.
  for (const char* owner : {"sampler 'zsobol'", "Option"}) {
    pbrt::StatedPicture picture;
    (owner == std::string("Option") ? picture.options : picture.sampler.parameters).add(planted);
    Diagnostics said;
    Reporter report(said, false);
    pbrt::describe_picture(picture, scene, report);
    expect_one(said, owner);
  }
}

// A parameter that has an effect only with another one.
TEST(Parameter, that_has_an_effect_only_in_a_case_is_reported_in_the_others) {
  const auto warnings = [](const std::string& parameters) {
    const ReadResult read =
        read_pbrt_text("WorldBegin AreaLightSource \"diffuse\" " + parameters + " Shape \"sphere\"", ".");
    std::string all;
    for (const Diagnostic& d : read.diagnostics.all()) all += d.message + "\n";
    return all;
  };
  EXPECT_EQ(warnings("\"rgb tint\" [ 1 2 3 ]"), "'tint' of area light 'diffuse' has no effect here\n");
  EXPECT_EQ(warnings("\"rgb L\" [ 1 2 3 ]"), "");
}

// The picture's settings of a text before WorldBegin, and what was said.
struct Taken {
  PictureSettings picture;
  std::string said;
};
Taken taken(const std::string& options) {
  ReadResult read = read_pbrt_text(options + " WorldBegin Shape \"sphere\" LightSource \"point\"", ".");
  EXPECT_TRUE(read.scene);
  Diagnostics said;
  std::optional<PreparedScene> prepared = prepare(*read.scene, {}, said);
  EXPECT_TRUE(prepared);
  Taken t{prepared->picture, ""};
  Diagnostics all = read.diagnostics;
  for (const Diagnostic& d : said.all()) all.add(d);
  for (const Diagnostic& d : all.all())
    t.said += std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + " " + d.message + "\n";
  return t;
}

TEST(Sampler, without_jitter_takes_the_centres_of_the_strata) {
  const auto strata = [](int x, int y, const char* jitter) {
    return taken("Sampler \"stratified\" \"integer xsamples\" " + std::to_string(x) + " \"integer ysamples\" " +
                 std::to_string(y) + "\n \"bool jitter\" " + jitter);
  };
  EXPECT_EQ(strata(4, 4, "true").picture.sampler, PointSetKind::stratified);
  for (const auto& [x, y] : {std::pair{4, 4}, {2, 3}}) {
    const Taken without = strata(x, y, "false");
    EXPECT_EQ(without.said, "");
    ASSERT_EQ(without.picture.sampler, PointSetKind::uniform_grid);
    // The points of a pixel are the centres of x columns and y rows.
    std::set<std::pair<int, int>> cells;
    for (int i = 0; i < x * y; ++i) {
      const Sampler<float> points({without.picture.sampler, 0, 0, std::uint32_t(x * y)}, 5, 6, std::uint32_t(i));
      const Vec2f u = points.get2(0u);
      const float column = u.x * float(x) - 0.5f, row = u.y * float(y) - 0.5f;
      EXPECT_NEAR(column, std::round(column), 1e-5f);
      EXPECT_NEAR(row, std::round(row), 1e-5f);
      cells.insert({int(std::round(column)), int(std::round(row))});
    }
    EXPECT_EQ(cells.size(), std::size_t(x * y));
  }
  EXPECT_EQ(
      strata(8, 2, "false").said,
      "2:2 8 x 2 strata without jitter: the 16 samples are at the centres of a grid with 4 columns instead of 8\n");
}

TEST(Sampler, that_would_leave_no_error_bar_is_warned_of) {
  for (const char* good : {"owen", "fastowen"})
    EXPECT_EQ(taken("Sampler \"halton\" \"string randomization\" \"" + std::string(good) + "\"").said, "");
  for (const char* other : {"none", "permutedigits"})
    EXPECT_EQ(taken("Sampler \"sobol\" \"string randomization\" \"" + std::string(other) + "\"")
                  .said.find("1:17 points are scrambled"),
              0u);
}

TEST(Seed, is_that_of_the_sampler_or_of_the_options) {
  EXPECT_EQ(taken("").picture.seed, 0u);
  EXPECT_EQ(taken("Option \"integer seed\" 5").picture.seed, 5u);
  EXPECT_EQ(taken("Option \"integer seed\" 5 Sampler \"halton\" \"integer seed\" 6").picture.seed, 6u);
}

TEST(SceneIntegrator, has_ours_with_its_own_settings) {
  EXPECT_EQ(taken("Integrator \"ao\"").picture.integrator, "ao");
  EXPECT_EQ(
      taken("Integrator \"ambientocclusion\" \"float maxdistance\" 2.5 \"bool cossample\" false").picture.integrator,
      "ao:distance=2.5,cossample=off");
  EXPECT_EQ(taken("Integrator \"volpath\"").picture.integrator, "path");
  EXPECT_EQ(taken("Integrator \"bdpt\"").picture.integrator, "bdpt");
  EXPECT_EQ(taken("Integrator \"sppm\"").picture.integrator, "sppm");
  EXPECT_EQ(taken("Integrator \"sppm\" \"integer photonsperiteration\" -1").picture.integrator, "sppm");
  const auto photons = taken(
      "Integrator \"sppm\" \"integer photonsperiteration\" 5000 \"float radius\" 0.25 "
      "\"integer maxdepth\" 7 \"integer seed\" 9");
  EXPECT_EQ(photons.said, "");
  EXPECT_EQ(photons.picture.integrator, "sppm:photons=5000,radius=0.25");
  EXPECT_EQ(photons.picture.max_depth, 7);
  EXPECT_EQ(photons.picture.seed, 9u);
  EXPECT_EQ(taken("Integrator \"simplepath\" \"bool samplelights\" false").picture.integrator, "naive");
  EXPECT_EQ(taken("Integrator \"simplepath\" \"bool samplelights\" true").picture.integrator, "path");
}

TEST(Film, states_the_picture_to_write) {
  EXPECT_EQ(taken("Film \"rgb\"").picture.file, "");
  EXPECT_EQ(taken("Film \"rgb\" \"string filename\" \"a/b.exr\"").picture.file, "a/b.exr");
}

}  // namespace

}  // namespace montelux::test
