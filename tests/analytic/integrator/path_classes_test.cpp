// One scene for each class of paths L(S|D)*E: every integrator finds the closed form, or nothing at all where its paths
// are not of this class. scenes/path-classes/expected.json says which; docs/integrators.md has the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "colour_means.h"
#include "integrator/missing_light.h"
#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {
namespace {

const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/path-classes";
constexpr int samples_per_pass = 48;
constexpr double rounding = 1e-5;
const std::vector<std::string> ways{"path",
                                    "path:manifold=2",
                                    "naive",
                                    "distribution:branching=1",
                                    "tracepath",
                                    "direct",
                                    "restir-di",
                                    "restir-gi",
                                    "restir-pt",
                                    "light",
                                    "bdpt",
                                    "sppm",
                                    "photonmap",
                                    "photonmap:gather-rays=0",
                                    "vcm",
                                    "metropolis:bootstrap=64",
                                    "metropolis:strategies=bdpt,bootstrap=64",
                                    "irradiance-cache:samples=2048"};
std::string name_of(const std::string& way) { return way.substr(0, way.find(':')); }

// By which the scenes' table knows it: its name, but where a setting decides which light is looked for.
std::string key_of(const std::string& way) {
  if (way.find("strategies=bdpt") != std::string::npos) return "bdpt";
  return stated_chain_length(way) > 0 ? way : name_of(way);
}
LightSearch search_of(const std::string& way) { return light_search(way); }

struct PhotonSettings {
  double radius;
  int photons;  // in each of so many frames
  int frames;
};
struct PathClass {
  std::string scene, paths, formula;
  double value = 0;
  std::set<std::string> found_by;
  // Half the side of a wider window and floor, for paths from the light, and the mean over that.
  double wide_side = 0, wide_value = 0;
  // For photons: the same of the window alone, that of the floor, and what else differs in the scene.
  double photon_window = 0, photon_floor = 0, photon_value = 0;
  PhotonSettings photon_settings{};
  std::vector<std::pair<std::string, std::string>> photon_changes{};
  bool is_found_by(const std::string& way) const { return found_by.contains(key_of(way)); }
  montelux::PathClass path_class() const {
    const auto at = std::find(path_class_names.begin(), path_class_names.end(), paths);
    EXPECT_NE(at, path_class_names.end()) << paths;
    return montelux::PathClass(at - path_class_names.begin());
  }
};
void PrintTo(const PathClass& c, std::ostream* out) { *out << c.paths; }

const std::vector<PathClass>& classes() {
  static const std::vector<PathClass> all = [] {
    std::vector<PathClass> read;
    for (const nlohmann::json& e : nlohmann::json::parse(read_text(folder / "expected.json"))) {
      read.push_back({e.at("scene"), e.at("class"), e.at("formula"), e.at("value").get<double>(),
                      e.at("found_by").get<std::set<std::string>>()});
      if (e.contains("photons")) {
        const nlohmann::json& p = e.at("photons");
        PathClass& c = read.back();
        c.photon_window = p.at("window").get<double>(), c.photon_floor = p.at("floor").get<double>();
        c.photon_value = p.at("value").get<double>();
        c.photon_settings = {p.at("radius").get<double>(), p.at("photons").get<int>(), 4};
        for (const auto& change : p.at("replaced"))
          c.photon_changes.emplace_back(change.at(0).get<std::string>(), change.at(1).get<std::string>());
      }
      if (!e.contains("wide")) continue;
      read.back().wide_side = e.at("wide").at("side").get<double>();
      read.back().wide_value = e.at("wide").at("value").get<double>();
    }
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
  const Film film = render(chosen.any(), scene.settings(PointSetKind::independent, {per_pass, passes}, 3), silent).film;
  EXPECT_EQ(film.non_finite(), 0u) << way;
  return {film.image().mean[0], film.image().standard_error[0]};
}
// The scene with a wider window and floor; half their sides.
std::string wide_text(const PathClass& c, double window, double floor_side) {
  const std::string seen = std::to_string(window), side = std::to_string(floor_side);
  std::string text = replaced(read_text(folder / c.scene), "[ -1e-3 1e-3 -1e-3 1e-3 ]",
                              "[ -" + seen + " " + seen + " -" + seen + " " + seen + " ]");
  const std::string floor = "[ -0.02 0 -0.02   -0.02 0 0.02   0.02 0 0.02   0.02 0 -0.02 ]";
  if (text.find(floor) == std::string::npos) return text;
  const std::string low = " -" + side, high = " " + side, zero = " 0";
  return replaced(text, floor,
                  "[" + low + zero + low + low + zero + high + high + zero + high + high + zero + low + " ]");
}

// A way with these settings. The frames of a pass of photonmap share their maps, whose settings are the same; they have
// twice as many photons as all frames together, so that the noise leaves no doubt.
std::string with_photons(const std::string& way, const PhotonSettings& s) {
  const bool shared = name_of(way) == "photonmap";
  const std::string radius = "radius=" + std::to_string(s.radius),
                    photons = "photons=" + std::to_string(shared ? 2 * s.frames * s.photons : s.photons);
  const std::string more = shared ? ",caustic-" + radius + ",caustic-" + photons : ",alpha=1";
  return way + (way.find(':') == std::string::npos ? ":" : ",") + radius + "," + photons + more;
}
std::string photon_text(const PathClass& c) {
  std::string text = wide_text(c, c.photon_window, c.photon_floor);
  for (const auto& [old, by] : c.photon_changes) text = replaced(text, old, by);
  return text;
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
    const LightSearch search = search_of(way);
    const bool from_lights = search == LightSearch::from_lights;
    if ((from_lights || (search == LightSearch::both_ends && c.wide_side > 0)) && c.is_found_by(way)) {
      const TestScene wide(wide_text(c, c.wide_side, c.wide_side), folder.string());
      const Measured m = measure(wide, way, 2048);
      EXPECT_TRUE(agrees(m, c.wide_value))
          << way << ": " << m.mean << " +- " << m.standard_error << " where " << c.wide_value << " is right";
      // The brightness of a pass of metropolis is that of its few independent paths.
      const double fault = name_of(way) == "metropolis" ? 1.6 : 1.1;
      EXPECT_FALSE(agrees(m, fault * c.wide_value)) << m.standard_error / m.mean;
      continue;
    }
    if (search == LightSearch::photons && c.photon_window > 0) {
      const TestScene wide(photon_text(c), folder.string());
      const Measured m = measure(wide, with_photons(way, c.photon_settings), c.photon_settings.frames);
      EXPECT_TRUE(agrees(m, c.photon_value))
          << way << ": " << m.mean << " +- " << m.standard_error << " where " << c.photon_value << " is right";
      EXPECT_FALSE(agrees(m, 1.1 * c.photon_value)) << m.standard_error / m.mean;
      continue;
    }
    const Measured m = measure(scene, way);
    if (!c.is_found_by(way)) {
      EXPECT_EQ(m.mean, 0) << way;
      continue;
    }
    EXPECT_TRUE(agrees(m, c.value)) << way << ": " << m.mean << " +- " << m.standard_error << " where " << c.formula
                                    << " = " << c.value;
    const double fault = way == "path" ? 1.2 : 1.3;
    EXPECT_FALSE(agrees(m, fault * c.value)) << way << " would pass with " << 100 * (fault - 1) << " % more";
  }
}

// The table of the program, which drives warnings and headers, says of every integrator what the pictures show.
TEST_P(PathClasses, are_in_the_table_of_findings) {
  const PathClass& c = GetParam();
  for (const std::string& way : ways)
    EXPECT_EQ(finding(search_of(way), c.path_class()) != Finding::no, c.is_found_by(way)) << way;
}

// Both directions: where light is missing it is named, and where nothing is missing there is no warning.
TEST_P(PathClasses, that_are_missing_are_named_and_no_others) {
  const PathClass& c = GetParam();
  const TestScene scene(read_text(folder / c.scene), folder.string());
  for (const std::string& way : ways) {
    ChosenIntegrator chosen = scene.integrator(way);
    const std::size_t notes = chosen.notes.size();
    note_missing_light(chosen, {{}, {}, scene.picture().width, scene.picture().height}, scene.scene(), scene.accel());
    EXPECT_EQ(chosen.missing.empty(), c.is_found_by(way)) << way;
    EXPECT_EQ(chosen.notes.size() - notes, chosen.missing.size()) << way;
  }
}

std::string test_name(const testing::TestParamInfo<PathClass>& c) {
  std::string name = std::filesystem::path(c.param.scene).stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Scenes, PathClasses, testing::ValuesIn(classes()), test_name);

// What nobody finds is there: a lamp of the same intensity instead of the point is met by chance.
TEST(PathClassesOfPoints, have_the_light_that_a_small_lamp_in_their_place_contributes) {
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

// The caustic of lsde-point with a coloured light on a coloured floor, in either half of a window: the radiance at (x,
// 0, z) is that of a point light at (1.75, 1, 0), the image of the light in the mirror.
TEST(PathClassesOfPoints, have_the_colours_of_the_closed_form_in_each_half_of_the_caustic) {
  constexpr double reflectance[] = {0.6, 0.3, 0.15}, intensity[] = {3, 1, 5};
  struct Half {
    const char* window;
    double middle;
  };
  const Half halves[] = {{"[ -0.1 0 -0.1 0.1 ]", -0.05}, {"[ 0 0.1 -0.1 0.1 ]", 0.05}};
  const auto radiance = [&](std::size_t channel, double middle) {
    constexpr int n = 40;
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = middle + 0.1 * ((i + 0.5) / n - 0.5), z = 0.2 * ((j + 0.5) / n - 0.5);
        sum += std::pow((1.75 - x) * (1.75 - x) + 1 + z * z, -1.5);
      }
    return reflectance[channel] / std::numbers::pi * intensity[channel] * sum / (n * n);
  };
  constexpr PhotonSettings photons{0.02, 50000, 8};
  const std::pair<std::string, int> searches[] = {{"path:manifold=1", 8},
                                                  {"light", 8192},
                                                  {"bdpt", 8192},
                                                  {with_photons("sppm", photons), 8},
                                                  {with_photons("photonmap", photons), 8},
                                                  {with_photons("vcm", photons), 10}};
  const double own = sidak_level(family_level, 3.0 * std::size(halves) * std::size(searches));
  std::string text = replaced(read_text(folder / "lsde-point.pbrt"), "[ 3 3 3 ]", "[ 3 1 5 ]");
  text = replaced(text, "[ 0.6 0.6 0.6 ]", "[ 0.6 0.3 0.15 ]");
  text = replaced(text, "[ -0.02 0 -0.02   -0.02 0 0.02   0.02 0 0.02   0.02 0 -0.02 ]",
                  "[ -0.15 0 -0.15   -0.15 0 0.15   0.15 0 0.15   0.15 0 -0.15 ]");
  for (const Half& half : halves) {
    const TestScene scene(replaced(text, "[ -1e-3 1e-3 -1e-3 1e-3 ]", half.window), folder.string());
    for (const auto& [way, samples] : searches) {
      const Mean m = test::measure(scene, way, samples, 5);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto p = [&](double truth) { return p_value(m.mean[c], m.standard_error[c], truth); };
        const double truth = radiance(c, half.middle);
        EXPECT_GE(p(truth), own) << way << ", channel " << c << " about x = " << half.middle << ": " << m.mean[c]
                                 << " +- " << m.standard_error[c] << " where " << truth << " is right";
        EXPECT_LT(p(1.15 * truth), own) << way << ": " << m.standard_error[c] / m.mean[c];
        EXPECT_LT(p(radiance(c, -half.middle)), own) << way << ": " << m.standard_error[c] / m.mean[c];
      }
    }
  }
}

