// Transfer functions between linear values and the encoded values of files and displays.
#pragma once
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace montelux {

// The sRGB transfer function and its inverse (IEC 61966-2-1:1999), on [0, 1]; odd about zero, continued above one.
float srgb_encode(float linear);
float srgb_decode(float encoded);

// How stored values encode linear ones.
struct ColorEncoding {
  enum class Kind { linear, srgb, gamma };
  Kind kind = Kind::linear;
  // For gamma only: linear = encoded^exponent.
  float exponent = 1.0f;

  friend bool operator==(const ColorEncoding&, const ColorEncoding&) = default;
};

// Reads "linear", "sRGB" or "gamma X" with X > 0 (upper and lower case alike); nothing for any other text.
std::optional<ColorEncoding> parse_encoding(std::string_view text);
std::string to_string(const ColorEncoding& encoding);
float decode(const ColorEncoding& encoding, float encoded);
float encode(const ColorEncoding& encoding, float linear);

}  // namespace montelux
