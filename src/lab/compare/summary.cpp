// From the state of a comparison to its results.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/compare/comparison.h"
#include "mc/confidence.h"
#include "mc/moments.h"

namespace montelux::lab {

namespace {

void summarize_convergence(const std::vector<ConvergenceRun>& runs, double confidence, MethodResult& method) {
  std::vector<double> by_samples, by_time;
  std::size_t levels = runs.empty() ? 0 : runs.front().samples.size();
  for (const ConvergenceRun& run : runs) levels = std::min(levels, run.samples.size());
  for (std::size_t level = 0; level < levels; ++level) {
    std::vector<double> mse, seconds;
    for (const ConvergenceRun& run : runs) mse.push_back(run.mse[level]), seconds.push_back(run.seconds[level]);
    method.convergence.push_back(
        {runs.front().samples[level], measured(mse, confidence), measured(seconds, confidence)});
  }
  if (levels < 3) return;
  for (const ConvergenceRun& run : runs) {
    by_samples.push_back(log_slope(run.samples, run.mse));
    by_time.push_back(log_slope(run.seconds, run.mse));
  }
  method.slope_by_samples = measured(by_samples, confidence);
  method.slope_by_time = measured(by_time, confidence);
}

std::vector<double> column(const MethodResult& method, double (*value)(const Repeat&)) {
  std::vector<double> values;
  for (const Repeat& r : method.repeats) values.push_back(value(r));
  return values;
}
// For each repeat, 1 / (error x seconds); without a value if the error is zero or negative.
std::vector<double> efficiencies(const MethodResult& method, ErrorMeasure measure, double Repeat::*seconds) {
  std::vector<double> values;
  for (const Repeat& r : method.repeats) {
    const double cost = squared_error_by(measure, r) * (r.*seconds);
    values.push_back(cost > 0 ? 1 / cost : std::nan(""));
  }
  return values;
}

void summarize(MethodResult& m, double confidence) {
  const auto of = [&](double (*value)(const Repeat&)) { return measured(column(m, value), confidence); };
  m.seconds = of([](const Repeat& r) { return r.seconds; });
  m.all_seconds = of([](const Repeat& r) { return r.all_seconds; });
  m.warm_up = of([](const Repeat& r) { return r.warm_up; });
  m.rays = of([](const Repeat& r) { return r.rays; });
  m.samples = of([](const Repeat& r) { return r.samples; });
  m.mse = of([](const Repeat& r) { return r.mse; });
  m.relative_mse = of([](const Repeat& r) { return r.relative_mse; });
  m.flip = of([](const Repeat& r) { return r.flip; });
  m.variance = of([](const Repeat& r) { return r.variance; });
  m.coverage = of([](const Repeat& r) { return r.coverage; });
  for (ErrorMeasure measure : error_measures) {
    m.efficiency[measure] = measured(efficiencies(m, measure, &Repeat::seconds), confidence);
    m.whole_efficiency[measure] = measured(efficiencies(m, measure, &Repeat::all_seconds), confidence);
  }
}

// The mean over pixels of the squared bias. The errors of two repeats are independent, so the mean of their product is
// the squared bias plus the reference's variance, which is subtracted. The error is that of the jackknife over repeats
// plus that of the reference: its squared error at a pixel has a variance of about twice its squared variance, the
// subtracted variance is itself an estimate, and what all pixels have in common does not average out.
Measured squared_bias(const std::vector<std::vector<float>>& repeats, const Reference& reference, double confidence) {
  const double n = double(repeats.size());
  if (n < 3) return measured({}, confidence);
  constexpr double weights[] = {0.2126, 0.7152, 0.0722};
  const std::size_t pixels = reference.mean.pixel_count();
  std::vector<double> own(repeats.size()), with_sum(repeats.size());
  double all = 0, known = 0, known_spread = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    double truth = 0, deviation = 0, sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      truth += weights[c] * double(reference.mean.values[3 * p + c]);
      deviation += weights[c] * std::sqrt(double(reference.variance.values[3 * p + c]));
    }
    for (const auto& repeat : repeats) sum += double(repeat[p]) - truth;
    for (std::size_t r = 0; r < repeats.size(); ++r) {
      const double off = double(repeats[r][p]) - truth;
      own[r] += off * off / double(pixels), with_sum[r] += off * sum / double(pixels);
    }
    all += sum * sum / double(pixels), known += deviation * deviation / double(pixels);
    known_spread += 2 * std::pow(deviation, 4) / double(pixels) / double(pixels);
  }
  double squares = 0;
  for (double x : own) squares += x;
  const double whole = (all - squares) / (n * (n - 1)) - known;
  // Without repeat r: the sum of the others' errors, and their squares.
  std::vector<double> pseudo;
  for (std::size_t r = 0; r < repeats.size(); ++r) {
    const double rest = all - 2 * with_sum[r] + own[r] - (squares - own[r]);
    pseudo.push_back(n * whole - (n - 1) * (rest / ((n - 1) * (n - 2)) - known));
  }
  Measured squared = measured(pseudo, confidence);
  if (reference.degrees_of_freedom > 0) known_spread *= 1 + 1 / reference.degrees_of_freedom;
  double common = 0;
  for (std::size_t c = 0; reference.variance_of_image && c < 3; ++c)
    common += weights[c] * std::sqrt((*reference.variance_of_image)[c]);
  known_spread += 2 * std::pow(common, 4);
  const double half_widths = squared.standard_error > 0 ? (squared.high - squared.mean) / squared.standard_error : 0;
  squared.standard_error = std::sqrt(squared.standard_error * squared.standard_error + known_spread);
  squared.low = squared.mean - half_widths * squared.standard_error;
  squared.high = squared.mean + half_widths * squared.standard_error;
  return squared;
}

