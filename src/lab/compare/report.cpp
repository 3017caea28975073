#include "lab/compare/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace montelux::lab {

namespace {

std::string spread(const Measured& m) {
  if (m.count < 2) return fmt::format("{:.4g}", m.mean);
  return fmt::format("{:.4g} ({:.3g} … {:.3g})", m.mean, m.low, m.high);
}

std::string name_of(const MethodResult& m) { return m.contestant.label + ": " + m.contestant.text; }

Table table_of_methods(const ContestResult& result) {
  Table table{"methods",
              fmt::format("Means over the repeats, with their intervals; squared errors and FLIP of one repeat against "
                          "the reference. Efficiency is 1 / (mse × seconds).{}",
                          result.warm_up_counts ? "" : " Seconds are those of frames that are shown."),
              {"method", "mse", "relMSE", "FLIP", "seconds", "samples a pixel", "rays", "efficiency"},
              {}};
  for (const MethodResult& m : result.methods)
    table.rows.push_back({name_of(m), spread(m.mse), spread(m.relative_mse), spread(m.flip), spread(m.seconds),
                          m.samples.mean, fmt::format("{:.3g}", m.rays.mean), spread(m.efficiency)});
  if (result.warm_up_counts) return table;
  table.columns.insert(table.columns.end(), {"seconds of warm-up, not counted", "efficiency with these"});
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    table.rows[i].insert(table.rows[i].end(),
                         {spread(result.methods[i].warm_up), spread(result.methods[i].whole_efficiency)});
  return table;
}

Table table_of_truth(const ContestResult& result) {
  Table table{
      "truth",
      "Is the mean of all repeats that of the reference? Standard errors that the image mean is off, the "
      "squared bias of pixels, and the smallest p-value among blocks of 8 × 8 pixels (these take pass means for "
      "normal). And how often a pixel's own 95 % "
      "interval holds the reference.",
      {"method", "image mean", "blocks", "mean", "squared bias", "error bars hold", "its own variance"},
      {}};
  for (const MethodResult& m : result.methods)
    table.rows.push_back({name_of(m), fmt::format("{:+.2f}", m.bias.image.t),
                          fmt::format("p = {:.2g}", m.bias.blocks.smallest_p),
                          differs_from_reference(m) ? "differs" : "agrees", spread(m.bias_squared),
                          fmt::format("{:.1f} %", 100 * m.coverage.mean), spread(m.variance)});
  return table;
}

Table table_of_ratios(const ContestResult& result) {
  Table table{"ratios",
              "How many times as efficient the first is as the second: by squared error, and by relMSE.",
              {"first", "second", "ratio", "ratio by relMSE", "decided"},
              {}};
  for (const PairVerdict& v : result.verdicts)
    table.rows.push_back({result.methods[v.first].contestant.label, result.methods[v.second].contestant.label,
                          spread(v.ratio), spread(v.relative_ratio), v.decided ? "yes" : "no"});
  if (result.warm_up_counts) return table;
  table.columns.insert(table.columns.end(), {"ratio with the time of warm-up", "the same by relMSE"});
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    table.rows[i].insert(table.rows[i].end(),
                         {spread(result.verdicts[i].whole_ratio), spread(result.verdicts[i].whole_relative_ratio)});
  return table;
}

// Squared error against samples, or seconds, of single passes.
Figure convergence(const ContestResult& result, bool by_time) {
  Figure figure;
  figure.name = by_time ? "by-time" : "by-samples";
  figure.caption = "Mean squared error of single passes of 1, 2, 4, … samples, with 95 % bars over the repeats.";
  figure.x = {by_time ? "seconds" : "samples a pixel", true, {}, {}};
  figure.y = {"mse", true, {}, {}};
  int color = 0;
  for (const MethodResult& m : result.methods) {
    const Measured& slope = by_time ? m.slope_by_time : m.slope_by_samples;
    Curve line;
    line.name = fmt::format("{}, slope {:.2f} ± {:.2f}", m.contestant.label, slope.mean, slope.high - slope.mean);
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

bool has_slopes(const ContestResult& result) {
  return std::ranges::any_of(result.methods, [](const MethodResult& m) { return !m.convergence.empty(); });
}

Figure repeats(const ContestResult& result) {
  Figure figure;
  figure.name = "repeats";
  figure.caption = "The efficiency of each repeat, in the order of the rounds: a machine that drifts shows here.";
  figure.x = {"round", false, {}, {}};
  figure.y = {"efficiency", true, {}, {}};
  int color = 0;
  for (const MethodResult& m : result.methods) {
    Curve curve;
    curve.name = m.contestant.label, curve.mark = Mark::points, curve.color = color++;
    for (std::size_t i = 0; i < m.repeats.size(); ++i)
      if (const double e = 1 / (m.repeats[i].mse * m.repeats[i].seconds); e > 0)
        curve.x.push_back(double(i + 1)), curve.y.push_back(e);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

// More values than this, over all pictures, would make the page too large; the repeats go first.
constexpr std::size_t most_values = 24u << 20;

// Where the variance of each method comes from, pixel by pixel; layers of less than half a percent are left out.
void add_shares(const ContestResult& result, std::size_t values, Comparison& comparison) {
  for (const MethodResult& m : result.methods) {
    if (!m.attribution) continue;
    std::size_t layer = 0;
    for (const FamilyShares& family : m.attribution->families)
      for (const LayerShare& share : family.layers) {
        const std::vector<float>& by_pixel = m.attribution->by_pixel[layer++];
        if (std::abs(share.share.mean) < 0.005) continue;
        values += by_pixel.size();
        if (values > most_values) return;
        MeasuredPicture picture{share.name, m.mean.width, m.mean.height, by_pixel, {}, {}, m.samples.mean};
        picture.set = "variance of " + m.contestant.label + " by " + family.name;
        comparison.pictures.push_back(std::move(picture));
      }
  }
}

Comparison pictures(const ContestResult& result) {
  Comparison comparison{"pictures",
                        "The reference, and the mean of all repeats of each method. Under the pointer: values with "
                        "standard errors, and the luminance's running mean over the repeats with its 95 % band; the "
                        "dashed line is the reference. Where a method has layers of light, `show` has the share of "
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
    if (values <= most_values) picture.repeats = m.luminance;
    comparison.pictures.push_back(std::move(picture));
  }
  add_shares(result, values, comparison);
  return comparison;
}

// The shares of one family in the variance of every method that has layers.
Figure shares(const ContestResult& result, std::size_t family) {
  Figure figure;
  std::vector<const MethodResult*> methods;
  std::vector<int> colors;
  for (std::size_t i = 0; i < result.methods.size(); ++i)
    if (result.methods[i].attribution) methods.push_back(&result.methods[i]), colors.push_back(int(i));
  const FamilyShares& first = methods.front()->attribution->families[family];
  figure.name = "variance-by-" + first.name;
  std::ranges::replace(figure.name, ' ', '-');
  figure.caption = "Shares of the picture's variance by " + first.name + ", with 95 % bars over the repeats.";
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

void add_attribution(const ContestResult& result, Report& report) {
  const MethodResult* any = nullptr;
  std::string without;
  for (const MethodResult& m : result.methods) {
    if (m.attribution) any = &m;
    if (!m.contestant.layers) without += (without.empty() ? "" : ", ") + name_of(m);
  }
  if (any) {
    report.sections.push_back(
        Formula{"s_i = \\frac{\\operatorname{Cov}(L_i, L)}{\\operatorname{Var}(L)}, \\quad L = "
                "\\sum_i L_i, \\quad \\sum_i s_i = 1",
                "Shorrocks 1982, Inequality Decomposition by Factor Components"});
    report.sections.push_back(Text{
        "The light of a pass is the sum of layers, and this is the share of each in the variance of that sum, over "
        "all pixels and channels. A share below zero takes noise away from the others."});
    // One group of lights alone has all of it.
    for (std::size_t family = 0; family < any->attribution->families.size(); ++family)
      if (any->attribution->families[family].layers.size() > 1) report.sections.push_back(shares(result, family));
  }
  if (!without.empty())
    report.sections.push_back(
        Text{"Not attributed, since the method does not part its light into layers, or was not asked "
             "to: " +
             without + "."});
}

}  // namespace

ReportSet report_of(const ContestResult& result, const ContestWords& words) {
  Report report;
  report.name = "comparison", report.title = "Which method is better, and how sure that is";
  for (const std::string& sentence : words.sentences) report.sections.push_back(Text{sentence + "."});
  for (const std::string& note : words.notes) report.sections.push_back(Text{"Note: " + note + "."});
  report.sections.push_back(table_of_ratios(result));
  report.sections.push_back(pictures(result));
  report.sections.push_back(table_of_methods(result));
  report.sections.push_back(table_of_truth(result));
  add_attribution(result, report);
  if (has_slopes(result)) {
    report.sections.push_back(convergence(result, false));
    report.sections.push_back(convergence(result, true));
  }
  report.sections.push_back(repeats(result));
  report.sections.push_back(Text{fmt::format("Reference: {}; its own variance is {:.2g} of the smallest squared error.",
                                             result.reference.origin, result.reference_share)});
  report.sections.push_back(Commands{words.commands});
  return {"Comparison of methods", words.scene, {std::move(report)}};
}

}  // namespace montelux::lab