// Light of lamps that a ray can meet is found by chance: the same scene with such a lamp has no warning.
TEST(PathClassesOfPoints, are_not_called_missing_with_a_lamp_that_has_a_size) {
  const TestScene scene(read_text(folder / "lsde.pbrt"), folder.string());
  EXPECT_TRUE(missing_light(LightSearch::any_length, scene.scene(), scene.accel(), 8, 8).empty());
  EXPECT_FALSE(missing_light(LightSearch::one_event, scene.scene(), scene.accel(), 8, 8).empty());
}

TEST(PathClassesOfRadiosity, with_smooth_surfaces_are_refused) {
  for (const PathClass& c : classes()) {
    const TestScene scene(read_text(folder / c.scene), folder.string());
    const bool refused = finding(light_search("radiosity"), c.path_class()) == Finding::refused;
    if (refused)
      EXPECT_THROW(scene.integrator("radiosity"), std::runtime_error) << c.paths;
    else
      EXPECT_NO_THROW(scene.integrator("radiosity")) << c.paths;
  }
}

// The table of docs/integrators.md, cell by cell.
TEST(PathClassesOfDocumentation, are_those_of_the_table_of_findings) {
  const std::string text = read_text(std::filesystem::path(MONTELUX_SOURCE_DIR) / "docs/integrators.md");
  const LightSearch columns[] = {LightSearch::any_length, LightSearch::with_chains, LightSearch::one_event,
                                 LightSearch::diffuse,    LightSearch::from_lights, LightSearch::both_ends,
                                 LightSearch::photons};
  for (std::size_t i = 0; i < path_class_names.size(); ++i) {
    const std::size_t row = text.find("\n| " + std::string(path_class_names[i]) + " | ");
    ASSERT_NE(row, std::string::npos) << path_class_names[i];
    std::istringstream line(text.substr(row + 1, text.find('\n', row + 1) - row - 1));
    std::vector<std::string> cells;
    for (std::string cell; std::getline(line, cell, '|');) cells.push_back(cell);
    ASSERT_GE(cells.size(), 10u) << path_class_names[i];
    for (std::size_t c = 0; c < std::size(columns); ++c) {
      const Finding found = *finding(columns[c], montelux::PathClass(i));
      EXPECT_EQ(cells[3 + c], " " + std::string(finding_names[std::size_t(found)]) + " ")
          << path_class_names[i] << ", column " << c;
    }
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
