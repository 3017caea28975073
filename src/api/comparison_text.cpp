// The text of a comparison: verdicts, agreement with the reference, conditions; and its report.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/comparison.h"
#include "api/comparison_methods.h"
#include "api/render.h"
#include "image/image_file.h"
#include "image/output_file.h"
#include "lab/compare/report.h"
#include "lab/report/write.h"
#include "lab/statement/value_text.h"

namespace montelux {

namespace {

using lab::ErrorMeasure;
using lab::Measured;

// A multiple of the time, as an integer if it is large.
std::string times_text(double times) {
  if (!std::isfinite(times)) return "many";
  return times < 10 ? fmt::format("{:.2g}", times) : fmt::format("{:.0f}", times);
}

// A ratio in favour of the winner, or of the first method if there is none.
struct Seen {
  double factor = 1, low = 1, high = 1;
};
Seen seen_from(const Measured& ratio, bool first) {
  if (first) return {ratio.mean, ratio.low, ratio.high};
  return {1 / ratio.mean, 1 / ratio.high, 1 / ratio.low};
}
std::string interval_text(const Seen& s) { return lab::value_in_interval(s.factor, s.low, s.high); }

// One verdict with everything that its sentence needs.
struct Spoken {
  const Comparison& comparison;
  const lab::PairVerdict& verdict;
  const lab::MethodResult &first, &second;
  ErrorMeasure measure;
  double confidence;

  const std::string& a() const { return first.compared_method.shown_name(); }
  const std::string& b() const { return second.compared_method.shown_name(); }
  const Measured& ratio() const { return verdict.ratio[measure]; }
};

// Rounds whose error is zero or negative have no efficiency.
std::string left_out(const Spoken& s) {
  const auto rounds = int(std::min(s.first.repeats.size(), s.second.repeats.size()));
  if (s.ratio().count >= rounds) return {};
  return fmt::format("; {} of {} repeats are excluded because the noise of the reference explains their error",
                     rounds - s.ratio().count, rounds);
}

// The result by another measure than the verdict's. `lead`: 1 if the verdict favours the first, -1 the second, 0 none.
std::string other_measure(const Spoken& s, ErrorMeasure other, int lead) {
  const Measured& ratio = s.verdict.ratio[other];
  const std::string by = fmt::format("; by {} ", lab::title_of(other));
  if (s.comparison.result.reference_share[other] > largest_reference_share)
    return by + "unknown, the reference is too noisy";
  if (ratio.count < 2) return by + "not known";
  const int winner = lab::winner_of(ratio);
  if (winner == 0) return by + "undecided, " + interval_text(seen_from(ratio, lead >= 0));
  const std::string times = interval_text(seen_from(ratio, winner > 0)) + " times";
  if (winner == lead) return by + times;
  return fmt::format("{}{}{} is {} as efficient", by, lead == 0 ? "" : "the opposite: ", winner > 0 ? s.a() : s.b(),
                     times);
}

std::string biased_text(const Spoken& s) {
  std::string names;
  for (const lab::MethodResult* m : {&s.first, &s.second})
    if (m->agreement.differs()) names += (names.empty() ? "" : " and ") + m->compared_method.shown_name();
  return names.empty()
             ? ""
             : fmt::format("; the mean of {} differs from the reference, so this is valid only for this time", names);
}

// "a is 2.31 (2.10 to 2.55) times as efficient as b by relMSE, at 95 %", or that the comparison is undecided.
std::string main_sentence(const Spoken& s) {
  const auto title = lab::title_of(s.measure);
  const std::string level = fmt::format("{:g} %", 100 * s.confidence);
  if (!s.comparison.refusal.empty()) return fmt::format("{} and {}: no verdict by this reference", s.a(), s.b());
  if (std::min(s.first.repeats.size(), s.second.repeats.size()) < 2)
    return fmt::format("{} and {}: undecided, there are too few repeats", s.a(), s.b());
  if (s.verdict.likeness == lab::Likeness::settings)
    return fmt::format("{} and {} are the same method with the same settings", s.a(), s.b());
  if (s.ratio().count < 2) return fmt::format("{} and {}: undecided by {}{}", s.a(), s.b(), title, left_out(s));
  const int winner = lab::winner_of(s.ratio());
  const bool first = winner > 0 || (winner == 0 && s.ratio().mean >= 1);
  const std::string same =
      s.verdict.likeness == lab::Likeness::pictures
          ? fmt::format("{} and {} gave the same images bit for bit and differ only in time: ", s.a(), s.b())
          : "";
  const std::string times = interval_text(seen_from(s.ratio(), first));
  const std::string &better = first ? s.a() : s.b(), &other = first ? s.b() : s.a();
  if (winner == 0)
    return fmt::format(
        "{}{} and {}: undecided by {}: the ratio of their efficiencies is {} at {}; {} times the time "
        "may decide it{}",
        same, better, other, title, times, level, times_text(s.verdict.times_longer), left_out(s));
  return fmt::format("{}{} is {} times as efficient as {} by {}, at {}{}", same, better, times, other, title, level,
                     left_out(s));
}

std::string warm_up_text(const Spoken& s) {
  if (s.comparison.result.warm_up_counts) return {};
  std::string warmed;
  for (const lab::MethodResult* m : {&s.first, &s.second})
    if (m->warm_up.mean > 0) warmed += (warmed.empty() ? "" : " and ") + m->compared_method.shown_name();
  if (warmed.empty()) return {};
  const bool first = s.ratio().mean >= 1;
  return fmt::format("; the warm-up of {} is not counted: {} times including it", warmed,
                     interval_text(seen_from(s.verdict.whole_ratio[s.measure], first)));
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100 * share); }

std::string measure_text(ErrorMeasure measure) {
  switch (measure) {
    case ErrorMeasure::relative_mse:
      return "relMSE: mean of (x - r)² / (r² + 0.01), r the reference";
    case ErrorMeasure::mse:
      return "MSE: mean of (x - r)², r the reference";
    case ErrorMeasure::flip:
      return "FLIP: mean of HDR-FLIP; its square counts for efficiency";
  }
  return {};
}

std::string budget_text(const ComparisonOptions& o) {
  if (o.seconds)
    return fmt::format("{:.4g} s for each method, {:.4g} s in each of its repeats", *o.seconds, *o.seconds / o.repeats);
  const int samples = o.samples.value_or(lab::ComparisonSettings{}.samples);
  return fmt::format("{} {} per pixel in each repeat", samples, samples == 1 ? "sample" : "samples");
}

}  // namespace

