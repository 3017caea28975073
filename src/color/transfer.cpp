#include "color/transfer.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace montelux {

float srgb_encode(float linear) {
  float x = std::fabs(linear);
  float y = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
  return std::copysign(y, linear);
}

float srgb_decode(float encoded) {
  float x = std::fabs(encoded);
  float y = x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
  return std::copysign(y, encoded);
}

std::optional<ColorEncoding> parse_encoding(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (lower == "linear") return ColorEncoding{};
  if (lower == "srgb") return ColorEncoding{ColorEncoding::Kind::srgb, 1.0f};
  if (lower.rfind("gamma", 0) != 0) return std::nullopt;

  std::string_view number = std::string_view(lower).substr(5);
  number.remove_prefix(std::min(number.find_first_not_of(' '), number.size()));
  float exponent = 0.0f;
  auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), exponent);
  if (error != std::errc() || end != number.data() + number.size() || !(exponent > 0.0f) || !std::isfinite(exponent))
    return std::nullopt;
  return ColorEncoding{ColorEncoding::Kind::gamma, exponent};
}

std::string to_string(const ColorEncoding& encoding) {
  switch (encoding.kind) {
    case ColorEncoding::Kind::linear:
      return "linear";
    case ColorEncoding::Kind::srgb:
      return "sRGB";
    case ColorEncoding::Kind::gamma:
      break;
  }
  char digits[32];
  auto [end, error] = std::to_chars(digits, digits + sizeof digits, encoding.exponent);
  return "gamma " + std::string(digits, end);
}

float decode(const ColorEncoding& encoding, float encoded) {
  if (encoding.kind == ColorEncoding::Kind::srgb) return srgb_decode(encoded);
  if (encoding.kind == ColorEncoding::Kind::gamma) return std::pow(std::max(encoded, 0.0f), encoding.exponent);
  return encoded;
}

float encode(const ColorEncoding& encoding, float linear) {
  if (encoding.kind == ColorEncoding::Kind::srgb) return srgb_encode(linear);
  if (encoding.kind == ColorEncoding::Kind::gamma) return std::pow(std::max(linear, 0.0f), 1.0f / encoding.exponent);
  return linear;
}

}  // namespace montelux
