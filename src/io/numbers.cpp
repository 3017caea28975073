#include "io/numbers.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace montelux {

namespace {

std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

// Plain decimals with few digits, as in most meshes: if the digits and the power of ten are both exact as floats,
// one division rounds correctly (Clinger 1990). No value for all others.
std::optional<float> short_decimal(std::string_view text) {
  static constexpr std::array<float, 11> powers{1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f, 1e8f, 1e9f, 1e10f};
  constexpr std::uint32_t max_digits = 1u << 24;
  bool negative = text[0] == '-';
  std::uint32_t digits = 0;
  std::size_t fraction = 0, count = 0;
  bool after_point = false;
  for (char c : text.substr(negative ? 1 : 0)) {
    unsigned digit = static_cast<unsigned>(c - '0');
    if (digit <= 9) {
      digits = digits * 10 + digit, fraction += after_point, ++count;
      if (digits > max_digits) return std::nullopt;
    } else if (c == '.' && !after_point) {
      after_point = true;
    } else {
      return std::nullopt;
    }
  }
  if (count == 0 || fraction >= powers.size()) return std::nullopt;
  float value = static_cast<float>(digits) / powers[fraction];
  return negative ? -value : value;
}

template <class T>
std::string to_text(T value) {
  std::array<char, 40> buffer;
  auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), result.ptr);
}

}  // namespace

std::optional<double> to_double(std::string_view text) {
  text = without_plus(text);
  double value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // Too small counts as zero; the sign of the exponent distinguishes it from too large.
    std::size_t exponent = text.find_first_of("eE");
    bool tiny = exponent != std::string_view::npos && exponent + 1 < text.size() && text[exponent + 1] == '-';
    return tiny ? std::optional<double>(0.0) : std::nullopt;
  }
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<float> to_float(std::string_view text) {
  std::string_view digits = without_plus(text);
  if (digits.empty()) return std::nullopt;
  if (auto value = short_decimal(digits)) return value;
  float value = 0;
  auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size() && std::isfinite(value)) return value;
  // Outside the range of normal floats: converted through double.
  auto wide = to_double(text);
  if (!wide || std::abs(*wide) > static_cast<double>(std::numeric_limits<float>::max())) return std::nullopt;
  return static_cast<float>(*wide);
}

std::optional<int> to_integer(std::string_view text) {
  text = without_plus(text);
  int value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string shortest(float value) { return to_text(value); }
std::string shortest(double value) { return to_text(value); }

}  // namespace montelux
