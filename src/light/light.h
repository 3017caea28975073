// Lights: what they emit towards a point, the density with which a point of them is sampled, and which light is chosen.
#pragma once
#include <array>
#include <string_view>

#include "color/spectrum.h"
#include "mc/density.h"

namespace montelux {

// The number of a light in a LightSet, in the order in which the builder received them.
enum class LightId : std::uint32_t {};

// Every kind of light, in this order: emitting surfaces, lights at one point, lights without a position.
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
// Lights whose emission is the same at every point: they have no bounds.
inline constexpr bool is_unbounded(LightKind k) { return k >= LightKind::distant; }
// Lights that are hit by rays that leave the scene.
inline constexpr bool is_infinite(LightKind k) { return k >= LightKind::uniform_infinite; }
// Lights that no ray hits: only sampling finds them.
inline constexpr bool is_delta(LightKind k) { return !is_surface(k) && !is_infinite(k); }

inline constexpr bool is_at_point(LightKind k) { return is_delta(k) && !is_unbounded(k); }

// How the light to sample is chosen: uniformly, by power, or by a hierarchy that depends on the reference point.
enum class LightSelection { uniform, power, bvh };
inline constexpr std::array<std::string_view, 3> light_selection_names{"uniform", "power", "bvh"};

// The measure in which points of an emitting surface are sampled uniformly: the solid angle under which they are seen,
// if the kind supports it, or area.
enum class LightMeasure { solid_angle, area };

struct LightSettings {
  LightSelection selection = LightSelection::bvh;
};

// The chosen light, and its probability.
template <class F>
struct LightChoice {
  Uint<F> light;
  Mass<F> mass;
  Mask<F> valid;  // false: there is no light, or none that reaches the point
};

// A direction towards a light, sampled at a reference point.
template <class F>
struct LightSample {
  Vec3<F> wi;                      // unit, from the reference point to the light
  F distance;                      // to the point of the light; infinite lights: beyond the scene
  Spectrum<F> radiance;            // arriving along wi if unoccluded; for a delta light, its irradiance at
                                   // normal incidence divided by the probability of the choice
  Density<SolidAngle, F> density;  // of wi, including the choice of the light; 1 for a delta light
  Mask<F> valid;
  Mask<F> delta;     // point, spot, distant...: no other technique can find it
  Mask<F> infinite;  // from infinity, and not delta
};

// What a ray that hit a light finds there.
template <class F>
struct LightHit {
  Spectrum<F> radiance;            // towards the reference point
  Density<SolidAngle, F> density;  // with which sample() would have sampled this direction, including the choice
};

}  // namespace montelux
