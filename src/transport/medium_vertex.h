// Vertices of a path within a participating medium. In a pack some lanes have one where others have a surface: these
// functions write it over the surface in the lanes that are on.
#pragma once
#include "scene/materials.h"
#include "scene/surface.h"
#include "transport/media.h"

namespace montelux {

// The kind of a vertex in a medium, which is no BsdfKind: it scatters by the phase function of the medium around it.
inline constexpr std::uint32_t in_medium_kind = 0xffffffffu;

// The vertex at o + t d: a point without extent and without a side, that emits nothing by itself.
template <class F>
MONTELUX_INLINE void put_medium_vertex(Mask<F> on, const Vec3<F>& o, const Vec3<F>& d, F t, SurfaceHit<F>& x) {
  const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
  x.point.p = select<F>(on, o + d * t, x.point.p);
  x.point.p_error = select<F>(on, zero, x.point.p_error);
  x.point.ng = select<F>(on, zero, x.point.ng), x.point.ns = select<F>(on, -d, x.point.ns);
  x.distance = select(on, t, x.distance);
  x.light = select(on, Uint<F>(0u), x.light), x.object = select(on, Uint<F>(0u), x.object);
  x.bounds_media = x.bounds_media & !on;
}

// The direction-independent part of its scattering. The frame is that of the world.
template <class F>
MONTELUX_INLINE void put_medium_scattering(Mask<F> on, SurfaceScattering<F>& s) {
  const F one(1.0f), none(0.0f);
  s.kind = select(on, Uint<F>(in_medium_kind), s.kind);
  s.frame = {select<F>(on, {one, none, none}, s.frame.s), select<F>(on, {none, one, none}, s.frame.t),
             select<F>(on, {none, none, one}, s.frame.n)};
  s.light_normal = select<F>(on, {none, none, none}, s.light_normal);
  s.is_interface = s.is_interface & !on, s.is_delta = s.is_delta & !on;
}

// The phase function toward one direction, and, as the next direction of the path, drawn from it. Directions are in the
// frame above.
template <class F>
MONTELUX_INLINE void put_phase_value(Mask<F> on, const PhaseFunction<F>& phase, const Vec3<F>& wo, const Vec3<F>& wi,
                                     BsdfValue<F>& value) {
  const Density<SolidAngle, F> density = phase.evaluate(wo, wi);
  value.f_cos = select(on, gray(density.value), value.f_cos);
  value.density = select(on, density, value.density);
}
template <class F>
MONTELUX_INLINE void put_phase_scattering(Mask<F> on, const PhaseFunction<F>& phase, const ScatterQuery<F>& query,
                                          Scattering<F>& s) {
  put_phase_value(on, phase, query.wo, query.wi_light, s.toward_light);
  const PhaseSample<F> next = phase.sample(query.wo, query.u2);
  s.next.wi = select<F>(on, next.wi, s.next.wi);
  s.next.weight = select(on, gray(F(1.0f)), s.next.weight);
  s.next.density = select(on, next.density, s.next.density);
  s.next.eta_scale = select(on, F(1.0f), s.next.eta_scale);
  s.next.delta = s.next.delta & !on, s.next.valid = s.next.valid | on;
}

}  // namespace montelux
