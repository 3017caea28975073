// What a path carries: a radiance, a reflectance or a weight for each of a few wavelengths or primaries.
#pragma once
#include "math/functions.h"

namespace montelux {

// Red, green and blue of linear sRGB (Rec. 709 primaries, white D65). Transport code treats all components alike; only
// textures, emission and film assign a meaning to them.
inline constexpr int spectrum_size = 3;

template <class F>
struct Spectrum {
  F c[spectrum_size];

  MONTELUX_INLINE F& operator[](int i) { return c[i]; }
  MONTELUX_INLINE const F& operator[](int i) const { return c[i]; }
};

using Rgb = Spectrum<float>;

template <class F>
MONTELUX_INLINE Spectrum<F> gray(F x) {
  Spectrum<F> r;
  for (int i = 0; i < spectrum_size; ++i) r.c[i] = x;
  return r;
}
// Applies f to each component of the arguments.
template <class F, class Function, class... Others>
MONTELUX_INLINE Spectrum<F> per_component(Function f, const Spectrum<F>& a, const Others&... others) {
  Spectrum<F> r;
  for (int i = 0; i < spectrum_size; ++i) r.c[i] = f(a.c[i], others.c[i]...);
  return r;
}

// clang-format off
template <class F> MONTELUX_INLINE Spectrum<F> operator+(Spectrum<F> a, Spectrum<F> b) { return per_component([](F x, F y) { return x + y; }, a, b); }
template <class F> MONTELUX_INLINE Spectrum<F> operator-(Spectrum<F> a, Spectrum<F> b) { return per_component([](F x, F y) { return x - y; }, a, b); }
template <class F> MONTELUX_INLINE Spectrum<F> operator*(Spectrum<F> a, Spectrum<F> b) { return per_component([](F x, F y) { return x * y; }, a, b); }
template <class F> MONTELUX_INLINE Spectrum<F> operator*(Spectrum<F> a, std::type_identity_t<F> s) { return per_component([s](F x) { return x * s; }, a); }
template <class F> MONTELUX_INLINE Spectrum<F> operator*(std::type_identity_t<F> s, Spectrum<F> a) { return a * s; }
template <class F> MONTELUX_INLINE Spectrum<F> operator/(Spectrum<F> a, std::type_identity_t<F> s) { return per_component([s](F x) { return x / s; }, a); }
template <class F> MONTELUX_INLINE Spectrum<F>& operator+=(Spectrum<F>& a, Spectrum<F> b) { return a = a + b; }
template <class F> MONTELUX_INLINE Spectrum<F>& operator*=(Spectrum<F>& a, Spectrum<F> b) { return a = a * b; }
// clang-format on

template <class F>
MONTELUX_INLINE Spectrum<F> select(Mask<F> m, Spectrum<F> a, Spectrum<F> b) {
  Spectrum<F> r;
  for (int i = 0; i < spectrum_size; ++i) r.c[i] = select(m, a.c[i], b.c[i]);
  return r;
}
template <class F>
MONTELUX_INLINE F max_component(const Spectrum<F>& a) {
  F r = a.c[0];
  for (int i = 1; i < spectrum_size; ++i) r = max(r, a.c[i]);
  return r;
}
template <class F>
MONTELUX_INLINE F average(const Spectrum<F>& a) {
  F r = a.c[0];
  for (int i = 1; i < spectrum_size; ++i) r = r + a.c[i];
  return r * (1.0f / spectrum_size);
}
template <class F>
MONTELUX_INLINE Mask<F> is_black(const Spectrum<F>& a) {
  return max_component(a) <= F(0.0f);
}
// Luminance Y of linear sRGB (IEC 61966-2-1).
template <class F>
MONTELUX_INLINE F luminance(const Spectrum<F>& a) {
  return a.c[0] * 0.212639f + a.c[1] * 0.715169f + a.c[2] * 0.072192f;
}
// The same constant in every lane.
template <class F>
MONTELUX_INLINE Spectrum<F> splat(const Rgb& a) {
  Spectrum<F> r;
  for (int i = 0; i < spectrum_size; ++i) r.c[i] = F(a.c[i]);
  return r;
}
template <class F>
MONTELUX_INLINE Rgb lane(const Spectrum<F>& a, int k) {
  Rgb r;
  for (int i = 0; i < spectrum_size; ++i) r.c[i] = lane(a.c[i], k);
  return r;
}
template <class F>
MONTELUX_INLINE void set_lane(Spectrum<F>& a, int k, const Rgb& x) {
  for (int i = 0; i < spectrum_size; ++i) set_lane(a.c[i], k, x.c[i]);
}
// spectrum_size consecutive floats at base + i.
template <class F>
MONTELUX_INLINE Spectrum<F> gather_spectrum(const float* base, Uint<F> i) {
  Spectrum<F> r;
  for (int k = 0; k < spectrum_size; ++k) r.c[k] = gather(base + k, i);
  return r;
}

}  // namespace montelux
