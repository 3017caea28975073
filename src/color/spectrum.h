// What a path carries: a radiance, a reflectance or a weight for each of a few wavelengths or primaries.
#pragma once
#include "color/rgb.h"

namespace montelux {

// Transport code treats all components alike; only from_rgb() and to_rgb() assign a meaning to them: the first three
// are red, green and blue of linear sRGB. A build with a fourth one (MONTELUX_SPECTRUM_SIZE) shows that no transport
// code counts on three. The fourth is a second green: from_rgb() copies it, every operation on components keeps the two
// equal, and to_rgb() ignores it. Choices that depend on several components (roulette, the distance to an event in a
// medium) then weigh green twice; they are as valid, and images stay unbiased.
inline constexpr int spectrum_size = MONTELUX_SPECTRUM_SIZE;
static_assert(spectrum_size == rgb_size || spectrum_size == rgb_size + 1);

template <class F>
struct Spectrum {
  F c[spectrum_size];

  MONTELUX_INLINE F& operator[](int i) { return c[i]; }
  MONTELUX_INLINE const F& operator[](int i) const { return c[i]; }
};
template <>
inline constexpr int component_count<Spectrum> = spectrum_size;

// The only ways between colours and what paths carry. In: looked-up textures, emission, parameters of materials and
// media. Out: samples of pixels, layers of light and splats.
template <class F>
MONTELUX_INLINE Spectrum<F> from_rgb(const RgbOf<F>& a) {
  constexpr int green = 1;
  Spectrum<F> r;
  for (int i = 0; i < spectrum_size; ++i) r.c[i] = a.c[i < rgb_size ? i : green];
  return r;
}
template <class F>
MONTELUX_INLINE RgbOf<F> to_rgb(const Spectrum<F>& a) {
  RgbOf<F> r;
  for (int i = 0; i < rgb_size; ++i) r.c[i] = a.c[i];
  return r;
}

template <class F>
MONTELUX_INLINE Spectrum<F> gray(F x) {
  Spectrum<F> r;
  for (int i = 0; i < spectrum_size; ++i) r.c[i] = x;
  return r;
}

}  // namespace montelux
