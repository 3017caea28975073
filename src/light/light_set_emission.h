// Rays that start at lights: bodies of LightSet's templates.
#pragma once
#include "light/light_set.h"

namespace montelux {

// ---- surfaces: a point by area, a direction by the cosine, on one side or on both --------------------------------

template <class F>
Density<SolidAngle, F> LightSet::surface_emission_density(const LightRows<F>& rows, Vec3<F> n, Vec3<F> d) {
  const F cos = dot(n, d);
  const Mask<F> both = rows.flag(light_two_sided);
  return {select(both, 0.5f * cosine_hemisphere_density(abs(cos)).value, cosine_hemisphere_density(cos).value)};
}

template <class F>
LightEmission<F> LightSet::emit_surface(LightKind kind, const LightRows<F>& rows, Vec2<F> u_point, Vec2<F> u_direction,
                                        Mask<F> on) const {
  LightEmission<F> r{};
  with_emitter<F>(kind, rows, [&](const auto& emitter) {
    const EmitterSite<F> site = emitter.site(u_point);
    const Mask<F> both = rows.flag(light_two_sided), behind = both & (u_direction.x >= F(0.5f));
    const F x = select(both, u_direction.x * 2.0f - select(behind, F(1.0f), F(0.0f)), u_direction.x);
    r.p = site.p, r.p_error = emitter.site_error();
    r.n = site.n * select(behind, F(-1.0f), F(1.0f));
    r.d = LocalFrame<F>::from_normal(r.n).to_world(sample_cosine_hemisphere(Vec2<F>{x, u_direction.y}));
    r.position = site.density, r.direction = surface_emission_density(rows, site.n, r.d);
    r.valid = on & !rows.flag(light_masked) & is_finite(r.position.value) & (r.position.value > F(0.0f)) &
              (dot(r.n, r.d) > F(0.0f));
    r.radiance = surface_emission(rows, site.uv, r.valid);
    // The cosine cancels.
    r.flux = r.radiance * (select(both, F(2.0f * pi), F(pi)) / r.position.value);
  });
  r.delta_position = r.delta_direction = Mask<F>(false);
  r.on_surface = Mask<F>(true), r.both_sides = rows.flag(light_two_sided);
  r.behind = r.both_sides & (u_direction.x >= F(0.5f));
  return r;
}

// ---- lights in one point ------------------------------------------------------------------------------------------

template <class F>
LightEmission<F> LightSet::emit_point(LightKind kind, const LightRows<F>& rows, Vec2<F> u, Mask<F> on) const {
  LightEmission<F> r{};
  with_point_light<F>(kind, rows, images(), [&](const auto& light) {
    const LeavingDirection<F> leaving = light.leave(u, on);
    r.d = leaving.d, r.direction = leaving.density;
    r.radiance = light.intensity(leaving.d, on), r.p = light.p;
  });
  r.n = r.d;
  r.position = {F(1.0f)};
  r.flux = r.radiance * (F(1.0f) / r.direction.value);
  r.valid = on & (r.direction.value > F(0.0f)) & is_finite(r.direction.value);
  r.delta_position = Mask<F>(true), r.delta_direction = r.on_surface = r.both_sides = r.behind = Mask<F>(false);
  return r;
}

// ---- lights without a position
// ---------------------------------------------------------------------------------------

template <class F>
Density<Area, F> LightSet::beyond_position_density() const {
  return {F(inv_pi / (tables_.scene_radius * tables_.scene_radius))};
}

template <class F>
LightEmission<F> LightSet::emit_beyond(LightKind kind, const LightRows<F>& rows, Vec2<F> u_point, Vec2<F> u_direction,
                                       Mask<F> on) const {
  LightEmission<F> r{};
  r.delta_position = r.on_surface = r.both_sides = r.behind = Mask<F>(false);
  r.delta_direction = Mask<F>(is_delta(kind));
  const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
  const LightSample<F> s = sample_kind(kind, rows, zero, zero, u_direction, on, LightMeasure::solid_angle);
  r.d = -s.wi, r.radiance = s.radiance, r.direction = s.density, r.valid = on & s.valid;
  r.n = r.d;
  const Vec2<F> disk = sample_disk_concentric(u_point);
  const Vec3<F> across = LocalFrame<F>::from_normal(r.d).to_world({disk.x, disk.y, F(-1.0f)});
  r.p = splat<F>(tables_.scene_centre) + across * tables_.scene_radius;
  r.position = beyond_position_density<F>();
  r.flux = r.radiance * (F(1.0f) / (r.position.value * select(r.valid, r.direction.value, F(1.0f))));
  return r;
}

// ---- any light ------------------------------------------------------------------------------------------------------

template <class F>
LightEmission<F> LightSet::emit(Uint<F> light, Vec2<F> u_point, Vec2<F> u_direction, Mask<F> on) const {
  const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)}, up{F(0.0f), F(0.0f), F(1.0f)};
  const Spectrum<F> black = gray(F(0.0f));
  const Mask<F> none(false);
  LightEmission<F> r{zero, zero, up, up, black, black, {F(1.0f)}, {F(1.0f)}, none, none, none, none, none, none};
  for_each_kind<F>(light, on, [&](LightKind kind, Mask<F> m) {
    const LightRows<F> row = rows<F>(light, m);
    const LightEmission<F> e = is_surface(kind)     ? emit_surface(kind, row, u_point, u_direction, m)
                               : is_unbounded(kind) ? emit_beyond(kind, row, u_point, u_direction, m)
                                                    : emit_point(kind, row, u_direction, m);
    const Mask<F> good = m & e.valid;
    r.p = select(good, e.p, r.p), r.p_error = select(good, e.p_error, r.p_error);
    r.n = select(good, e.n, r.n), r.d = select(good, e.d, r.d);
    r.radiance = select(good, e.radiance, r.radiance), r.flux = select(good, e.flux, r.flux);
    r.position = select(good, e.position, r.position);
    r.direction = select(good, e.direction, r.direction);
    r.valid = r.valid | good;
    r.delta_position = r.delta_position | (good & e.delta_position);
    r.delta_direction = r.delta_direction | (good & e.delta_direction);
    r.on_surface = r.on_surface | (good & e.on_surface), r.both_sides = r.both_sides | (good & e.both_sides);
    r.behind = r.behind | (good & e.behind);
  });
  return r;
}

