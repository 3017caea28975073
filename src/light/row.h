// How one light is stored: a row of numbers that packs gather from. Slots after the common ones depend on the kind.
#pragma once
#include <algorithm>
#include <bit>
#include <concepts>

#include "light/light.h"
#include "math/transform.h"
#include "parameter/slots.h"

namespace montelux {

// Slots that all kinds share.
namespace light_slot {
inline constexpr int emission = 0;  // radiance, or intensity, or irradiance, with the scale; factor of an image
inline constexpr int flags = spectrum_size;  // bits below
inline constexpr int image = flags + 1;      // bits: number of the image + 1, or 0
inline constexpr int transform = image + 1;  // bits: number of the transform
inline constexpr int shape = transform + 1;  // first slot of the kind's own
static_assert(fill_slots(0, shape, {{emission, spectrum_size}, {flags, 1}, {image, 1}, {transform, 1}}));
}  // namespace light_slot

inline constexpr int light_row_size = 32;
// Whether a kind's own parameters, in the order of their slots, take every slot up to `end` once, and a row has that
// many.
constexpr bool fill_light_row(int end, std::initializer_list<SlotRange> parameters) {
  return fill_slots(light_slot::shape, end, parameters) && end <= light_row_size;
}

struct alignas(64) LightRow {
  float v[light_row_size] = {};

  void set(int slot, float x) { v[slot] = x; }
  void set(int slot, Vec2f a) { v[slot] = a.x, v[slot + 1] = a.y; }
  void set(int slot, Vec3f a) { v[slot] = a.x, v[slot + 1] = a.y, v[slot + 2] = a.z; }
  void set_emission(const Rgb& a) {
    const Spectrum<float> e = from_rgb(a);
    std::copy(e.c, e.c + spectrum_size, v + light_slot::emission);
  }
  Spectrum<float> emission() const {
    Spectrum<float> e;
    std::copy_n(v + light_slot::emission, spectrum_size, e.c);
    return e;
  }
  void set_bits(int slot, std::uint32_t x) { v[slot] = std::bit_cast<float>(x); }
};

inline constexpr std::uint32_t light_two_sided = 1;  // emits on both sides
inline constexpr std::uint32_t light_flipped = 2;    // the normal is the negative of the shape's own
inline constexpr std::uint32_t light_special = 4;    // meaning depends on the kind: a right-angled or a whole one
inline constexpr std::uint32_t light_masked = 8;     // has holes, which light sampling does not know: it is not sampled

// A map from a light's own space to the world and back: two times twelve numbers, each the rows of a 3 x 4 matrix.
inline constexpr int light_transform_size = 32;
struct alignas(64) LightTransform {
  float v[light_transform_size] = {};
};
inline LightTransform light_transform(const Transform& to_world) {
  LightTransform t;
  std::copy(to_world.rows().begin(), to_world.rows().end(), t.v);
  std::copy(to_world.inverse_rows().begin(), to_world.inverse_rows().end(), t.v + 12);
  return t;
}

// The transforms of all lanes.
template <class F>
struct LightTransforms {
  const float* base;
  Uint<F> offset;

  MONTELUX_INLINE F at(int i) const { return gather(base + i, offset); }
  MONTELUX_INLINE Vec3<F> row(int i) const { return {at(i), at(i + 1), at(i + 2)}; }
  MONTELUX_INLINE Vec3<F> point_to_world(Vec3<F> p) const { return rotate(0, p) + Vec3<F>{at(3), at(7), at(11)}; }
  // A bound of |point_to_world(p)| where no component of p exceeds `reach`; of the sum's terms, too.
  MONTELUX_INLINE Vec3<F> absolute_point_to_world(Vec3<F> reach) const {
    return {dot(abs(row(0)), reach) + abs(at(3)), dot(abs(row(4)), reach) + abs(at(7)),
            dot(abs(row(8)), reach) + abs(at(11))};
  }
  MONTELUX_INLINE Vec3<F> point_to_light(Vec3<F> p) const { return rotate(12, p) + Vec3<F>{at(15), at(19), at(23)}; }
  // How much a solid angle about the unit direction d of the light's space grows on its way to the world.
  MONTELUX_INLINE F solid_angle_growth(Vec3<F> d) const {
    const F l = length(direction_to_world(d));
    return abs(dot(row(0), cross(row(4), row(8)))) / (l * l * l);
  }
  MONTELUX_INLINE Vec3<F> direction_to_world(Vec3<F> d) const { return rotate(0, d); }
  MONTELUX_INLINE Vec3<F> direction_to_light(Vec3<F> d) const { return rotate(12, d); }
  // By the inverse transpose; not normalised.
  MONTELUX_INLINE Vec3<F> normal_to_world(Vec3<F> n) const { return row(12) * n.x + row(16) * n.y + row(20) * n.z; }

 private:
  MONTELUX_INLINE Vec3<F> rotate(int first, Vec3<F> d) const {
    return {dot(row(first), d), dot(row(first + 4), d), dot(row(first + 8), d)};
  }
};

// The rows of the lights of all lanes.
template <class F>
struct LightRows {
  const LightRow* rows;
  const LightTransform* transforms;  // of all lights that have one
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
  // Only for lights of a kind that has one.
  MONTELUX_INLINE LightTransforms<F> transform() const {
    return {transforms->v, Uint<F>(bits(light_slot::transform) * std::uint32_t(light_transform_size))};
  }
  MONTELUX_INLINE Mask<F> has_image() const { return bits(light_slot::image) != Uint<F>(0u); }
  MONTELUX_INLINE Mask<F> flag(std::uint32_t bit) const {
    return (bits(light_slot::flags) & Uint<F>(bit)) != Uint<F>(0u);
  }
};

// A point sampled on an emitting surface.
template <class F>
struct EmitterPoint {
  Vec3<F> p;
  Vec3<F> n;                       // unit, on the side that emits
  Vec2<F> uv;                      // where an image of the emission is looked up
  Density<SolidAngle, F> density;  // at the reference point
};

// A point drawn on an emitting surface without a reference point.
template <class F>
struct EmitterSite {
  Vec3<F> p;
  Vec3<F> n;   // unit, on the side that emits
  Vec2<F> uv;  // where an image of the emission is looked up
  Density<Area, F> density;
};

// The interface of every emitting surface, made from its row: a point sampled from a reference point, and the density
// at the reference point with which sample() samples the point p in the unit direction wi; a point sampled by area
// alone, the density with which site() samples p, the numbers with which it does, and a bound of the rounding error of
// its coordinates. The density of a direction is that of the surface's first point along it; for convex surfaces with
// one or two emitting sides.
template <class Emitter, class F>
concept SurfaceEmitter = requires(const Emitter& e, Vec3<F> p, Vec2<F> u) {
  Emitter(LightRows<F>{});
  { e.sample(p, u) } -> std::same_as<EmitterPoint<F>>;
  { e.density(p, p, p) } -> std::same_as<Density<SolidAngle, F>>;
  { e.site(u) } -> std::same_as<EmitterSite<F>>;
  { e.site_numbers(p) } -> std::same_as<Vec2<F>>;
  { e.site_density(p) } -> std::same_as<Density<Area, F>>;
  { e.site_error() } -> std::same_as<Vec3<F>>;
};

}  // namespace montelux
