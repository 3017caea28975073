#include "lab/experiments/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/special.h"
#include "mc/moments.h"

namespace montelux::lab {

Spread spread_of(std::span<const double> values) {
  Moments moments, fourth_powers;
  for (double v : values) moments.add(v);
  for (double v : values) fourth_powers.add(std::pow(v - moments.mean, 4));
  if (moments.non_finite > 0) moments.mean = std::nan("");  // no check holds then
  const double variance = moments.variance();
  const double spread = std::max(0.0, fourth_powers.mean - variance * variance);
  return {moments.mean, moments.standard_error(), variance, std::sqrt(spread / double(moments.count)),
          double(moments.count)};
}

std::vector<double> realisations(const Setup& setup, std::uint32_t purpose, std::uint32_t count,
                                 const std::function<double(RandomStream<float>&)>& realise) {
  std::vector<double> values;
  values.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    RandomStream<float> stream = setup.stream(purpose, i);
    values.push_back(realise(stream));
  }
  return values;
}

Check z_check(std::string claim, double value, double error, double truth) {
  if (error == 0) return exact_check(std::move(claim), value == truth, fmt::format("{:.6g}, without spread", value));
  const double z = (value - truth) / error;
  return {std::move(claim), fmt::format("measured {}, expected {:.6g}, z = {:.2f}", with_error(value, error), truth, z),
          2 * special::normal_tail(std::abs(z))};
}

Check mean_check(std::string claim, const Spread& spread, double truth) {
  return z_check(std::move(claim), spread.mean, spread.mean_error, truth);
}
Check variance_check(std::string claim, const Spread& spread, double truth) {
  return z_check(std::move(claim), spread.variance, spread.variance_error, truth);
}

Check deviations_check(std::string claim, std::span<const double> z) {
  double sum = 0;
  for (double value : z) sum += value * value;
  return chi_square_check(std::move(claim), sum, double(z.size()));
}

Check chi_square_check(std::string claim, double chi_square, double degrees) {
  return {std::move(claim), fmt::format("chi-square = {:.1f} at {} degrees of freedom", chi_square, degrees),
          special::chi_square_tail(chi_square, degrees)};
}

Check largest_deviation_check(std::string claim, std::span<const double> z, std::string_view what) {
  double largest = 0;
  for (double value : z) largest = std::max(largest, std::abs(value));
  Check check = z_check(std::move(claim), largest, 1, 0);
  check.statistic = fmt::format("largest deviation {:.2f} standard errors over {} {}", largest, z.size(), what);
  check.p_value = std::min(1.0, check.p_value * double(z.size()));
  return check;
}

Check counts_check(std::string claim, std::span<const double> counts, std::span<const double> probabilities) {
  double total = 0, pooled_count = 0, pooled_expected = 0, chi_square = 0, cells = 0;
  for (double n : counts) total += n;
  const auto add = [&](double n, double expected) {
    chi_square += (n - expected) * (n - expected) / expected, ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = total * probabilities[i];
    if (expected < 5)
      pooled_count += counts[i], pooled_expected += expected;
    else
      add(counts[i], expected);
  }
  // What can never happen and did is reason enough.
  if (pooled_expected < 1e-9 * total && pooled_count > 0)
    return {std::move(claim), fmt::format("{} counts where none can be", pooled_count), 0};
  if (pooled_expected > 0) add(pooled_count, pooled_expected);
  return {std::move(claim),
          fmt::format("chi-square = {:.1f} at {} degrees of freedom, {} draws", chi_square, cells - 1, total),
          special::chi_square_tail(chi_square, std::max(1.0, cells - 1))};
}

Check exact_check(std::string claim, bool good, std::string why) {
  return {std::move(claim), std::move(why), good ? 1.0 : 0.0};
}

Check rejected(Check check) {
  check.to_reject = true;
  return check;
}

std::vector<double> counts_in_cells(std::span<const double> values, double low, double high, std::size_t cells) {
  std::vector<double> counts(cells);
  for (double v : values) {
    const double place = (v - low) / (high - low) * double(cells);
    counts[std::size_t(std::clamp(place, 0.0, double(cells - 1)))] += 1;
  }
  return counts;
}

std::vector<double> cell_probabilities(const std::function<double(double)>& cdf, double low, double high,
                                       std::size_t cells) {
  std::vector<double> probabilities;
  const double step = (high - low) / double(cells);
  for (std::size_t i = 0; i < cells; ++i)
    probabilities.push_back(cdf(low + step * double(i + 1)) - cdf(low + step * double(i)));
  return probabilities;
}

Curve histogram(std::string name, std::span<const double> counts, double low, double high) {
  Curve curve{std::move(name), Mark::bars, {}, {}, {}, {}};
  const double step = (high - low) / double(counts.size());
  double total = 0;
  for (double n : counts) total += n;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double scale = 1 / (total * step), error = std::sqrt(counts[i] * (1 - counts[i] / total));
    curve.x.push_back(low + step * (double(i) + 0.5)), curve.y.push_back(counts[i] * scale);
    curve.low.push_back((counts[i] - error) * scale), curve.high.push_back((counts[i] + error) * scale);
  }
  return curve;
}

Curve function_curve(std::string name, Mark mark, const std::function<double(double)>& f, double low, double high,
                     bool logarithmic, int points) {
  Curve curve{std::move(name), mark, {}, {}, {}, {}};
  for (int i = 0; i < points; ++i) {
    const double t = double(i) / (points - 1);
    const double x = logarithmic ? low * std::pow(high / low, t) : low + (high - low) * t;
    curve.x.push_back(x), curve.y.push_back(f(x));
  }
  return curve;
}

void add_expected(Figure& figure, Curve expected) {
  expected.color = color_of(figure, figure.curves.size() - 1);
  expected.name.clear();
  figure.curves.push_back(std::move(expected));
}

LineFit fit_power_law(std::span<const double> x, std::span<const double> y, std::span<const double> errors) {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double relative = errors[i] / y[i], weight = 1 / (relative * relative), a = std::log(x[i]),
                 b = std::log(y[i]);
    w += weight, wx += weight * a, wy += weight * b, wxx += weight * a * a, wxy += weight * a * b;
  }
  const double determinant = w * wxx - wx * wx, slope = (w * wxy - wx * wy) / determinant;
  return {slope, std::sqrt(w / determinant), (wy - slope * wx) / w};
}

double quadrature(const std::function<double(double)>& f, double a, double b, int panels) {
  // Positive nodes on [-1, 1] and their weights (Abramowitz and Stegun 1964, table 25.4).
  constexpr std::array<double, 4> nodes{0.183434642495650, 0.525532409916329, 0.796666477413627, 0.960289856497536};
  constexpr std::array<double, 4> weights{0.362683783378362, 0.313706645877887, 0.222381034453374, 0.101228536290376};
  const double half = 0.5 * (b - a) / panels;
  double sum = 0;
  for (int p = 0; p < panels; ++p) {
    const double middle = a + half * (2 * p + 1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sum += half * weights[i] * (f(middle - half * nodes[i]) + f(middle + half * nodes[i]));
  }
  return sum;
}

std::string with_error(double value, double error) {
  if (!(error > 0) || !std::isfinite(error)) return fmt::format("{:.6g}", value);
  // Two digits of the error, and the value to the same place.
  const int places = std::max(0, 1 - int(std::floor(std::log10(error))));
  if (places > 9 || error >= 100) return fmt::format("{:.6g} ± {:.2g}", value, error);
  return fmt::format("{:.{}f}({:.0f})", value, places, error * std::pow(10.0, places));
}

}  // namespace montelux::lab
