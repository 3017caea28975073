// The closed lists of lights: surfaces, lights at one point and lights without a position, in the order of LightKind.
#pragma once
#include <tuple>
#include <utility>

#include "light/infinite.h"
#include "light/light.h"
#include "light/patch.h"
#include "light/point.h"
#include "light/quadric.h"
#include "light/triangle.h"

namespace montelux {

template <class F>
using SurfaceEmitters = std::tuple<TriangleEmitter<F>, ParallelogramEmitter<F>, BilinearPatchEmitter<F>, DiskEmitter<F>,
                                   SphereEmitter<F>, CylinderEmitter<F>>;
template <class F>
using PointLights = std::tuple<PointEmitter<F>, SpotEmitter<F>, GoniometricEmitter<F>, ProjectionEmitter<F>>;
// Those that no ray hits are first.
template <class F>
using UnboundedLights = std::tuple<DistantLight<F>, UniformInfinite<F>, ImageInfinite<F>>;

inline constexpr LightKind first_point_light = LightKind::point, first_unbounded_light = LightKind::distant;
static_assert(std::tuple_size_v<SurfaceEmitters<float>> == std::size_t(first_point_light));
static_assert(std::size_t(first_point_light) + std::tuple_size_v<PointLights<float>> ==
              std::size_t(first_unbounded_light));
static_assert(std::size_t(first_unbounded_light) + std::tuple_size_v<UnboundedLights<float>> ==
              light_kind_names.size());

template <class F, class... Emitter>
constexpr bool are_surface_emitters(std::tuple<Emitter...>*) {
  return (SurfaceEmitter<Emitter, F> && ...);
}
template <class F, class... Light>
constexpr bool are_point_lights(std::tuple<Light...>*) {
  return (PointLight<Light, F> && ...);
}
// Also that the kinds of those that no ray hits are those of is_delta().
template <class F, class... Light>
constexpr bool are_unbounded_lights(std::tuple<Light...>*) {
  std::size_t kind = std::size_t(first_unbounded_light);
  return ((UnboundedLight<Light, F> && Light::is_delta == is_delta(LightKind(kind++))) && ...);
}
template <class F>
inline constexpr bool all_are_lights = are_surface_emitters<F>(static_cast<SurfaceEmitters<F>*>(nullptr)) &&
                                       are_point_lights<F>(static_cast<PointLights<F>*>(nullptr)) &&
                                       are_unbounded_lights<F>(static_cast<UnboundedLights<F>*>(nullptr));
static_assert(all_are_lights<float> && all_are_lights<NativeFloats>);

// Calls f.template operator()<Type>() for the type at that place of a list.
template <class List, class Function>
MONTELUX_INLINE void with_type_at(std::size_t place, Function f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (void)((place == I && (f.template operator()<std::tuple_element_t<I, List>>(), true)) || ...);
  }
  (std::make_index_sequence<std::tuple_size_v<List>>());
}
// Calls f(light) with the surface, the light at a point, or the light without a position, of the kind.
template <class F, class Function>
MONTELUX_INLINE void with_emitter(LightKind kind, const LightRows<F>& rows, Function f) {
  with_type_at<SurfaceEmitters<F>>(std::size_t(kind), [&]<class Emitter>() { f(Emitter(rows)); });
}
template <class F, class Function>
MONTELUX_INLINE void with_point_light(LightKind kind, const LightRows<F>& rows, const LightImages& images, Function f) {
  with_type_at<PointLights<F>>(std::size_t(kind) - std::size_t(first_point_light),
                               [&]<class Light>() { f(Light(rows, images)); });
}
template <class F, class Function>
MONTELUX_INLINE void with_unbounded_light(LightKind kind, const LightRows<F>& rows, const LightImages& images,
                                          Function f) {
  with_type_at<UnboundedLights<F>>(std::size_t(kind) - std::size_t(first_unbounded_light),
                                   [&]<class Light>() { f(Light(rows, images)); });
}

}  // namespace montelux
