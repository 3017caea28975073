// Lights: what they send toward a point, with which density a point of them is drawn, and which light is chosen.
#pragma once
#include <array>
#include <string_view>

#include "color/spectrum.h"
#include "mc/density.h"

namespace montelux {

// A light of a LightSet, counted in the order in which the builder took them.
enum class LightId : std::uint32_t {};

// Every kind of light, in this order: surfaces that emit, lights in one point, lights without a place.
enum class LightKind : std::uint32_t {
  triangle,
  parallelogram,
  bilinear_patch,
  disk,
  sphere,
  cylinder,
  point,
  spot,
  goniometric,
  projection,
  distant,
  uniform_infinite,
  image_infinite
};
inline constexpr std::array<std::string_view, 13> light_kind_names{
    "triangle", "parallelogram", "bilinear patch", "disk",    "sphere",           "cylinder",      "point",
    "spot",     "goniometric",   "projection",     "distant", "uniform infinite", "image infinite"};

inline constexpr bool is_surface(LightKind k) { return k <= LightKind::cylinder; }
// Lights that send the same from everywhere: they have no bounds.
inline constexpr bool is_unbounded(LightKind k) { return k >= LightKind::distant; }
// Lights that a ray that leaves the scene meets.
inline constexpr bool is_infinite(LightKind k) { return k >= LightKind::uniform_infinite; }
// Lights that no ray meets: only sampling finds them.
inline constexpr bool is_delta(LightKind k) { return !is_surface(k) && !is_infinite(k); }

// How the light to sample is chosen: all alike, by power, or by a hierarchy that looks at the reference point.
enum class LightSelection { uniform, power, bvh };
inline constexpr std::array<std::string_view, 3> light_selection_names{"uniform", "power", "bvh"};

// In what the points of a surface that shines are drawn uniformly: in the solid angle under which they are seen, where
// the kind has a way to, or in area.
enum class LightMeasure { solid_angle, area };

struct LightSettings {
  LightSelection selection = LightSelection::bvh;
};

// Which light was chosen, and how probable that was.
template <class F>
struct LightChoice {
  Uint<F> light;
  Mass<F> mass;
  Mask<F> valid;  // no: there is no light, or none that reaches the point
};

// A direction toward a light, drawn at a reference point.
template <class F>
struct LightSample {
  Vec3<F> wi;                      // unit, from the reference point to the light
  F distance;                      // to the point of the light; infinite lights: beyond the scene
  Spectrum<F> radiance;            // arriving along wi if nothing is in the way; for a delta light, its irradiance at
                                   // normal incidence divided by the choice's probability
  Density<SolidAngle, F> density;  // of wi, the choice of the light included; 1 for a delta light
  Mask<F> valid;
  Mask<F> delta;  // point, spot, distant...: no other technique can find it
};

// What a ray that met a light finds there.
template <class F>
struct LightHit {
  Spectrum<F> radiance;            // toward the reference point
  Density<SolidAngle, F> density;  // with which sample() would have drawn this direction, the choice included
};

}  // namespace montelux
