// Colours that are stored or shown: texels, parameters as stated, the film, pictures.
#pragma once
#include "color/components.h"

namespace montelux {

inline constexpr int rgb_size = 3;

// Red, green and blue of linear sRGB (Rec. 709 primaries, white D65).
template <class F>
struct RgbOf {
  F c[rgb_size];

  MONTELUX_INLINE F& operator[](int i) { return c[i]; }
  MONTELUX_INLINE const F& operator[](int i) const { return c[i]; }
};
template <>
inline constexpr int component_count<RgbOf> = rgb_size;

using Rgb = RgbOf<float>;

constexpr Rgb gray_rgb(float x) { return {{x, x, x}}; }

// Luminance Y of linear sRGB (IEC 61966-2-1).
template <class F>
MONTELUX_INLINE F luminance(const RgbOf<F>& a) {
  return a.c[0] * 0.212639f + a.c[1] * 0.715169f + a.c[2] * 0.072192f;
}

}  // namespace montelux
