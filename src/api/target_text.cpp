#include "api/target_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "api/render.h"

namespace montelux {

namespace {

// "2%" as 0.02.
std::optional<double> percentage(std::string_view text) {
  if (!text.ends_with('%')) return std::nullopt;
  text.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value / 100;
}

Failure invalid(const std::string& text) {
  return {fmt::format(
      "takes an error in percent: 2% of the pixels (root of the mean square), pixels:5%@95% (95 % of the "
      "pixels within 5 %), mean:0.1% (of the mean of the image) or denoised:2% (as 2%, of the image without "
      "noise); found \"{}\"",
      text)};
}

}  // namespace

Result<ErrorTarget> parse_target(const std::string& text) {
  ErrorTarget target;
  std::string_view error = text;
  if (error.starts_with("mean:")) {
    target.measure = TargetMeasure::mean;
    error.remove_prefix(5);
  } else if (error.starts_with("denoised:")) {
    target.measure = TargetMeasure::denoised;
    error.remove_prefix(9);
  } else if (error.starts_with("pixels:")) {
    target.measure = TargetMeasure::pixels;
    error.remove_prefix(7);
    const std::size_t at = error.find('@');
    const auto share = at == error.npos ? std::nullopt : percentage(error.substr(at + 1));
    if (!share) return invalid(text);
    if (!(*share >= 0.5 && *share < 1))
      return Failure{fmt::format("the share of the pixels is from 50% to less than 100%; found \"{}\"", text)};
    target.share = *share;
    error = error.substr(0, at);
  }
  const std::optional<double> value = percentage(error);
  if (!value) return invalid(text);
  if (!(*value >= 1e-6 && *value <= 1))
    return Failure{fmt::format("the error is from 0.0001% to 100%; found \"{}\"", text)};
  target.error = *value;
  return target;
}

std::string to_text(const ErrorTarget& target) {
  const std::string error = fmt::format("{:.6g}%", 100 * target.error);
  switch (target.measure) {
    case TargetMeasure::pixels:
      return fmt::format("pixels:{}@{:.6g}%", error, 100 * target.share);
    case TargetMeasure::mean:
      return "mean:" + error;
    case TargetMeasure::denoised:
      return "denoised:" + error;
    default:
      return error;
  }
}

std::string why_not_reached(const TargetResult& target) {
  if (!target.state.is_known) return "unknown: it takes two passes of every pixel, and light";
  return "no";
}

}  // namespace montelux
