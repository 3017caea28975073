// How methods are named, who makes a reference, and what a verdict says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "api/comparison.h"
#include "api/comparison_methods.h"

namespace montelux {
namespace {

using lab::ErrorMeasure;
using lab::Measured;

std::vector<std::string> names(std::vector<std::string> typed,
                               std::vector<std::pair<std::string, std::string>> set = {}) {
  ComparisonOptions options;
  options.methods = std::move(typed), options.settings = std::move(set);
  const auto methods = read_methods(options);
  EXPECT_TRUE(methods) << methods.error();
  std::vector<std::string> found;
  for (const MethodText& m : *methods) found.push_back(m.name);
  return found;
}

std::string refusal(std::vector<std::string> typed, std::vector<std::pair<std::string, std::string>> set = {}) {
  ComparisonOptions options;
  options.methods = std::move(typed), options.settings = std::move(set);
  const auto methods = read_methods(options);
  return methods ? "" : methods.error();
}

using Names = std::vector<std::string>;

TEST(ComparisonMethods, are_named_by_what_distinguishes_them) {
  EXPECT_EQ(names({"path", "naive"}), (Names{"path", "naive"}));
  EXPECT_EQ(names({"path:maxdepth=5,mis=balance", "path:maxdepth=5"}), (Names{"path:mis=balance", "path"}));
  EXPECT_EQ(names({"path:sampler=halton", "path:sampler=sobol"}), (Names{"path:sampler=halton", "path:sampler=sobol"}));
  EXPECT_EQ(names({"path:mis=balance", "path:mis=balance"}), (Names{"path (a)", "path (b)"}));
  EXPECT_EQ(names({"path", "naive"}, {{"maxdepth", "5"}}), (Names{"path", "naive"}));
}

TEST(ComparisonMethods, may_have_names_of_their_user) {
  EXPECT_EQ(names({"old=path:mis=balance", "new one=path"}), (Names{"old", "new one"}));
  EXPECT_NE(refusal({"x=path", "x=naive"}).find("two methods are called \"x\""), std::string::npos);
  // A comma instead of the colon.
  EXPECT_NE(refusal({"path,mis=balance", "naive"}).find("settings follow a colon"), std::string::npos);
  EXPECT_NE(refusal({"=path", "naive"}).find("cannot name a method"), std::string::npos);
  EXPECT_NE(refusal({"a\nb=path", "naive"}).find("cannot name a method"), std::string::npos);
}

TEST(ComparisonMethods, take_the_settings_of_all_but_where_they_have_their_own) {
  ComparisonOptions options;
  options.methods = {"path", "path:maxdepth=3", "path:maxdepth=7"}, options.settings = {{"maxdepth", "7"}};
  const auto methods = read_methods(options);
  ASSERT_TRUE(methods);
  EXPECT_EQ((*methods)[0].canonical(), "path,maxdepth=7");
  EXPECT_EQ((*methods)[1].canonical(), "path,maxdepth=3");
  EXPECT_EQ((*methods)[0].canonical(), (*methods)[2].canonical());
  // A setting that one of them does not have is a mistake, and says whose.
  EXPECT_NE(refusal({"path", "ao"}, {{"mis", "balance"}}).find("ao: unknown setting"), std::string::npos)
      << refusal({"path", "ao"}, {{"mis", "balance"}});
}

// Nothing of it is rendered.
class Nothing final : public PixelIntegrator {
  RayCounts trace(const TilePass&, std::span<PixelSample>) const override { return {}; }
};

std::vector<lab::ComparedMethod> compared_methods(std::vector<std::vector<std::string>> biases) {
  static const Nothing nothing;
  std::vector<lab::ComparedMethod> made;
  for (auto& b : biases)
    made.push_back({std::string(1, char('a' + int(made.size()))), fmt::format("m{}", made.size()), nothing,
                    PointSetKind::blue_noise, std::move(b)});
  return made;
}

using Places = std::vector<std::size_t>;

TEST(Reference, is_made_by_methods_whose_biases_are_shared) {
  EXPECT_EQ(*who_may_serve(compared_methods({{}, {"maxdepth=5"}, {}})), (Places{0, 2}));
  EXPECT_EQ(*who_may_serve(compared_methods({{"maxdepth=5"}, {"maxdepth=5"}, {"maxdepth=5"}})), (Places{0, 1, 2}));
  EXPECT_EQ(*who_may_serve(compared_methods({{"maxdepth=5"}, {"maxdepth=5", "maxcomponent=9"}, {"maxdepth=5"}})),
            (Places{0, 2}));
  EXPECT_EQ(*who_may_serve(compared_methods({{"a", "b"}, {"b", "a"}})), (Places{0, 1}));
}

TEST(Reference, is_made_by_methods_that_find_the_light_that_others_miss) {
  std::vector<lab::ComparedMethod> three = compared_methods({{}, {}, {"maxdepth=5"}});
  three[0].missing = {"light of point lights"};
  EXPECT_EQ(*who_may_serve(three), Places{1});
  // Light that all miss rules nobody out.
  three[1].missing = three[2].missing = three[0].missing;
  EXPECT_EQ(*who_may_serve(three), (Places{0, 1}));
  // Where each misses another light the comparison is made all the same, and notes say what its reference lacks.
  three[1].missing = {"light of the sun"};
  EXPECT_EQ(*who_may_serve(three), (Places{0, 1}));
}

TEST(Reference, is_refused_with_the_methods_of_each_bias) {
  const auto served =
      who_may_serve(compared_methods({{"maxdepth=5"}, {"maxdepth=5"}, {"maxdepth=5"}, {"elementsize=0.1"}}));
  ASSERT_FALSE(served);
  EXPECT_NE(served.error().find("m0, m1, m2 (maxdepth=5)"), std::string::npos) << served.error();
  EXPECT_NE(served.error().find("m3 (elementsize=0.1)"), std::string::npos);
  EXPECT_EQ(served.error().find("each in another way"), std::string::npos);
}

Measured ratio(double mean, double low, double high) { return {mean, low, high, 0.1, 8}; }

// Two methods, "fast" and "slow", of 8 repeats, and one verdict with these ratios.
Comparison comparison(Measured relmse, Measured mse, Measured flip, ErrorMeasure measure = ErrorMeasure::relative_mse) {
  Comparison c;
  for (lab::ComparedMethod& made : compared_methods({{}, {}})) {
    made.name = made.label == "a" ? "fast" : "slow";
    lab::MethodResult& m = c.result.methods.emplace_back();
    m.compared_method = made, m.repeats.resize(8);
  }
  c.result.measure = measure;
  lab::PairVerdict v;
  v.second = 1;
  v.ratio[ErrorMeasure::relative_mse] = relmse, v.ratio[ErrorMeasure::mse] = mse, v.ratio[ErrorMeasure::flip] = flip;
  v.decided = lab::winner_of(v.ratio[measure]) != 0, v.times_longer = 12.3;
  c.result.verdicts = {v};
  return c;
}
std::string sentence(const Comparison& c) { return sentence_of(c, c.result.verdicts.front(), 0.95); }

TEST(Verdict, goes_by_the_measure_and_says_where_another_says_the_opposite) {
  const Measured low = ratio(0.026, 0.021, 0.031), high = ratio(1.5, 1.3, 1.7), none = ratio(1.01, 0.9, 1.1);
  EXPECT_EQ(sentence(comparison(low, high, none)),
            "slow is 38.5 (32.3 to 47.6) times as efficient as fast by relMSE, at 95 %; by MSE the opposite: fast is "
            "1.50 (1.30 to 1.70) times as efficient; by FLIP undecided, 0.990 (0.909 to 1.111)");
  EXPECT_EQ(sentence(comparison(low, high, none, ErrorMeasure::mse)),
            "fast is 1.50 (1.30 to 1.70) times as efficient as slow by MSE, at 95 %; by relMSE the opposite: slow is "
            "38.5 (32.3 to 47.6) times as efficient; by FLIP undecided, 1.010 (0.900 to 1.100)");
  EXPECT_EQ(sentence(comparison(high, high, high)),
            "fast is 1.50 (1.30 to 1.70) times as efficient as slow by relMSE, at 95 %; by MSE 1.50 (1.30 to 1.70) "
            "times; by FLIP 1.50 (1.30 to 1.70) times");
}

TEST(Verdict, that_is_none_says_what_the_other_measures_say) {
  const Measured high = ratio(1.5, 1.3, 1.7), none = ratio(1.01, 0.9, 1.1);
  EXPECT_EQ(sentence(comparison(none, high, none)),
            "fast and slow: undecided by relMSE: the ratio of their efficiencies is 1.010 (0.900 to 1.100) at 95 %; 12 "
            "times the time may decide it; by MSE fast is 1.50 (1.30 to 1.70) times as efficient; by FLIP undecided, "
            "1.010 (0.900 to 1.100)");
}

TEST(Verdict, names_methods_that_are_the_same) {
  const Measured none = ratio(1.01, 0.9, 1.1);
  Comparison c = comparison(none, none, none);
  c.result.verdicts.front().likeness = lab::Likeness::settings;
  EXPECT_EQ(sentence(c), "fast and slow are the same method with the same settings");
  c.result.verdicts.front().likeness = lab::Likeness::pictures;
  EXPECT_NE(sentence(c).find("gave the same images bit for bit and differ only in time"), std::string::npos);
}

TEST(Verdict, is_none_where_the_reference_is_too_noisy_or_a_measure_is_not_known) {
  const Measured high = ratio(1.5, 1.3, 1.7);
  Comparison c = comparison(high, high, high);
  c.result.reference_share[ErrorMeasure::mse] = 0.3;
  EXPECT_NE(sentence(c).find("by MSE unknown, the reference is too noisy"), std::string::npos);
  c.refusal = "its variance is too large";
  EXPECT_EQ(sentence(c), "fast and slow: no verdict by this reference");
  Comparison few = comparison({NAN, 0, INFINITY, 0, 0}, high, high);
  EXPECT_EQ(sentence(few),
            "fast and slow: undecided by relMSE; 8 of 8 repeats are excluded because the noise of the "
            "reference explains their error");
}

TEST(Verdict, never_prints_what_is_no_number) {
  const double infinite = INFINITY;
  for (const Measured& odd : {Measured{NAN, 0, infinite, 0, 0}, ratio(1.5, 0, infinite), ratio(1, 1, 1)})
    for (ErrorMeasure measure : lab::error_measures) {
      const std::string text = sentence(comparison(odd, odd, odd, measure));
      for (const char* word : {"nan", "inf"}) EXPECT_EQ(text.find(word), std::string::npos) << text;
    }
}

TEST(AgreementSentence, states_the_power_or_that_it_cannot_tell) {
  lab::Agreement a;
  a.difference = 0.01, a.t = 1.2, a.detectable = 0.05, a.p_value = 0.3, a.level = 0.001;
  EXPECT_EQ(sentence_of(a, 2),
            "too few repeats to tell whether its mean agrees with the reference (+0.5 % of the "
            "mean of the reference, +1.2 standard errors)");
  a.outcome = lab::Agreement::Outcome::agrees;
  EXPECT_EQ(sentence_of(a, 2),
            "its mean agrees with the reference; a bias of 2.5 % of the mean would be detected 9 times in 10");
  a.outcome = lab::Agreement::Outcome::differs, a.p_value = 1e-5, a.t = -362;
  EXPECT_EQ(sentence_of(a, 2),
            "its mean differs from the reference: +0.5 % of the mean of the reference, -362.0 standard errors");
}

}  // namespace
}  // namespace montelux
