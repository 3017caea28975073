#include <algorithm>
#include <cmath>

#include "math/lanes.h"
#include "texture/texel_image.h"

namespace montelux {

float half_to_float(std::uint16_t bits) {
  std::uint32_t sign = std::uint32_t(bits & 0x8000u) << 16, rest = std::uint32_t(bits & 0x7fffu) << 13;
  // Infinities and NaNs keep their exponent of ones; else the difference of the exponents' biases is a factor.
  if ((bits & 0x7c00u) == 0x7c00u) return float_from_bits(sign | rest | 0x7f800000u);
  return float_from_bits(sign | float_bits(float_from_bits(rest) * 0x1p112f));
}

std::uint16_t float_to_half(float x) {
  auto sign = std::uint16_t((float_bits(x) >> 16) & 0x8000u);
  float magnitude = std::fabs(x);
  if (std::isnan(x)) return std::uint16_t(sign | 0x7e00u);
  if (magnitude >= 65520.0f) return std::uint16_t(sign | 0x7c00u);
  // The spacing of halves about the magnitude; rounding to a multiple of it is exact in float.
  int exponent = std::max(std::ilogb(std::max(magnitude, 0x1p-24f)), -14);
  auto steps = std::uint32_t(std::nearbyint(std::ldexp(magnitude, 10 - exponent)));
  // A carry of the significand correctly increments the exponent.
  return std::uint16_t(sign | (std::uint32_t(exponent + 14) * 1024u + steps));
}

}  // namespace montelux