std::string sentence_of(const Comparison& comparison, const lab::PairVerdict& v, double confidence) {
  const Spoken s{
      comparison, v, comparison.result.methods[v.first], comparison.result.methods[v.second], comparison.result.measure,
      confidence};
  const std::string sentence = main_sentence(s);
  const bool judged = comparison.refusal.empty() && s.ratio().count >= 2 && v.likeness != lab::Likeness::settings;
  if (!judged) return sentence;
  const int lead = lab::winner_of(s.ratio());
  std::string others;
  if (v.likeness == lab::Likeness::none)
    for (ErrorMeasure other : lab::error_measures)
      if (other != s.measure) others += other_measure(s, other, lead);
  return sentence + others + (lead == 0 ? "" : biased_text(s)) + warm_up_text(s);
}

std::string sentence_of(const lab::Agreement& a, double reference_mean) {
  using Outcome = lab::Agreement::Outcome;
  const double scale = reference_mean > 0 ? reference_mean : 1;
  const std::string off =
      fmt::format("{:+.2g} % of the mean of the reference, {:+.1f} standard errors", 100 * a.difference / scale, a.t);
  if (a.outcome == Outcome::too_few_repeats)
    return fmt::format("too few repeats to tell whether its mean agrees with the reference ({})", off);
  if (a.outcome == Outcome::agrees)
    return fmt::format(
        "its mean agrees with the reference; a bias of {} of the mean would be detected {:.0f} times in 10",
        percent(a.detectable / scale), 10 * lab::Agreement::power);
  if (a.p_value < a.level) return fmt::format("its mean differs from the reference: {}", off);
  return fmt::format(
      "its mean differs from the reference pixel by pixel: the squared bias is {:.1f} standard errors "
      "above zero",
      a.pixel_t);
}

