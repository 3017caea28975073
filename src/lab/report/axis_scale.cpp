#include "lab/report/axis_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace montelux::lab {

namespace {

std::string superscript(int n) {
  constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = n < 0 ? "⁻" : "";
  for (char c : std::to_string(std::abs(n))) text += digits[std::size_t(c - '0')];
  return text;
}

std::string decade(int exponent) {
  if (exponent >= -2 && exponent <= 3) return fmt::format("{:g}", std::pow(10.0, exponent));
  return "10" + superscript(exponent);
}

std::vector<Tick> logarithmic_ticks(double low, double high) {
  const int first = int(std::floor(std::log10(low))), last = int(std::ceil(std::log10(high)));
  const bool few = std::log10(high / low) < 2.2;
  const int step = std::max(1, (last - first) / 7);
  const bool decades_alone = last - first > 5;
  std::vector<Tick> ticks;
  for (int e = first; e <= last; ++e)
    for (int digit = 1; digit < (decades_alone ? 2 : 10); ++digit) {
      const double value = digit * std::pow(10.0, e);
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      const bool named = digit == 1 ? e % step == 0 : few && (digit == 2 || digit == 5);
      if (!named && step > 1) continue;
      ticks.push_back({value, !named ? "" : digit == 1 ? decade(e) : fmt::format("{:g}", value)});
    }
  return ticks;
}

std::vector<Tick> linear_ticks(double low, double high) {
  const double raw = (high - low) / 6, unit = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = unit * (raw / unit < 1.5 ? 1 : raw / unit < 3.5 ? 2 : raw / unit < 7.5 ? 5 : 10);
  std::vector<Tick> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1)
    ticks.push_back({k * step, (k < 0 ? "−" : "") + fmt::format("{:.6g}", std::abs(k * step))});
  return ticks;
}

}  // namespace

double AxisScale::place(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return value > 0 ? std::log(value / low) / std::log(high / low) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Tick> AxisScale::ticks() const {
  if (!names.empty()) {
    std::vector<Tick> named;
    for (std::size_t i = 0; i < names.size(); ++i) named.push_back({double(i + 1), names[i]});
    return named;
  }
  return logarithmic ? logarithmic_ticks(low, high) : linear_ticks(low, high);
}

AxisScale scale_of(const Axis& axis, const std::vector<double>& values, bool from_zero) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (double v : values) {
    if (!std::isfinite(v) || (axis.logarithmic && v <= 0)) continue;
    low = std::min(low, v), high = std::max(high, v);
  }
  if (!(low <= high)) low = axis.logarithmic ? 0.1 : 0, high = 1;
  if (axis.logarithmic) {
    const double margin = std::max(std::pow(high / low, 0.04), 1.02);
    low /= margin, high *= margin;
  } else {
    if (from_zero) low = std::min(low, 0.0), high = std::max(high, 0.0);
    const double margin = high > low ? 0.04 * (high - low) : std::max(0.5 * std::abs(high), 0.5);
    low -= from_zero && low == 0 ? 0 : margin, high += margin;
  }
  return {axis.low.value_or(low), axis.high.value_or(high), axis.logarithmic, axis.names};
}

std::string plain_text(const std::string& text) {
  struct Change {
    const char *from, *to;
  };
  constexpr std::array<Change, 38> changes{{
      {"\\sigma", "σ"},  {"\\Omega", "Ω"}, {"\\omega", "ω"}, {"\\theta", "θ"}, {"\\phi", "φ"},
      {"\\alpha", "α"},  {"\\pi", "π"},    {"\\cos", "cos"}, {"\\sin", "sin"}, {"\\max", "max"},
      {"\\log", "log"},  {"\\sqrt", "√"},  {"\\int", "∫"},   {"\\sum", "Σ"},   {"\\times", "×"},
      {"\\cdot", "·"},   {"\\le", "≤"},    {"\\ge", "≥"},    {"\\infty", "∞"}, {"\\propto", "∝"},
      {"\\approx", "≈"}, {"\\hat", ""},    {"\\bar", ""},    {"\\mathrm", ""}, {"\\operatorname", ""},
      {"\\,", " "},      {"\\;", " "},     {"\\text", ""},   {"^2", "²"},      {"^3", "³"},
      {"^4", "⁴"},       {"^n", "ⁿ"},      {"^{-1}", "⁻¹"},  {"^{-2}", "⁻²"},  {"_0", "₀"},
      {"_1", "₁"},       {"_2", "₂"},      {"-", "−"},
  }};
  std::string plain;
  bool formula = false;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '$') {
      formula = !formula, ++i;
      continue;
    }
    const auto change = std::find_if(changes.begin(), changes.end(), [&](const Change& c) {
      return formula && text.compare(i, std::string_view(c.from).size(), c.from) == 0;
    });
    if (change != changes.end()) {
      plain += change->to, i += std::string_view(change->from).size();
      continue;
    }
    if (!formula || (text[i] != '{' && text[i] != '}' && text[i] != '\\')) plain += text[i];
    ++i;
  }
  return plain;
}

}  // namespace montelux::lab
