// From what a contest has gathered to what it says.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/compare/contest.h"
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
double efficiency_of(const Repeat& r) { return 1 / (r.mse * r.seconds); }
double relative_efficiency_of(const Repeat& r) { return 1 / (r.relative_mse * r.seconds); }
double whole_efficiency_of(const Repeat& r) { return 1 / (r.mse * r.all_seconds); }
double whole_relative_efficiency_of(const Repeat& r) { return 1 / (r.relative_mse * r.all_seconds); }

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
  m.efficiency = of(efficiency_of);
  m.relative_efficiency = of(relative_efficiency_of);
  m.whole_efficiency = of(whole_efficiency_of);
  m.whole_relative_efficiency = of(whole_relative_efficiency_of);
}

// The mean over pixels of the squared bias. The errors of two repeats are independent, so their product has the squared
// bias for its mean, and the reference's variance, which is taken off. The jackknife over repeats gives its error.
Measured squared_bias(const std::vector<std::vector<float>>& repeats, const Reference& reference, double confidence) {
  const double n = double(repeats.size());
  if (n < 3) return measured({}, confidence);
  constexpr double weights[] = {0.2126, 0.7152, 0.0722};
  const std::size_t pixels = reference.mean.pixel_count();
  std::vector<double> own(repeats.size()), with_sum(repeats.size());
  double all = 0, known = 0;
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
  return measured(pseudo, confidence);
}

// The mean of the image against the reference's, by the spread of the repeats' image means: right whatever the
// correlation between pixels.
WelchScale test_of_image_means(const MethodResult& m, const Reference& reference, double level) {
  const double n = double(m.repeats.size()), pixels = double(reference.mean.pixel_count());
  WelchScale worst;
  worst.tests = 3;
  for (std::size_t c = 0; c < 3; ++c) {
    Moments means;
    for (const Repeat& r : m.repeats) means.add(r.image_mean[c]);
    double truth = 0, variance = 0;
    for (std::size_t p = 0; p < reference.mean.pixel_count(); ++p) {
      truth += double(reference.mean.values[3 * p + c]) / pixels;
      variance += double(reference.variance.values[3 * p + c]) / (pixels * pixels);
    }
    if (reference.variance_of_image) variance = (*reference.variance_of_image)[c];
    const double error = std::sqrt(means.variance() / n + variance), difference = means.mean - truth;
    const double t = difference == 0 ? 0 : difference / error, p_value = 2 * student_t_cdf(-std::abs(t), n - 1);
    if (c > 0 && !(p_value < worst.smallest_p)) continue;
    worst.smallest_p = p_value, worst.t = t, worst.difference = difference, worst.channel = int(c);
    worst.detectable = student_t_quantile(1 - level / (2 * 3), n - 1) * error;
  }
  worst.differs = worst.smallest_p < level / 3;
  return worst;
}

// All repeats together against the reference: is the mean another?
void summarize_film(const MethodState& state, const Reference& reference, MethodResult& m) {
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
  if (m.repeats.size() >= 2) m.bias.image = test_of_image_means(m, reference, 0.01 / 3);
  m.non_finite = state.non_finite;
}

PairVerdict judge(const ContestResult& result, std::size_t a, std::size_t b, double confidence) {
  const MethodResult &first = result.methods[a], &second = result.methods[b];
  PairVerdict v;
  v.first = a, v.second = b;
  const auto ratio_of = [&](double (*value)(const Repeat&)) {
    return measured_ratio(column(first, value), column(second, value), confidence);
  };
  v.ratio = ratio_of(efficiency_of);
  v.relative_ratio = ratio_of(relative_efficiency_of);
  v.whole_ratio = ratio_of(whole_efficiency_of);
  v.whole_relative_ratio = ratio_of(whole_relative_efficiency_of);
  v.decided = v.ratio.count >= 2 && (v.ratio.low > 1 || v.ratio.high < 1);
  if (!v.decided && v.ratio.count >= 2) {
    // The half width shrinks with the root of the number of repeats, and must come below the distance from one.
    const double half = 0.5 * std::log(v.ratio.high / v.ratio.low), distance = std::abs(std::log(v.ratio.mean));
    v.times_longer = distance > 0 ? (half / distance) * (half / distance) : std::numeric_limits<double>::infinity();
  }
  return v;
}

}  // namespace

bool differs_from_reference(const MethodResult& m) {
  const Measured& b = m.bias_squared;
  const bool by_pixel = b.count >= 3 && b.mean > student_t_quantile(0.9995, b.count - 1.0) * b.standard_error;
  return m.bias.image.differs || by_pixel;
}

ContestResult result_of(const std::vector<Contestant>& contestants, const ContestState& state,
                        const ContestSettings& settings) {
  ContestResult result;
  result.reference = state.reference;
  result.warm_up_counts = settings.render.warm_up_counts;
  double smallest_mse = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    const MethodState& gathered = state.methods[i];
    MethodResult& method = result.methods.emplace_back();
    method.contestant = contestants[i];
    method.repeats = gathered.repeats;
    method.luminance = gathered.luminance;
    if (method.repeats.empty()) continue;
    summarize(method, settings.confidence);
    summarize_convergence(gathered.convergence, settings.confidence, method);
    summarize_film(gathered, result.reference, method);
    if (method.contestant.layers && !gathered.attribution.empty())
      method.attribution = attribution_of(*method.contestant.layers, gathered.attribution, gathered.pixel_shares,
                                          {method.mean.width, method.mean.height, settings.confidence});
    if (method.mse.mean > 0) smallest_mse = std::min(smallest_mse, method.mse.mean);
  }
  result.reference_share = mean_value(result.reference.variance) / smallest_mse;
  for (std::size_t a = 0; a < contestants.size(); ++a)
    for (std::size_t b = a + 1; b < contestants.size(); ++b)
      result.verdicts.push_back(judge(result, a, b, settings.confidence));
  return result;
}

}  // namespace montelux::lab