std::vector<std::pair<std::string, std::string>> conditions_of(const Comparison& comparison, const std::string& scene) {
  const ComparisonOptions& o = comparison.saved.options;
  const lab::ComparisonResult& r = comparison.result;
  std::size_t min_repeats = ~std::size_t(0), max_repeats = 0;
  for (const lab::MethodResult& m : r.methods)
    min_repeats = std::min(min_repeats, m.repeats.size()), max_repeats = std::max(max_repeats, m.repeats.size());
  std::vector<std::pair<std::string, std::string>> rows;
  rows.emplace_back("scene", scene);
  std::string size = fmt::format("{} × {} pixels", r.reference.mean.width, r.reference.mean.height);
  if (o.crop) size += fmt::format(", the crop {},{} to {},{}", o.crop->x0, o.crop->y0, o.crop->x1, o.crop->y1);
  rows.emplace_back("picture", size);
  for (const lab::MethodResult& m : r.methods)
    if (m.compared_method.text != m.compared_method.shown_name())
      rows.emplace_back(m.compared_method.shown_name(), m.compared_method.text);
  std::string common;
  for (const auto& [key, value] : o.settings) common += fmt::format("{}{}={}", common.empty() ? "" : ", ", key, value);
  if (!common.empty()) rows.emplace_back("settings of all", common);
  rows.emplace_back("budget", budget_text(o));
  rows.emplace_back("repeats", min_repeats == max_repeats
                                   ? fmt::format("{} of each method", max_repeats)
                                   : fmt::format("{} to {} of each method", min_repeats, max_repeats));
  rows.emplace_back("measure", measure_text(r.measure));
  rows.emplace_back("intervals", fmt::format("{:g} %", 100 * o.confidence));
  rows.emplace_back("reference", fmt::format("{}; its own variance is {:.2g} of the smallest error", r.reference.origin,
                                             r.reference_share[r.measure]));
  for (const std::string& omission : comparison.left_out) rows.emplace_back("left out", omission);
  rows.emplace_back("seed", fmt::format("{}", o.seed));
  if (o.processor_time) rows.emplace_back("clock", "time of all threads on processors");
  rows.emplace_back("version", "Montelux " + version());
  if (const auto date = date_attribute())
    if (const auto* text = std::get_if<std::string>(&date->value)) rows.emplace_back("date", *text);
  return rows;
}

namespace {

// "missing: light of point lights ...; replaced: sampler zsobol by blue-noise"; empty if images lack nothing.
std::string text_of(const MethodShortcomings& shortcomings) {
  std::vector<std::string> parts;
  for (const std::string& light : shortcomings.missing) parts.push_back("missing: " + light);
  for (const Replacement& r : shortcomings.replaced) parts.push_back("replaced: " + to_text(r));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

Status write_comparison(const std::filesystem::path& file, const Comparison& comparison, const std::string& scene,
                        double confidence, const std::vector<std::string>& commands) {
  lab::ComparisonText words;
  words.scene = scene;
  words.conditions = conditions_of(comparison, scene);
  for (const lab::PairVerdict& v : comparison.result.verdicts)
    words.sentences.push_back(sentence_of(comparison, v, confidence));
  const double mean = lab::mean_value(comparison.result.reference.mean);
  for (const lab::MethodResult& m : comparison.result.methods)
    words.agreement.push_back(m.repeats.empty() ? "no repeat was done" : sentence_of(m.agreement, mean));
  for (const MethodShortcomings& shortcomings : comparison.shortcomings)
    words.shortcomings.push_back(text_of(shortcomings));
  if (!comparison.refusal.empty()) words.notes.push_back(comparison.refusal);
  if (comparison.result.interrupted)
    words.notes.push_back("it was interrupted: the figures are those of the finished repeats");
  if (!comparison.result.warm_up_counts)
    words.notes.push_back(
        "frames of a sequence: warm-up frames have been shown anyway, so seconds and "
        "efficiencies exclude their time unless stated otherwise");
  words.notes.insert(words.notes.end(), comparison.notes.begin(), comparison.notes.end());
  words.commands = commands;
  Result<std::string> page = lab::to_html(lab::report_of(comparison.result, words));
  if (!page) return page.failure();
  return write_file(file, *page);
}

}  // namespace montelux
