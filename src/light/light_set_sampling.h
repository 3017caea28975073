// Sampling of lights and what rays find on them: implementation of LightSet's templates.
#pragma once
#include "light/light_set.h"

namespace montelux {

template <class F, class Function>
void LightSet::for_each_kind(Uint<F> light, Mask<F> on, Function f) const {
  if (!any(on)) return;
  Uint<F> kinds = gather(tables_.kinds.data(), select(on, light, Uint<F>(0u)));
  while (any(on)) {
    std::uint32_t k = lane(kinds, std::countr_zero(bits(on)));
    Mask<F> same = on & (kinds == Uint<F>(k));
    f(LightKind(k), same);
    on = on & !same;
  }
}

template <class F>
Spectrum<F> LightSet::surface_emission(const LightRows<F>& rows, Vec2<F> uv, Mask<F> on) const {
  Spectrum<F> e = rows.emission();
  if (tables_.images.empty()) return e;
  Uint<F> image = rows.bits(light_slot::image);
  for_each_lane(Mask<F>(on & (image != Uint<F>(0u))), [&](int k) {
    // Images have their origin at the top, surfaces at the bottom.
    Vec2f at = lane(uv, k);
    set_lane(e, k, lane(e, k) * from_rgb(tables_.images[lane(image, k) - 1]->bilinear({at.x, 1 - at.y})));
  });
  return e;
}

// A point of a surface; only kinds that can be sampled by solid angle have two ways.
template <class Emitter, class F>
EmitterPoint<F> draw_point(const Emitter& emitter, Vec3<F> from, Vec2<F> u, LightMeasure measure) {
  if constexpr (requires { emitter.sample_by_area(from, u); })
    if (measure == LightMeasure::area) return emitter.sample_by_area(from, u);
  return emitter.sample(from, u);
}

template <class F>
LightSample<F> LightSet::sample_kind(LightKind kind, const LightRows<F>& rows, Vec3<F> p, Vec3<F> n, Vec2<F> u,
                                     Mask<F> on, LightMeasure measure) const {
  LightSample<F> r{};
  r.valid = Mask<F>(false), r.delta = Mask<F>(is_delta(kind)), r.infinite = Mask<F>(is_infinite(kind));
  if (is_surface(kind)) {
    with_emitter<F>(kind, rows, [&](const auto& emitter) {
      EmitterPoint<F> e = draw_point(emitter, p, u, measure);
      Vec3<F> d = e.p - p;
      r.distance = length(d);
      r.wi = d * (F(1.0f) / max(r.distance, F(1e-37f)));
      Mask<F> seen = meets_lit_side(rows, e.n, r.wi);
      r.radiance = surface_emission(rows, e.uv, Mask<F>(on & seen));
      r.density = e.density;
      r.valid = on & seen & !rows.flag(light_masked) & (e.density.value > F(0.0f)) & is_finite(e.density.value);
    });
    return r;
  }
  if (!is_unbounded(kind)) return sample_point_light(kind, rows, p, on);
  with_unbounded_light<F>(kind, rows, images_from_places(), [&](const auto& light) {
    const UnboundedSample<F> s = light.sample(n, u, on);
    r.wi = s.wi, r.distance = F(2.0f * tables_.scene_radius);
    r.radiance = rows.emission() * s.factor, r.density = s.density;
    r.valid = on & !is_black(r.radiance) & (r.density.value > F(0.0f));
  });
  return r;
}

template <class F>
LightSample<F> LightSet::sample_point_light(LightKind kind, const LightRows<F>& rows, Vec3<F> p, Mask<F> on) const {
  LightSample<F> r{};
  with_point_light<F>(kind, rows, images(), [&](const auto& light) {
    Vec3<F> d = light.p - p;
    F d2 = max(length_squared(d), F(1e-30f));
    r.distance = sqrt(d2);
    r.wi = d * (F(1.0f) / r.distance);
    r.radiance = light.intensity(-r.wi, on) * (F(1.0f) / d2);
  });
  r.density = {F(1.0f)};
  r.delta = Mask<F>(true), r.infinite = Mask<F>(false);
  r.valid = on & !is_black(r.radiance);
  return r;
}

template <class F>
LightSample<F> LightSet::sample_light(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec2<F> u, Mask<F> on,
                                      LightMeasure measure) const {
  LightSample<F> r{};
  r.wi = {F(0.0f), F(0.0f), F(1.0f)};
  r.distance = F(1.0f), r.radiance = gray(F(0.0f)), r.density = {F(0.0f)};
  r.valid = r.delta = r.infinite = Mask<F>(false);
  const auto take = [&](const LightSample<F>& s, Mask<F> m) {
    Mask<F> good = m & s.valid;
    r.wi = select(good, s.wi, r.wi), r.distance = select(good, s.distance, r.distance);
    r.radiance = select(good, s.radiance, r.radiance);
    r.density = select(good, s.density, r.density);
    r.valid = r.valid | good, r.delta = r.delta | (good & s.delta), r.infinite = r.infinite | (good & s.infinite);
  };
  if (sky_) {
    const Mask<F> from_sky = on & (light == Uint<F>(std::uint32_t(light_of_sky_)));
    if (any(from_sky)) take(sample_sky(p, n, u, from_sky), from_sky);
    on = on & !from_sky;
  }
  for_each_kind<F>(light, on, [&](LightKind kind, Mask<F> m) {
    take(sample_kind(kind, rows<F>(light, m), p, n, u, m, measure), m);
  });
  return r;
}

template <class F>
LightSample<F> LightSet::sample(Vec3<F> p, Vec3<F> n, F u_choice, Vec2<F> u, Mask<F> on, LightMeasure measure) const {
  LightChoice<F> choice = choose(p, n, u_choice, on);
  LightSample<F> r = sample_light(choice.light, p, n, u, choice.valid, measure);
  F mass = select(r.valid, choice.mass.value, F(1.0f));
  r.radiance = select(r.delta, r.radiance * (F(1.0f) / mass), r.radiance);
  r.density.value = select(r.delta, r.density.value, r.density.value * mass);
  return r;
}

template <class F>
Spectrum<F> LightSet::hit_radiance(Uint<F> light, Vec3<F> ng, Vec2<F> uv, Vec3<F> wi, Mask<F> on) const {
  if (!any(on)) return gray(F(0.0f));
  LightRows<F> row = rows<F>(light, on);
  Mask<F> seen = on & meets_lit_side(row, ng, wi);
  return select(seen, surface_emission(row, uv, seen), gray(F(0.0f)));
}

template <class F>
LightHit<F> LightSet::hit(Uint<F> light, Vec3<F> reference_p, Vec3<F> reference_n, Vec3<F> p, Vec3<F> ng, Vec2<F> uv,
                          Vec3<F> wi, Mask<F> on) const {
  LightHit<F> r{hit_radiance(light, ng, uv, wi, on), {F(0.0f)}};
  // Where nothing is emitted, no density is needed.
  r.density = sampling_density(light, reference_p, reference_n, p, wi, Mask<F>(on & !is_black(r.radiance)));
  return r;
}

template <class F>
Density<SolidAngle, F> LightSet::sampling_density(Uint<F> light, Vec3<F> reference_p, Vec3<F> reference_n, Vec3<F> p,
                                                  Vec3<F> wi, Mask<F> on) const {
  Density<SolidAngle, F> r{F(0.0f)};
  for_each_kind<F>(light, on, [&](LightKind kind, Mask<F> m) {
    if (is_surface(kind)) {
      const LightRows<F> row = rows<F>(light, m);
      with_emitter<F>(kind, row, [&](const auto& emitter) {
        F density = emitter.density(reference_p, p, wi).value;
        r.value = select(m & is_finite(density) & !row.flag(light_masked), density, r.value);
      });
    } else if (is_delta(kind)) {
      r.value = select(m, F(1.0f), r.value);
    } else {
      with_unbounded_light<F>(kind, rows<F>(light, m), images_from_places(), [&](const auto& unbounded) {
        r.value = select(m, unbounded.toward(reference_n, wi, m).density.value, r.value);
      });
    }
  });
  if (sky_) {
    const Mask<F> of_sky = on & (light == Uint<F>(std::uint32_t(light_of_sky_)));
    r = select(of_sky, sky_density(reference_p, reference_n, wi, of_sky), r);
  }
  return choice_mass(light, reference_p, reference_n, on) * r;
}

template <class F>
LightHit<F> LightSet::escaped_light(LightId light, Vec3<F> n, Vec3<F> wi, Mask<F> on) const {
  const LightRows<F> row = rows<F>(Uint<F>(std::uint32_t(light)), Mask<F>(true));
  LightHit<F> r{};
  with_unbounded_light<F>(kind(light), row, images_from_places(), [&](const auto& unbounded) {
    const UnboundedSample<F> s = unbounded.toward(n, wi, on);
    r = {row.emission() * s.factor, s.density};
  });
  return r;
}

template <class F>
LightHit<F> LightSet::escaped(int infinite_index, Vec3<F> reference_p, Vec3<F> reference_n, Vec3<F> wi,
                              Mask<F> on) const {
  LightId light = infinite_light(infinite_index);
  LightHit<F> r = escaped_light<F>(light, reference_n, wi, on);
  if (sky_ && light == light_of_sky_) r.density = sky_density(reference_p, reference_n, wi, on);
  r.density = choice_mass(Uint<F>(std::uint32_t(light)), reference_p, reference_n, on) * r.density;
  return r;
}

template <class F>
Spectrum<F> LightSet::escaped_radiance(Vec3<F> wi, Mask<F> on) const {
  Spectrum<F> sum = gray(F(0.0f));
  Vec3<F> nowhere{F(0.0f), F(0.0f), F(0.0f)};
  for (int i = 0; i < infinite_count(); ++i) sum += escaped_light<F>(infinite_light(i), nowhere, wi, on).radiance;
  return sum;
}

}  // namespace montelux