template <class F>
EmissionDensities<F> LightSet::emission_densities(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec3<F> d, Mask<F> on) const {
  EmissionDensities<F> r{{F(1.0f)}, {F(1.0f)}, Mask<F>(false), Mask<F>(false)};
  const auto put = [&r](Mask<F> m, F position, F direction) {
    r.position.value = select(m, position, r.position.value);
    r.direction.value = select(m, direction, r.direction.value);
  };
  for_each_kind<F>(light, on, [&](LightKind kind, Mask<F> m) {
    const LightRows<F> row = rows<F>(light, m);
    if (!is_surface(kind) && !is_unbounded(kind)) r.delta_position = r.delta_position | m;
    if (is_unbounded(kind) && is_delta(kind)) r.delta_direction = r.delta_direction | m;
    if (is_surface(kind))
      with_emitter<F>(kind, row, [&](const auto& emitter) {
        const F position = emitter.site_density(p).value;
        const Mask<F> drawn = is_finite(position) & !row.flag(light_masked);
        put(m, select(drawn, position, F(0.0f)), surface_emission_density(row, n, d).value);
      });
    else if (!is_unbounded(kind))
      with_point_light<F>(kind, row, images(),
                          [&](const auto& point) { put(m, F(1.0f), point.leaving_density(d, m).value); });
    else
      with_unbounded_light<F>(kind, row, images(), [&](const auto& unbounded) {
        const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
        put(m, beyond_position_density<F>().value, unbounded.toward(zero, -d, m).density.value);
      });
  });
  return r;
}

}  // namespace montelux
