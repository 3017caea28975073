// Points of lights: implementation of LightSet's templates.
#pragma once
#include "light/light_set.h"

namespace montelux {

template <class F>
LightPointDraw<F> LightSet::draw_light_point(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec2<F> u, Mask<F> on) const {
  const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
  LightPointDraw<F> r{{zero, zero, gray(F(0.0f)), light, in_lanes<F>(LightPlace::surface)}, {F(1.0f)}, Mask<F>(false)};
  for_each_kind<F>(light, on, [&](LightKind kind, Mask<F> m) {
    const LightRows<F> row = rows<F>(light, m);
    if (is_surface(kind)) {
      with_emitter<F>(kind, row, [&](const auto& emitter) {
        const EmitterPoint<F> e = emitter.sample(p, u);
        const Mask<F> seen = meets_lit_side(row, e.n, direction_to(p, e.p)) & !row.flag(light_masked);
        const Mask<F> good = m & seen & is_finite(e.density.value) & (e.density.value > F(0.0f));
        r.point.p = select(good, e.p, r.point.p), r.point.n = select(good, e.n, r.point.n);
        r.point.radiance = select(good, surface_emission(row, e.uv, good), r.point.radiance);
        const Mask<F> both = row.flag(light_two_sided);
        r.point.place = select(good & both, in_lanes<F>(LightPlace::two_sided_surface), r.point.place);
        r.density = select(good, e.density, r.density);
        r.valid = r.valid | good;
      });
      return;
    }
    const LightSample<F> s = sample_kind(kind, row, p, n, u, m, LightMeasure::solid_angle);
    const Mask<F> good = m & s.valid;
    r.point.place = select(good, in_lanes<F>(is_delta(kind) ? LightPlace::delta : LightPlace::infinite), r.point.place);
    r.point.p = select(good, s.wi, r.point.p), r.point.radiance = select(good, s.radiance, r.point.radiance);
    r.density = select(good, s.density, r.density);
    r.valid = r.valid | good;
  });
  return r;
}

template <class F>
LightPoint<F> LightSet::point_of_hit(Uint<F> light, Vec3<F> p, Vec3<F> ng, Spectrum<F> radiance, Mask<F> on) const {
  const Mask<F> both = on & rows<F>(light, on).flag(light_two_sided);
  return {p, ng, radiance, light,
          select(both, in_lanes<F>(LightPlace::two_sided_surface), in_lanes<F>(LightPlace::surface))};
}

template <class F>
LightPosition<F> LightSet::position(Uint<F> light, Mask<F> on) const {
  LightPosition<F> r{{F(0.0f), F(0.0f), F(0.0f)}, Mask<F>(false)};
  for_each_kind<F>(light, on, [&](LightKind kind, Mask<F> m) {
    if (!is_at_point(kind)) return;
    with_point_light<F>(kind, rows<F>(light, m), images(),
                        [&](const auto& point) { r.p = select<F>(m, point.p, r.p), r.exists = r.exists | m; });
  });
  return r;
}

template <class F>
LightPointView<F> LightSet::view(const LightPoint<F>& point, Vec3<F> p, Vec3<F> n, Mask<F> on) const {
  const Mask<F> beyond = point.place == in_lanes<F>(LightPlace::infinite),
                delta = on & (point.place == in_lanes<F>(LightPlace::delta));
  const Vec3<F> d = point.p - p;
  const F d2 = max(length_squared(d), F(1e-30f)), distance = sqrt(d2);
  const Vec3<F> toward = d * (F(1.0f) / distance);
  const F cos = dot(point.n, toward);
  const Mask<F> lit = (cos < F(0.0f)) | (point.place == in_lanes<F>(LightPlace::two_sided_surface));
  LightPointView<F> r{select(beyond, point.p, toward), select(beyond, F(2.0f * tables_.scene_radius), distance),
                      point.radiance, select(beyond, F(1.0f), abs(cos) / d2), Mask<F>(on & !delta & (beyond | lit))};
  if (any(delta)) {
    const LightSample<F> s = sample_light(point.light, p, n, Vec2<F>{F(0.0f), F(0.0f)}, delta);
    r = {select(delta, s.wi, r.wi), select(delta, s.distance, r.distance), select(delta, s.radiance, r.radiance),
         select(delta, F(1.0f), r.geometry), Mask<F>(r.valid | (delta & s.valid))};
  }
  return r;
}

}  // namespace montelux
