// How one light is stored: a row of numbers that packs gather from. The slots after the common ones are the kind's own.
#pragma once
#include <bit>
#include <concepts>

#include "light/light.h"

namespace montelux {

inline constexpr int light_row_size = 32;
struct alignas(64) LightRow {
  float v[light_row_size] = {};

  void set(int slot, float x) { v[slot] = x; }
  void set(int slot, Vec2f a) { v[slot] = a.x, v[slot + 1] = a.y; }
  void set(int slot, Vec3f a) { v[slot] = a.x, v[slot + 1] = a.y, v[slot + 2] = a.z; }
  void set(int slot, const Rgb& a) {
    for (int i = 0; i < spectrum_size; ++i) v[slot + i] = a.c[i];
  }
  void set_bits(int slot, std::uint32_t x) { v[slot] = std::bit_cast<float>(x); }
};

// Slots that all kinds share.
namespace light_slot {
inline constexpr int emission = 0;   // radiance, or intensity, or irradiance, the scale included; factor of an image
inline constexpr int flags = 3;      // bits below
inline constexpr int image = 4;      // bits: number of the image + 1, or 0
inline constexpr int transform = 5;  // bits: number of the transform
inline constexpr int shape = 6;      // first slot of the kind's own
}  // namespace light_slot

inline constexpr std::uint32_t light_two_sided = 1;  // emits on both sides
inline constexpr std::uint32_t light_flipped = 2;    // the normal is the negative of the shape's own
inline constexpr std::uint32_t light_special = 4;    // the kind says what: a right-angled or a whole one

// The rows of the lights of all lanes.
template <class F>
struct LightRows {
  const LightRow* rows;
  Uint<F> light;

  MONTELUX_INLINE F number(int slot) const {
    return gather(rows->v + slot, Uint<F>(light * std::uint32_t(light_row_size)));
  }
  MONTELUX_INLINE Vec2<F> vec2(int slot) const { return {number(slot), number(slot + 1)}; }
  MONTELUX_INLINE Vec3<F> vec3(int slot) const { return {number(slot), number(slot + 1), number(slot + 2)}; }
  MONTELUX_INLINE Uint<F> bits(int slot) const { return float_bits(number(slot)); }
  MONTELUX_INLINE Spectrum<F> emission() const {
    Spectrum<F> s;
    for (int i = 0; i < spectrum_size; ++i) s.c[i] = number(light_slot::emission + i);
    return s;
  }
  MONTELUX_INLINE Mask<F> flag(std::uint32_t bit) const {
    return (bits(light_slot::flags) & Uint<F>(bit)) != Uint<F>(0u);
  }
};

// A point drawn on an emitting surface.
template <class F>
struct EmitterPoint {
  Vec3<F> p;
  Vec3<F> n;                       // unit, on the side that emits
  Vec2<F> uv;                      // where an image of the emission is looked up
  Density<SolidAngle, F> density;  // at the reference point
};

// What every emitting surface offers, made from its row: a point seen from a reference point, and the density at the
// reference point with which sample() draws the point p, where the unit direction wi leads to. The density of a
// direction is that of the surface's first point along it; convex surfaces of one side, or both where two-sided.
template <class Emitter, class F>
concept SurfaceEmitter = requires(const Emitter& e, Vec3<F> p, Vec2<F> u) {
  Emitter(LightRows<F>{});
  { e.sample(p, u) } -> std::same_as<EmitterPoint<F>>;
  { e.density(p, p, p) } -> std::same_as<Density<SolidAngle, F>>;
};

}  // namespace montelux
