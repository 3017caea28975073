#include "lab/compare/report.h"

#include <fmt/format.h>

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
              "Means over the repeats, with their intervals; squared errors and FLIP of one repeat against the "
              "reference. Efficiency is 1 / (mse × seconds).",
              {"method", "mse", "relMSE", "FLIP", "seconds", "samples a pixel", "rays", "efficiency"},
              {}};
  for (const MethodResult& m : result.methods)
    table.rows.push_back({name_of(m), spread(m.mse), spread(m.relative_mse), spread(m.flip), spread(m.seconds),
                          m.samples.mean, fmt::format("{:.3g}", m.rays.mean), spread(m.efficiency)});
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

Comparison pictures(const ContestResult& result) {
  Comparison comparison{"pictures",
                        "The reference, and the mean of all repeats of each method. Under the pointer: values with "
                        "standard errors, and the luminance's running mean over the repeats with its 95 % band; the "
                        "dashed line is the reference.",
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
  return comparison;
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
  report.sections.push_back(convergence(result, false));
  report.sections.push_back(convergence(result, true));
  report.sections.push_back(repeats(result));
  report.sections.push_back(Text{fmt::format("Reference: {}; its own variance is {:.2g} of the smallest squared error.",
                                             result.reference.origin, result.reference_share)});
  report.sections.push_back(Commands{words.commands});
  return {"Comparison of methods", words.scene, {std::move(report)}};
}

}  // namespace montelux::lab
