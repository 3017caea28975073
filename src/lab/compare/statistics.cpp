#include "lab/compare/statistics.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "lab/statement/value_text.h"
#include "mc/confidence.h"
#include "mc/moments.h"

namespace montelux::lab {

Measured measured(const std::vector<double>& all, double confidence) {
  Moments moments;
  for (double v : all) moments.add(v);  // leaves out what is not finite
  const double n = double(moments.count), infinite = std::numeric_limits<double>::infinity();
  Measured m;
  m.count = int(moments.count), m.mean = moments.mean;
  if (moments.count < 2) return {m.mean, -infinite, infinite, infinite, m.count};
  m.standard_error = moments.standard_error();
  const double half = student_t_quantile(0.5 + 0.5 * confidence, n - 1) * m.standard_error;
  m.low = m.mean - half, m.high = m.mean + half;
  return m;
}

std::string text_of(const Measured& m) {
  if (m.count == 0) return "not known";
  return m.count == 1 ? fmt::format("{:.4g} (one repeat)", m.mean) : value_plus_minus(m.mean, m.high - m.mean);
}

Measured measured_ratio(const std::vector<double>& a, const std::vector<double>& b, double confidence) {
  std::vector<double> logs;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
    if (a[i] > 0 && b[i] > 0 && std::isfinite(a[i]) && std::isfinite(b[i])) logs.push_back(std::log(a[i] / b[i]));
  const Measured m = measured(logs, confidence);
  if (logs.empty()) return {std::nan(""), 0, std::numeric_limits<double>::infinity(), 0, 0};
  return {std::exp(m.mean), std::exp(m.low), std::exp(m.high), m.standard_error, m.count};
}

Measured measured_ratio_of_sums(const std::vector<double>& a, const std::vector<double>& b, double confidence) {
  double sum_a = 0, sum_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum_a += a[i], sum_b += b[i];
  const double whole = sum_a / sum_b, n = double(a.size());
  if (a.size() < 2) return measured({whole}, confidence);
  std::vector<double> pseudo;
  for (std::size_t i = 0; i < a.size(); ++i) pseudo.push_back(n * whole - (n - 1) * (sum_a - a[i]) / (sum_b - b[i]));
  Measured m = measured(pseudo, confidence);
  // Centred on the ratio itself, so that the shares of a whole sum to one.
  m.low += whole - m.mean, m.high += whole - m.mean, m.mean = whole;
  return m;
}

double log_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, mx = 0, my = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] > 0 && y[i] > 0) n += 1, mx += std::log(x[i]), my += std::log(y[i]);
  if (n < 2) return std::nan("");
  mx /= n, my /= n;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] > 0 && y[i] > 0) {
      const double dx = std::log(x[i]) - mx;
      xx += dx * dx, xy += dx * (std::log(y[i]) - my);
    }
  return xy / xx;
}

}  // namespace montelux::lab