// The complete passes of all repeats as one sample of image means, for one channel: passes are independent, so their
// spread is valid for any correlation between pixels. Repeats with unknown passes count as one pass each.
Moments image_means(const MethodResult& m, std::size_t channel) {
  const bool by_pass = std::ranges::all_of(m.repeats, [](const Repeat& r) { return r.passes > 0; });
  Moments all;
  for (const Repeat& r : m.repeats) {
    Moments one;
    one.count = by_pass ? std::uint64_t(r.passes) : 1, one.mean = r.image_mean[channel];
    const double n = double(one.count);
    if (one.count > 1) one.m2 = r.image_error[channel] * r.image_error[channel] * n * (n - 1);
    all.merge(one);
  }
  return all;
}

std::array<MeanDifference, 3> image_differences(const MethodResult& m, const Reference& reference) {
  const double pixels = double(reference.mean.pixel_count());
  std::array<MeanDifference, 3> differences;
  for (std::size_t c = 0; c < 3; ++c) {
    const Moments means = image_means(m, c);
    double truth = 0, variance = 0;
    for (std::size_t p = 0; p < reference.mean.pixel_count(); ++p) {
      truth += double(reference.mean.values[3 * p + c]) / pixels;
      variance += double(reference.variance.values[3 * p + c]) / (pixels * pixels);
    }
    if (reference.variance_of_image) variance = (*reference.variance_of_image)[c];
    const double n = double(means.count);
    const double own = n < 2 ? std::numeric_limits<double>::infinity() : means.variance() / n;
    differences[c] = {means.mean - truth, own, n - 1, variance, reference.degrees_of_freedom};
  }
  return differences;
}

// All repeats together against the reference: does the mean differ?
void summarize_film(const MethodState& state, const Reference& reference, double level, MethodResult& m) {
  m.mean = make_pixel_buffer(reference.mean.width, reference.mean.height, {"R", "G", "B"});
  m.standard_error = m.mean;
  for (std::size_t p = 0; p < state.pixels.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c) {
      m.mean.values[3 * p + c] = float(state.pixels[p].mean[c]);
      m.standard_error.values[3 * p + c] = float(state.pixels[p].variance_of_mean(int(c)));
    }
  m.bias_squared = squared_bias(m.luminance, reference, 0.95);
  for (float& v : m.standard_error.values) v = std::sqrt(v);
  PixelBuffer reference_error = reference.variance;
  for (float& v : reference_error.values) v = std::sqrt(v);
  m.bias = welch_test({m.mean, m.standard_error, double(state.passes - 1)},
                      {reference.mean, reference_error, reference.degrees_of_freedom}, 0.01);
  m.agreement = judge_agreement(image_differences(m, reference), m.bias_squared, int(m.repeats.size()), level);
  m.non_finite = state.non_finite;
}

Likeness likeness_of(const MethodResult& a, const MethodResult& b) {
  if (!a.compared_method.settings.empty() && a.compared_method.settings == b.compared_method.settings &&
      a.compared_method.sampler == b.compared_method.sampler)
    return Likeness::settings;
  const bool equal = !a.luminance.empty() && a.luminance == b.luminance && a.mean.values == b.mean.values;
  return equal ? Likeness::pictures : Likeness::none;
}

