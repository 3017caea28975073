// The experiments' verdicts, which are statistical tests against closed forms at one family-wise level, and for each
// experiment a planted fault that its verdict must find.
#include <gtest/gtest.h>

#include <set>

#include "lab/experiments/experiment.h"

namespace montelux::lab {
namespace {

class EveryExperiment : public testing::TestWithParam<const Experiment*> {};

Report run(const Experiment& experiment, bool fault) {
  return run_experiment(experiment, Setup::make(experiment, 0, {}, fault).value());
}

std::string failures_of(const Report& report) {
  std::string text;
  for (const Section& section : report.sections)
    if (const auto* verdict = std::get_if<Verdict>(&section); verdict && !verdict->passed)
      text += verdict->claim + " " + verdict->detail + "\n";
  return text;
}

TEST_P(EveryExperiment, has_verdicts_that_hold) {
  const Report report = run(*GetParam(), false);
  EXPECT_TRUE(report.passed()) << failures_of(report);
}

TEST_P(EveryExperiment, finds_its_planted_fault) { EXPECT_FALSE(run(*GetParam(), true).passed()) << GetParam()->fault; }

TEST_P(EveryExperiment, has_a_question_a_formula_a_figure_and_settings) {
  const Experiment& e = *GetParam();
  for (std::string_view text : {e.name, e.title, e.group, e.question, e.formula, e.source, e.fault})
    EXPECT_FALSE(text.empty()) << e.name;
  EXPECT_FALSE(e.knobs.front().name.empty());
  EXPECT_GT(e.checks, 0u);
}

std::string test_name(const testing::TestParamInfo<const Experiment*>& info) {
  std::string name(info.param->name);
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Lab, EveryExperiment, testing::ValuesIn(experiments().begin(), experiments().end()),
                         test_name);

TEST(Experiments, have_names_of_their_own) {
  std::set<std::string_view> names;
  for (const Experiment* e : experiments()) EXPECT_TRUE(names.insert(e->name).second) << e->name;
  EXPECT_EQ(find_experiment("circle")->name, "circle");
  EXPECT_EQ(find_experiment("no-such-experiment"), nullptr);
}

TEST(Experiments, refuse_settings_that_they_do_not_have) {
  const Experiment& circle = *find_experiment("circle");
  EXPECT_FALSE(Setup::make(circle, 0, {{"sample", 10}}));
  EXPECT_FALSE(Setup::make(circle, 0, {{"samples", 0}}));
  EXPECT_FALSE(Setup::make(circle, 0, {{"samples", -3}}));
  EXPECT_EQ(Setup::make(circle, 0, {{"samples", 1000}}).value().count("samples"), 1000u);
}

TEST(Experiments, give_the_same_data_for_the_same_seed_and_others_for_another) {
  const Experiment& roulette = *find_experiment("roulette");
  const auto figure = [&](std::uint32_t seed) {
    const Report report = run_experiment(roulette, Setup::make(roulette, seed, {{"samples", 2000}}).value());
    return std::get<Figure>(report.sections[2]).curves[0].y;
  };
  EXPECT_EQ(figure(1), figure(1));
  EXPECT_NE(figure(1), figure(2));
}

TEST(Checks, of_all_experiments_share_one_level) {
  double checks = 0;
  for (const Experiment* e : experiments()) checks += double(e->checks);
  EXPECT_NEAR(1 - std::pow(1 - check_level(), checks), 1e-3, 1e-9);
}

}  // namespace
}  // namespace montelux::lab
