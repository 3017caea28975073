// One scene for each class of paths L(S|D)*E: every integrator finds the closed form, or nothing at all where its paths
// are not of this class. scenes/path-classes/expected.json says which; docs/integrators.md has the table.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {
namespace {

const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/path-classes";
constexpr int passes = 32, samples_per_pass = 48;
constexpr double rounding = 1e-5;
const std::vector<std::string> ways{"path", "naive", "distribution:branching=1", "tracepath", "direct"};

struct PathClass {
  std::string scene, paths, formula;
  double value = 0;
  std::set<std::string> found_by;
};
void PrintTo(const PathClass& c, std::ostream* out) { *out << c.paths; }

const std::vector<PathClass>& classes() {
  static const std::vector<PathClass> all = [] {
    std::vector<PathClass> read;
    for (const nlohmann::json& e : nlohmann::json::parse(read_text(folder / "expected.json")))
      read.push_back({e.at("scene"), e.at("class"), e.at("formula"), e.at("value").get<double>(),
                      e.at("found_by").get<std::set<std::string>>()});
    return read;
  }();
  return all;
}
double level() { return sidak_level(family_level, double(classes().size() * ways.size())); }

struct Measured {
  double mean = 0, standard_error = 0;
};
Measured measure(const TestScene& scene, const std::string& way, int per_pass = samples_per_pass) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  const Film film =
      render(*chosen.integrator, scene.settings(PointSetKind::independent, {per_pass, passes}, 3), silent).film;
  EXPECT_EQ(film.non_finite(), 0u) << way;
  return {film.image().mean[0], film.image().standard_error[0]};
}
bool agrees(const Measured& m, double value) {
  const double distance = std::max(0.0, std::abs(m.mean - value) - rounding * value);
  if (distance == 0) return true;
  return m.standard_error > 0 && 2 * student_t_cdf(-distance / m.standard_error, passes - 1) >= level();
}

class PathClasses : public testing::TestWithParam<PathClass> {};

TEST_P(PathClasses, are_found_by_those_whose_paths_they_are_and_by_nobody_else) {
  const PathClass& c = GetParam();
  const TestScene scene(read_text(folder / c.scene), folder.string());
  for (const std::string& way : ways) {
    const Measured m = measure(scene, way);
    if (!c.found_by.contains(way.substr(0, way.find(':')))) {
      EXPECT_EQ(m.mean, 0) << way;
      continue;
    }
    EXPECT_TRUE(agrees(m, c.value)) << way << ": " << m.mean << " +- " << m.standard_error << " where " << c.formula
                                    << " = " << c.value;
    const double fault = way == "path" ? 1.2 : 1.3;
    EXPECT_FALSE(agrees(m, fault * c.value)) << way << " would pass with " << 100 * (fault - 1) << " % more";
  }
}

std::string test_name(const testing::TestParamInfo<PathClass>& c) {
  std::string name = std::filesystem::path(c.param.scene).stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Scenes, PathClasses, testing::ValuesIn(classes()), test_name);

// What nobody finds is there: a lamp of the same intensity instead of the point is met by chance.
TEST(PathClassesOfPoints, have_the_light_that_a_small_lamp_in_their_place_brings) {
  const std::string text = replaced(
      read_text(folder / "lsde-point.pbrt"), "LightSource \"point\" \"rgb I\" [ 3 3 3 ] \"point3 from\" [ 0.25 1 0 ]\n",
      "AttributeBegin\nTranslate 0.25 1 0\nAreaLightSource \"diffuse\" \"rgb L\" [ 381.9719 381.9719 381.9719 ]\n"
      "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\nShape \"sphere\" \"float radius\" [ 0.05 ]\n"
      "AttributeEnd\n");
  const TestScene scene(text, folder.string());
  for (const PathClass& c : classes())
    if (c.scene == "lsde-point.pbrt") {
      const Measured m = measure(scene, "path", 512);
      EXPECT_TRUE(agrees(m, c.value)) << m.mean << " +- " << m.standard_error << " for " << c.value;
      EXPECT_FALSE(agrees(m, 0));
      EXPECT_FALSE(agrees(m, 1.5 * c.value));
    }
}

TEST(PathClassesOfFolder, all_have_an_expected_mean) {
  std::set<std::string> stated, found;
  for (const PathClass& c : classes()) stated.insert(c.scene);
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".pbrt") found.insert(entry.path().filename().string());
  EXPECT_EQ(stated, found);
}

}  // namespace
}  // namespace montelux::test
