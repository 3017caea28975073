// The closed lists of lights that are surfaces and of lights at one point, in the order of LightKind.
#pragma once
#include <tuple>
#include <utility>

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

inline constexpr LightKind first_point_light = LightKind::point;
static_assert(std::tuple_size_v<SurfaceEmitters<float>> == std::size_t(first_point_light));
static_assert(std::size_t(first_point_light) + std::tuple_size_v<PointLights<float>> ==
              std::size_t(LightKind::distant));

template <class F>
inline constexpr bool all_are_lights = []<std::size_t... I, std::size_t... J>(std::index_sequence<I...>,
                                                                              std::index_sequence<J...>) {
  return (SurfaceEmitter<std::tuple_element_t<I, SurfaceEmitters<F>>, F> && ...) &&
         (PointLight<std::tuple_element_t<J, PointLights<F>>, F> && ...);
}
(std::make_index_sequence<std::tuple_size_v<SurfaceEmitters<F>>>(),
 std::make_index_sequence<std::tuple_size_v<PointLights<F>>>());
static_assert(all_are_lights<float> && all_are_lights<NativeFloats>);

// Calls f.template operator()<Type>() for the type at that place of a list.
template <class List, class Function>
MONTELUX_INLINE void with_type_at(std::size_t place, Function f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (void)((place == I && (f.template operator()<std::tuple_element_t<I, List>>(), true)) || ...);
  }
  (std::make_index_sequence<std::tuple_size_v<List>>());
}
// Calls f(emitter) with the surface, or with the light at a point, of the kind.
template <class F, class Function>
MONTELUX_INLINE void with_emitter(LightKind kind, const LightRows<F>& rows, Function f) {
  with_type_at<SurfaceEmitters<F>>(std::size_t(kind), [&]<class Emitter>() { f(Emitter(rows)); });
}
template <class F, class Function>
MONTELUX_INLINE void with_point_light(LightKind kind, const LightRows<F>& rows, const LightImages& images, Function f) {
  with_type_at<PointLights<F>>(std::size_t(kind) - std::size_t(first_point_light),
                               [&]<class Light>() { f(Light(rows, images)); });
}

}  // namespace montelux
