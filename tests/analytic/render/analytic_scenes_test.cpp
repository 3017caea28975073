// The scenes of scenes/analytic have a mean in closed form. Every sampler on the native pack, and two of them on one
// lane, must find it within its own error bar, must notice where the closed form is 3 % off, the best of them where it
// is 1 % off, and a fault that is planted in the scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
constexpr int passes = 32;
// Paths are summed in 32 bits: a mean without spread may differ from the closed form by a few units in the last place.
constexpr double rounding = 1e-5;

struct Case {
  std::string scene, formula, fault_old, fault_new;
  double value = 0;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene; }

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const nlohmann::json& e : nlohmann::json::parse(read_text(folder / "expected.json")))
    cases.push_back({e.at("scene"), e.at("formula"), e.at("fault").at("replace"), e.at("fault").at("by"),
                     e.at("value").get<double>()});
  return cases;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = all_cases();
  return all;
}

double level() { return sidak_level(family_level, (double(point_set_names.size()) + 2) * double(cases().size())); }

struct Measured {
  double mean = 0, standard_error = 0;
  std::uint64_t non_finite = 0;
};

Measured measure(const TestScene& scene, PointSetKind sampler, Lanes lanes) {
  const int k = scene.picture().samples / passes;
  const RenderResult result = scene.render(sampler, {k, passes}, 1, lanes);
  const ImageEstimate image = result.film.image();
  return {image.mean[0], image.standard_error[0], result.film.non_finite()};
}

// Whether the mean is compatible with `value`: Student's test with an allowance for rounding.
bool agrees(const Measured& m, double value) {
  const double distance = std::max(0.0, std::abs(m.mean - value) - rounding * value);
  if (distance == 0) return true;
  return m.standard_error > 0 && 2 * student_t_cdf(-distance / m.standard_error, passes - 1) >= level();
}

// The relative fault that is found in half of all cases.
double smallest_fault(const Measured& m, double value) {
  return rounding + student_t_quantile(1 - level() / 2, passes - 1) * m.standard_error / value;
}

class AnalyticScene : public testing::TestWithParam<Case> {};

TEST_P(AnalyticScene, has_the_mean_of_theory_under_every_sampler) {
  const Case& c = GetParam();
  const TestScene scene(read_text(folder / c.scene), folder.string());
  double smallest = INFINITY, largest = 0;
  bool finds_one_percent = false;
  for (const NamedPointSet& set : point_set_names)
    for (Lanes lanes : {Lanes::native, Lanes::one}) {
      if (lanes == Lanes::one && set.kind != PointSetKind::independent && set.kind != PointSetKind::blue_noise)
        continue;
      const Measured m = measure(scene, set.kind, lanes);
      const char* width = lanes == Lanes::one ? "one lane" : "native lanes";
      EXPECT_TRUE(agrees(m, c.value)) << set.name << ", " << width << ": " << m.mean << " +- " << m.standard_error
                                      << " where " << c.formula << " = " << c.value << " ("
                                      << (m.mean - c.value) / m.standard_error << " standard errors)";
      EXPECT_EQ(m.non_finite, 0u) << set.name << ", " << width;
      EXPECT_FALSE(agrees(m, c.value * 1.03)) << set.name << ": a closed form that is 3 % too large passes";
      EXPECT_FALSE(agrees(m, c.value / 1.03)) << set.name << ": a closed form that is 3 % too small passes";
      smallest = std::min(smallest, smallest_fault(m, c.value)),
      largest = std::max(largest, smallest_fault(m, c.value));
      finds_one_percent |= !agrees(m, c.value * 1.01) && !agrees(m, c.value / 1.01);
    }
  EXPECT_TRUE(finds_one_percent) << "a closed form that is 1 % off passes under every sampler";
  std::printf("    %-28s finds faults from %.3f %% (the best sampler) to %.3f %% (the worst)\n", c.scene.c_str(),
              100 * smallest, 100 * largest);
}

TEST_P(AnalyticScene, shows_a_planted_fault) {
  const Case& c = GetParam();
  const TestScene scene(replaced(read_text(folder / c.scene), c.fault_old, c.fault_new), folder.string());
  const Measured m = measure(scene, PointSetKind::padded_sobol, Lanes::native);
  EXPECT_FALSE(agrees(m, c.value)) << c.fault_old << " -> " << c.fault_new << ": " << m.mean << " +- "
                                   << m.standard_error << " passes for " << c.value;
}

std::string test_name(const testing::TestParamInfo<Case>& scene) {
  std::string name = std::filesystem::path(scene.param.scene).stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, AnalyticScene, testing::ValuesIn(cases()), test_name);

TEST(AnalyticScenes, all_have_an_expected_mean) {
  std::set<std::string> stated, found;
  for (const Case& c : cases()) stated.insert(c.scene);
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".pbrt") found.insert(entry.path().filename().string());
  EXPECT_EQ(stated, found);
  EXPECT_GE(found.size(), 50u);
}

}  // namespace

}  // namespace montelux::test