PairVerdict judge(const ComparisonResult& result, std::size_t a, std::size_t b, double confidence) {
  const MethodResult &first = result.methods[a], &second = result.methods[b];
  PairVerdict v;
  v.first = a, v.second = b, v.likeness = likeness_of(first, second);
  for (ErrorMeasure measure : error_measures) {
    const auto ratio_of = [&](double Repeat::*seconds) {
      return measured_ratio(efficiencies(first, measure, seconds), efficiencies(second, measure, seconds), confidence);
    };
    v.ratio[measure] = ratio_of(&Repeat::seconds), v.whole_ratio[measure] = ratio_of(&Repeat::all_seconds);
  }
  const Measured& ratio = v.ratio[result.measure];
  v.decided = v.likeness != Likeness::settings && winner_of(ratio) != 0;
  if (!v.decided && ratio.count >= 2) {
    // The half-width decreases with the root of the number of repeats, and must fall below the distance from one.
    const double half = 0.5 * std::log(ratio.high / ratio.low), distance = std::abs(std::log(ratio.mean));
    v.times_longer = distance > 0 ? (half / distance) * (half / distance) : std::numeric_limits<double>::infinity();
  }
  return v;
}

}  // namespace

double squared_error_by(ErrorMeasure measure, const Repeat& r) {
  switch (measure) {
    case ErrorMeasure::relative_mse:
      return r.relative_mse;
    case ErrorMeasure::mse:
      return r.mse;
    case ErrorMeasure::flip:
      return r.flip * r.flip;
  }
  return std::nan("");
}

double variance_by(ErrorMeasure measure, const Reference& reference) {
  if (measure == ErrorMeasure::mse) return mean_value(reference.variance);
  double sum = 0;
  for (std::size_t i = 0; i < reference.mean.values.size(); ++i) {
    const double mean = double(reference.mean.values[i]);
    sum += double(reference.variance.values[i]) / (mean * mean + 0.01);
  }
  return sum / double(reference.mean.values.size());
}

int winner_of(const Measured& ratio) {
  if (ratio.count < 2) return 0;
  return ratio.low > 1 ? 1 : ratio.high < 1 ? -1 : 0;
}

ComparisonResult result_of(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                           const ComparisonSettings& settings) {
  ComparisonResult result;
  result.reference = state.reference;
  result.warm_up_counts = settings.warm_up_counts, result.measure = settings.measure;
  // For all tests of all methods together.
  const double level = level_of_each_test(0.01, compared_methods.size());
  double smallest_mse = std::numeric_limits<double>::infinity(), smallest_relative = smallest_mse;
  for (std::size_t i = 0; i < compared_methods.size(); ++i) {
    const MethodState& gathered = state.methods[i];
    MethodResult& method = result.methods.emplace_back();
    method.compared_method = compared_methods[i];
    method.repeats = gathered.repeats;
    method.luminance = gathered.luminance;
    if (method.repeats.empty()) continue;
    summarize(method, settings.confidence);
    summarize_convergence(gathered.convergence, settings.confidence, method);
    summarize_film(gathered, result.reference, level, method);
    if (method.compared_method.layers && !gathered.attribution.empty())
      method.attribution = attribution_of(*method.compared_method.layers, gathered.attribution, gathered.pixel_shares,
                                          {method.mean.width, method.mean.height, settings.confidence});
    if (method.mse.mean > 0) smallest_mse = std::min(smallest_mse, method.mse.mean);
    if (method.relative_mse.mean > 0) smallest_relative = std::min(smallest_relative, method.relative_mse.mean);
  }
  const auto share = [&](ErrorMeasure measure, double smallest) {
    const double variance = variance_by(measure, result.reference);
    if (variance == 0) return 0.0;
    // No error above zero: the noise of the reference explains everything.
    return std::isfinite(smallest) ? variance / smallest : std::numeric_limits<double>::infinity();
  };
  result.reference_share[ErrorMeasure::mse] = share(ErrorMeasure::mse, smallest_mse);
  result.reference_share[ErrorMeasure::relative_mse] = result.reference_share[ErrorMeasure::flip] =
      std::max(share(ErrorMeasure::relative_mse, smallest_relative), result.reference_share[ErrorMeasure::mse]);
  for (std::size_t a = 0; a < compared_methods.size(); ++a)
    for (std::size_t b = a + 1; b < compared_methods.size(); ++b)
      result.verdicts.push_back(judge(result, a, b, settings.confidence));
  return result;
}

}  // namespace montelux::lab
