#include "lab/statement/value_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace montelux::lab {
namespace {

// The decimal places at which two digits of the error are shown; the error may round up to one digit more.
int places_of(double error) {
  int places = 1 - int(std::floor(std::log10(error)));
  if (std::round(error * std::pow(10.0, places)) >= 100) --places;
  return places;
}

// A double has about 16 digits: no more places than these, for a value in [10^exponent, 10^(exponent + 1)).
int places_within(double error, int exponent) { return std::clamp(places_of(error), 0, std::max(0, 15 - exponent)); }

// The digits in brackets: the error in units of the last place, one at the least.
std::string digits_of(double error, int places) {
  return fmt::format("{:.0f}", std::max(1.0, std::round(error * std::pow(10.0, places))));
}

// To so many decimal places, which may be below zero: 541.1 to -1 place is "540".
std::string to_places(double value, int places) {
  if (!std::isfinite(value)) return value > 0 ? "any more" : value < 0 ? "any less" : "not known";
  if (places >= 0) return fmt::format("{:.{}f}", value, std::min(places, 12));
  const double unit = std::pow(10.0, -places);
  return fmt::format("{:.0f}", std::round(value / unit) * unit);
}

// Sizes that are not written in plain digits.
bool needs_exponent(double size) { return size > 0 && (size < 1e-3 || size >= 1e7); }

}  // namespace

std::string value_with_error(double value, double error) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  if (!std::isfinite(error)) return fmt::format("{:.6g}(?)", value);
  if (error <= 0) return fmt::format("{:.12g}(0)", value);
  const double size = std::max(std::abs(value), error);
  const int exponent = int(std::floor(std::log10(size)));
  // Plain digits for sizes that people read, and while the error is no whole number of many digits.
  if (exponent < -4 || exponent > 8 || error >= 100) {
    const double unit = std::pow(10.0, exponent);
    const double scaled = error / unit;
    const int places = places_within(scaled, 0);
    const std::string shown = scaled >= 0.95 ? fmt::format("{:.1f}", scaled) : digits_of(scaled, places);
    return fmt::format("{:.{}f}({})e{:+03d}", value / unit, places, shown, exponent);
  }
  const int places = places_within(error, exponent);
  if (places == 0) return fmt::format("{:.0f}({:.0f})", value, error);
  if (error >= 0.995) return fmt::format("{:.{}f}({:.{}f})", value, places, error, places);
  return fmt::format("{:.{}f}({})", value, places, digits_of(error, places));
}

std::string value_plus_minus(double value, double error) {
  if (!std::isfinite(value)) return "not known";
  if (!std::isfinite(error)) return fmt::format("{:.4g} (error not known)", value);
  if (error <= 0) return fmt::format("{:.4g} ± 0", value);
  const double size = std::max(std::abs(value), error);
  if (!needs_exponent(size)) {
    const int places = places_of(error);
    return fmt::format("{} ± {}", to_places(value, places), to_places(error, places));
  }
  const int exponent = int(std::floor(std::log10(size)));
  const double unit = std::pow(10.0, exponent);
  const int places = places_of(error / unit);
  return fmt::format("({} ± {})e{:+03d}", to_places(value / unit, places), to_places(error / unit, places), exponent);
}

std::string value_in_interval(double value, double low, double high) {
  if (!std::isfinite(value)) return "not known";
  const double below = value - low, above = high - value;
  const double nearer = std::min(std::isfinite(below) ? below : above, std::isfinite(above) ? above : below);
  if (!std::isfinite(nearer)) return fmt::format("{:.3g} (interval not known)", value);
  if (nearer <= 0) return fmt::format("{:.4g} ({:.4g} to {:.4g})", value, low, high);
  const double size = std::abs(value);
  if (!needs_exponent(size)) {
    const int places = places_of(nearer);
    return fmt::format("{} ({} to {})", to_places(value, places), to_places(low, places), to_places(high, places));
  }
  const int exponent = int(std::floor(std::log10(size)));
  const double unit = std::pow(10.0, exponent);
  const int places = places_of(nearer / unit);
  return fmt::format("{}e{:+03d} ({} to {})", to_places(value / unit, places), exponent, to_places(low / unit, places),
                     to_places(high / unit, places));
}

}  // namespace montelux::lab
