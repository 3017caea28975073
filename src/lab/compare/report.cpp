#include "lab/compare/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/statement/value_text.h"

namespace montelux::lab {

namespace {

const std::string& name_of(const MethodResult& m) { return m.compared_method.shown_name(); }

constexpr const char* seconds_note = " Seconds are those of the frames that are shown.";

Table table_of_methods(const ComparisonResult& result) {
  const std::string by(title_of(result.measure));
  Table table{
      "methods",
      fmt::format("Means over the repeats, ± half of their intervals. The errors are those of one repeat against "
                  "the reference; the efficiency is 1 / ({} × seconds).{}",
                  result.measure == ErrorMeasure::flip ? "FLIP²" : by, result.warm_up_counts ? "" : seconds_note),
      {"method", "efficiency by " + by, "relMSE", "MSE", "FLIP"},
      {}};
  for (const MethodResult& m : result.methods)
    table.rows.push_back(
        {name_of(m), text_of(m.efficiency[result.measure]), text_of(m.relative_mse), text_of(m.mse), text_of(m.flip)});
  return table;
}

Table table_of_costs(const ComparisonResult& result) {
  Table table{"costs",
              fmt::format("What one repeat took.{}", result.warm_up_counts ? "" : seconds_note),
              {"method", "seconds", "samples per pixel", "rays"},
              {}};
  for (const MethodResult& m : result.methods)
    table.rows.push_back({name_of(m), text_of(m.seconds), m.samples.mean, fmt::format("{:.3g}", m.rays.mean)});
  if (result.warm_up_counts) return table;
  table.columns.insert(table.columns.end(), {"seconds of warm-up, not counted", "efficiency with these"});
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const MethodResult& m = result.methods[i];
    table.rows[i].insert(table.rows[i].end(), {text_of(m.warm_up), text_of(m.whole_efficiency[result.measure])});
  }
  return table;
}

// A bias in percent of the mean.
std::string share_of_mean(double bias, double mean) {
  return mean > 0 && std::isfinite(bias) ? fmt::format("{:.2g} %", 100 * bias / mean) : "not known";
}

std::string outcome_text(const Agreement& a) {
  using Outcome = Agreement::Outcome;
  return a.outcome == Outcome::agrees ? "agrees" : a.outcome == Outcome::differs ? "differs" : "too few repeats";
}

Table table_of_truth(const ComparisonResult& result) {
  Table table{
      "truth",
      fmt::format("Is the mean of all repeats that of the reference? Tests of the image mean and of the squared "
                  "bias over pixels, at a level of 1 % for all of them together. A bias of the image mean of at "
                  "least the size in the third column would be detected {:.0f} times in 10.",
                  10 * Agreement::power),
      {"method", "mean", "detectable bias", "off by", "standard errors", "squared bias of pixels"},
      {}};
  const double mean = mean_value(result.reference.mean);
  for (const MethodResult& m : result.methods) {
    const Agreement& a = m.agreement;
    table.rows.push_back({name_of(m), outcome_text(a), share_of_mean(a.detectable, mean),
                          share_of_mean(a.difference, mean), fmt::format("{:+.2f}", a.t), text_of(m.bias_squared)});
  }
  return table;
}

Table table_of_bars(const ComparisonResult& result) {
  Table table{
      "bars",
      "What each method states of its own error: the variance of a pixel's mean, which is its MSE where it has no "
      "bias, and how often a pixel's own 95 % interval contains the reference.",
      {"method", "its own variance", "MSE", "intervals that contain it"},
      {}};
  for (const MethodResult& m : result.methods)
    table.rows.push_back({name_of(m), text_of(m.variance), text_of(m.mse),
                          m.coverage.count > 0 ? fmt::format("{:.1f} %", 100 * m.coverage.mean) : "not known"});
  return table;
}

std::string ratio_text(const Measured& m) {
  return m.count < 2 ? "not known" : value_in_interval(m.mean, m.low, m.high);
}

Table table_of_ratios(const ComparisonResult& result) {
  Table table{
      "ratios",
      "The ratio of the efficiencies of the first and the second, with intervals, by each measure. The verdict uses "
      "the first of the measures.",
      {"first", "second"},
      {}};
  std::vector<ErrorMeasure> order{result.measure};
  for (ErrorMeasure m : error_measures)
    if (m != result.measure) order.push_back(m);
  for (ErrorMeasure m : order) table.columns.push_back(fmt::format("by {}", title_of(m)));
  table.columns.push_back("decided");
  if (!result.warm_up_counts) table.columns.push_back("including the warm-up");
  for (const PairVerdict& v : result.verdicts) {
    std::vector<Cell>& row = table.rows.emplace_back();
    row.emplace_back(name_of(result.methods[v.first])), row.emplace_back(name_of(result.methods[v.second]));
    for (ErrorMeasure m : order) row.emplace_back(ratio_text(v.ratio[m]));
    row.emplace_back(v.decided ? "yes" : "no");
    if (!result.warm_up_counts) row.emplace_back(ratio_text(v.whole_ratio[result.measure]));
  }
  return table;
}

// Squared error of single passes by samples or by seconds.
Figure convergence(const ComparisonResult& result, bool by_time) {
  Figure figure;
  figure.name = by_time ? "by-time" : "by-samples";
  figure.caption = "Mean squared error of single passes of 1, 2, 4, … samples, with 95 % bars over the repeats.";
  figure.x = {by_time ? "seconds" : "samples per pixel", true, {}, {}};
  figure.y = {"mse", true, {}, {}};
  int color = 0;
  for (const MethodResult& m : result.methods) {
    const Measured& slope = by_time ? m.slope_by_time : m.slope_by_samples;
    Curve line;
    line.name = fmt::format("{}, slope {}", name_of(m), text_of(slope));
    line.color = color;
    Curve bars;
    bars.mark = Mark::points, bars.color = color++;
    for (const ConvergencePoint& p : m.convergence) {
      const double x = by_time ? p.seconds.mean : p.samples;
      if (!(p.mse.mean > 0) || !(x > 0)) continue;
      line.x.push_back(x), line.y.push_back(p.mse.mean);
      bars.x.push_back(x), bars.y.push_back(p.mse.mean);
      bars.low.push_back(p.mse.low), bars.high.push_back(p.mse.high);
    }
    figure.curves.push_back(std::move(line)), figure.curves.push_back(std::move(bars));
  }
  return figure;
}

bool has_slopes(const ComparisonResult& result) {
  return std::ranges::any_of(result.methods, [](const MethodResult& m) { return !m.convergence.empty(); });
}

Figure repeats(const ComparisonResult& result) {
  Figure figure;
  figure.name = "repeats";
  figure.caption = fmt::format(
      "The efficiency by {} of each repeat, in the order of the rounds: changes in the speed of the machine "
      "are visible here.",
      title_of(result.measure));
  figure.x = {"round", false, {}, {}};
  figure.y = {"efficiency", true, {}, {}};
  int color = 0;
  for (const MethodResult& m : result.methods) {
    Curve curve;
    curve.name = name_of(m), curve.mark = Mark::points, curve.color = color++;
    for (std::size_t i = 0; i < m.repeats.size(); ++i)
      if (const double cost = squared_error_by(result.measure, m.repeats[i]) * m.repeats[i].seconds; cost > 0)
        curve.x.push_back(double(i + 1)), curve.y.push_back(1 / cost);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

// More values than this, over all images, would make the page too large; the repeats are omitted first.
constexpr std::size_t max_values = 24u << 20;

// The attribution of the variance of each method, pixel by pixel; layers below half a percent are omitted.
void add_shares(const ComparisonResult& result, std::size_t values, PictureComparison& comparison) {
  for (const MethodResult& m : result.methods) {
    if (!m.attribution) continue;
    std::size_t layer = 0;
    for (const FamilyShares& family : m.attribution->families)
      for (const LayerShare& share : family.layers) {
        const std::vector<float>& by_pixel = m.attribution->by_pixel[layer++];
        if (std::abs(share.share.mean) < 0.005) continue;
        values += by_pixel.size();
        if (values > max_values) return;
        MeasuredPicture picture{share.name, m.mean.width, m.mean.height, by_pixel, {}, {}, m.samples.mean};
        picture.set = "variance of " + name_of(m) + " by " + family.name;
        comparison.pictures.push_back(std::move(picture));
      }
  }
}

PictureComparison pictures(const ComparisonResult& result) {
  PictureComparison comparison{
      "pictures",
      "The reference, and the mean of all repeats of each method. At the pointer: values with "
      "standard errors, and the luminance's running mean over the repeats with its 95 % band; the "
      "dashed line is the reference. If a method has layers of light, `show` has the share of "
      "each in the variance around a pixel, white for all of it.",
      {}};
  const Reference& reference = result.reference;
  const std::size_t pixels = reference.mean.pixel_count();
  std::vector<float> error(reference.variance.values.size());
  for (std::size_t i = 0; i < error.size(); ++i) error[i] = std::sqrt(reference.variance.values[i]);
  comparison.pictures.push_back(
      {"reference", reference.mean.width, reference.mean.height, reference.mean.values, error, {}, 0});
  std::size_t values = 6 * pixels * (result.methods.size() + 1);
  for (const MethodResult& m : result.methods) {
    if (m.repeats.empty()) continue;
    MeasuredPicture picture{name_of(m), m.mean.width,  m.mean.height, m.mean.values, m.standard_error.values,
                            {},         m.samples.mean};
    values += m.luminance.size() * pixels;
    if (values <= max_values) picture.repeats = m.luminance;
    comparison.pictures.push_back(std::move(picture));
  }
  add_shares(result, values, comparison);
  return comparison;
}

// The shares of one family in the variance of every method that has layers.
Figure shares(const ComparisonResult& result, std::size_t family) {
  Figure figure;
  std::vector<const MethodResult*> methods;
  std::vector<int> colors;
  for (std::size_t i = 0; i < result.methods.size(); ++i)
    if (result.methods[i].attribution) methods.push_back(&result.methods[i]), colors.push_back(int(i));
  const FamilyShares& first = methods.front()->attribution->families[family];
  figure.name = "variance-by-" + first.name;
  std::ranges::replace(figure.name, ' ', '-');
  figure.caption = "Shares of the variance of the image by " + first.name + ", with 95 % bars over the repeats.";
  figure.x.label = first.name;
  figure.y.label = "share of the variance";
  for (const LayerShare& layer : first.layers) figure.x.names.push_back(layer.name);
  figure.x.low = 0.5, figure.x.high = double(first.layers.size()) + 0.5;
  const double width = 0.8 / double(methods.size());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    Curve curve;
    curve.name = name_of(*methods[m]), curve.mark = Mark::bars, curve.color = colors[m], curve.width = width;
    const auto& layers = methods[m]->attribution->families[family].layers;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      curve.x.push_back(double(i + 1) + width * (double(m) - 0.5 * (double(methods.size()) - 1)));
      curve.y.push_back(layers[i].share.mean);
      curve.low.push_back(layers[i].share.low), curve.high.push_back(layers[i].share.high);
    }
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

void add_attribution(const ComparisonResult& result, Report& report) {
  const MethodResult* any = nullptr;
  std::string without;
  for (const MethodResult& m : result.methods) {
    if (m.attribution) any = &m;
    if (!m.compared_method.layers) without += (without.empty() ? "" : ", ") + name_of(m);
  }
  if (any) {
    report.sections.push_back(
        Formula{"s_i = \\frac{\\operatorname{Cov}(L_i, L)}{\\operatorname{Var}(L)}, \\quad L = "
                "\\sum_i L_i, \\quad \\sum_i s_i = 1",
                "Shorrocks 1982, Inequality Decomposition by Factor Components"});
    report.sections.push_back(Text{
        "The light of a pass is the sum of layers, and this is the share of each in the variance of that sum, over "
        "all pixels and channels. A layer with a negative share reduces the noise of the others."});
    // A single light group has all of it.
    for (std::size_t family = 0; family < any->attribution->families.size(); ++family)
      if (any->attribution->families[family].layers.size() > 1) report.sections.push_back(shares(result, family));
  }
  if (!without.empty())
    report.sections.push_back(Text{
        "Not attributed, because the method does not split its light into layers, or by request: " + without + "."});
}

}  // namespace

ReportSet report_of(const ComparisonResult& result, const ComparisonText& words) {
  Report report;
  report.name = "comparison", report.title = "Which method is better, and with what confidence";
  report.sections.push_back(Facts{words.conditions});
  for (const std::string& sentence : words.sentences) report.sections.push_back(Text{sentence + "."});
  for (std::size_t i = 0; i < words.agreement.size(); ++i)
    report.sections.push_back(Text{name_of(result.methods[i]) + ": " + words.agreement[i] + "."});
  for (std::size_t i = 0; i < words.shortcomings.size(); ++i)
    if (!words.shortcomings[i].empty())
      report.sections.push_back(Text{name_of(result.methods[i]) + ": " + words.shortcomings[i] + "."});
  for (const std::string& note : words.notes) report.sections.push_back(Text{"Note: " + note + "."});
  report.sections.push_back(table_of_ratios(result));
  report.sections.push_back(table_of_methods(result));
  report.sections.push_back(pictures(result));
  report.sections.push_back(table_of_costs(result));
  report.sections.push_back(table_of_truth(result));
  report.sections.push_back(table_of_bars(result));
  add_attribution(result, report);
  if (has_slopes(result)) {
    report.sections.push_back(convergence(result, false));
    report.sections.push_back(convergence(result, true));
  }
  report.sections.push_back(repeats(result));
  report.sections.push_back(Commands{words.commands});
  return {"Comparison of methods", words.scene, {std::move(report)}};
}

}  // namespace montelux::lab
