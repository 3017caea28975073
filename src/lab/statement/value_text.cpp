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

}  // namespace montelux::lab
