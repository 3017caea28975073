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

}  // namespace

std::string value_with_error(double value, double error) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  if (!std::isfinite(error)) return fmt::format("{:.6g}(?)", value);
  if (error <= 0) return fmt::format("{:.12g}(0)", value);
  // Below this a double has no digits.
  error = std::max(error, 1e-15 * std::abs(value));
  const double size = std::max(std::abs(value), error);
  const int exponent = int(std::floor(std::log10(size)));
  // Plain digits for sizes that people read, and while the error is no whole number of many digits.
  if (exponent < -4 || exponent > 8 || error >= 100) {
    const double unit = std::pow(10.0, exponent);
    const int places = std::max(0, places_of(error / unit));
    const double scaled = error / unit;
    const std::string shown =
        scaled >= 0.95 ? fmt::format("{:.1f}", scaled) : fmt::format("{:.0f}", scaled * std::pow(10.0, places));
    return fmt::format("{:.{}f}({})e{:+03d}", value / unit, places, shown, exponent);
  }
  const int places = std::max(0, places_of(error));
  if (places == 0) return fmt::format("{:.0f}({:.0f})", value, error);
  if (error >= 0.995) return fmt::format("{:.{}f}({:.{}f})", value, places, error, places);
  return fmt::format("{:.{}f}({:.0f})", value, places, error * std::pow(10.0, places));
}

}  // namespace montelux::lab
