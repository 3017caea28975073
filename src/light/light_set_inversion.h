// From rays that start at lights back to the numbers that draw them: bodies of LightSet's templates.
#pragma once
#include "light/light_set.h"

namespace montelux {

template <class F>
Vec2<F> LightSet::beyond_place_numbers(Vec3<F> p, Vec3<F> d) const {
  const Vec3<F> from_centre = (p - splat<F>(tables_.scene_centre)) * (1 / tables_.scene_radius);
  const Vec3<F> across = LocalFrame<F>::from_normal(d).to_local(from_centre);
  return invert_disk_concentric(Vec2<F>{across.x, across.y});
}

template <class F>
EmissionNumbers<F> LightSet::emission_numbers(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec3<F> d, Mask<F> on) const {
  EmissionNumbers<F> r{{F(0.0f), F(0.0f)}, {F(0.0f), F(0.0f)}};
  // Rounding may lead slightly past an end.
  const auto inside = [](const Vec2<F>& u) {
    return Vec2<F>{clamp(u.x, 0.0f, one_minus_epsilon), clamp(u.y, 0.0f, one_minus_epsilon)};
  };
  for_each_kind<F>(light, on, [&](LightKind kind, Mask<F> m) {
    const LightRows<F> row = rows<F>(light, m);
    if (is_surface(kind)) {
      with_emitter<F>(kind, row, [&](const auto& emitter) {
        const Vec2<F> place = inside(emitter.site_numbers(p));
        Vec2<F> direction = inside(invert_cosine_hemisphere(LocalFrame<F>::from_normal(n).to_local(d)));
        // A light with two sides spends half of the first number on each.
        const Mask<F> behind = dot(emitter.site(place).n, n) < F(0.0f);
        const F half = 0.5f * direction.x + select(behind, F(0.5f), F(0.0f));
        direction.x = select(row.flag(light_two_sided), half, direction.x);
        r.point = select(m, place, r.point), r.direction = select(m, direction, r.direction);
      });
    } else if (!is_unbounded(kind)) {
      with_point_light<F>(kind, row, images(), [&](const auto& point) {
        r.direction = select(m, inside(point.leaving_numbers(d, m)), r.direction);
      });
    } else {
      r.point = select(m, inside(beyond_place_numbers<F>(p, d)), r.point);
      with_unbounded_light<F>(kind, row, images(), [&](const auto& unbounded) {
        r.direction = select(m, inside(unbounded.numbers(-d, m)), r.direction);
      });
    }
  });
  return r;
}

}  // namespace montelux
