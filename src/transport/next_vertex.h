// The next vertex along a ray, through interfaces, and the light that the ray meets on its way.
#pragma once
#include "accel/accel.h"
#include "image/layers.h"
#include "transport/light_met.h"
#include "transport/vertex.h"

namespace montelux {

// A surface that scatters, at the end of a ray. The vertex holds where `found`.
template <class F>
struct NextVertex : Vertex<F> {
  Mask<F> found;
  F distance;         // from the ray's origin
  Spectrum<F> light;  // emitted toward the origin by the surface, by interfaces on the way and by the sky, weighted
  Spectrum<F> left;   // what the media leave at the origin of light that the surface sends there
};

template <class F>
Hit<F> select_hit(Mask<F> m, const Hit<F>& a, const Hit<F>& b) {
  return {select(m, a.t, b.t),
          select(m, a.u, b.u),
          select(m, a.v, b.v),
          select(m, a.geometry, b.geometry),
          select(m, a.primitive, b.primitive),
          select(m, a.instance, b.instance)};
}

// Receives each light that a ray meets, weighted: in which lanes, how much, its number, and how it was found.
struct NoSink {
  template <class... All>
  MONTELUX_INLINE void operator()(const All&...) const {}
};

// All light that is met counts in full, or not at all.
struct FullWeight {
  template <class F>
  MONTELUX_INLINE F operator()(const Density<SolidAngle, F>&) const {
    return F(1.0f);
  }
};
struct NoWeight {
  template <class F>
  MONTELUX_INLINE F operator()(const Density<SolidAngle, F>&) const {
    return F(0.0f);
  }
};

// Follows rays that have met `hit` where `found`, straight on through interfaces, to a surface that scatters.
// weight(density), or weight(density, MetLight), is the weight of light that is met, as for sky_light(); `random`
// belongs to this vertex. Adds the rays that are traced to `traced`.
template <class F, class Rays, class Weight, class Sink = NoSink>
NextVertex<F> follow_ray(const Scene& scene, const Rays& rays, const ReferencePoint<F>& from, const Ray<F>& ray,
                         Hit<F> hit, Mask<F> found, RandomStream<F> random, std::uint64_t& traced, Weight weight,
                         Sink sink = {}) {
  using U = Uint<F>;
  Spectrum<F> light = gray(F(0.0f)), left = gray(F(1.0f));
  Segment<F> segment{ray, hit, from.media};
  U crossings = U(0u);
  const auto meet = [&](Mask<F> on) {
    return Vertex<F>(scene, segment, {on, on}, BsdfContext<F>{TransportMode::radiance, random.fork(crossings)});
  };
  Vertex<F> v = meet(found);
  bool crossed = false;
  for (Mask<F> open = found; any(open);) {
    if (crossed) v = meet(open);
    if (const Mask<F> emits = open & (v.x.light != U(0u)); any(emits)) {
      const LightHit<F> emitter = emission_met<F>(scene.lights, from, v.x, ray.d, emits);
      const U number = select(emits, v.x.light - U(1u), U(0u));
      const F share = weight_of_met<F>(weight, emitter.density, {number, v.x.point.p, v.x.point.ng, emits});
      const Spectrum<F> met =
          select(emits, left * segment.media.left(v.x.distance) * emitter.radiance * share, gray(F(0.0f)));
      light += met;
      sink(emits, met, number, Technique::bsdf_sampling);
    }
    const Mask<F> passes = open & v.bsdf.is_interface;
    segment.media = select_media<F>(open, v.media.along_wo(), segment.media);
    left = select(open, left * segment.media.left(v.x.distance), left);
    if (!any(passes)) break;
    crossed = true;
    segment.media = select_media<F>(passes, v.media_toward(ray.d), segment.media);
    segment.ray.o = select(passes, v.origin_toward(ray.d), segment.ray.o);
    crossings = crossings + select(passes, U(1u), U(0u));
    traced += std::uint64_t(count(passes));
    const auto [further, next] = rays.template trace<F>({segment.ray.o, ray.d, F(ray_infinity), ray.time}, passes);
    const Mask<F> escapes = passes & !further;
    light += sky_light<F>(scene.lights, from, ray.d, escapes, weight, sink);
    found = found & !escapes;
    open = passes & further;
    segment.hit = select_hit(open, next, segment.hit);
  }
  if (crossed) v = meet(found);
  return {v, found, length(v.x.point.p - ray.o), light, left};
}

// Traces the ray first. Lanes that are off return with nothing.
template <class F, class Rays, class Weight, class Sink = NoSink>
NextVertex<F> next_vertex(const Scene& scene, const Rays& rays, const ReferencePoint<F>& from, const Ray<F>& ray,
                          Mask<F> on, RandomStream<F> random, std::uint64_t& traced, Weight weight, Sink sink = {}) {
  traced += std::uint64_t(count(on));
  const auto [found, hit] = rays.template trace<F>(ray, on);
  NextVertex<F> next = follow_ray(scene, rays, from, ray, hit, found, random, traced, weight, sink);
  next.light += sky_light<F>(scene.lights, from, ray.d, Mask<F>(on & !found), weight, sink);
  return next;
}

}  // namespace montelux
