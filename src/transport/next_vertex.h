// The next vertex along a ray, through interfaces, and the light that the ray meets on its way.
#pragma once
#include "accel/accel.h"
#include "image/layers.h"
#include "transport/dimensions.h"
#include "transport/light_met.h"
#include "transport/vertex.h"

namespace montelux {

// A surface that scatters, or an event in a medium, at the end of a ray. The vertex holds where `found`.
template <class F>
struct NextVertex : Vertex<F> {
  Mask<F> found;
  F distance;         // from the ray's origin
  Spectrum<F> light;  // emitted toward the origin by the surface, by interfaces on the way and by the sky, weighted
  Spectrum<F> left;   // transmittance from the vertex to the ray's origin; in media the weights of sampled distances
  F passing;          // probability of no event before the vertex, as MediumSet::mean_passing
};

// Rays go through a scene without participating media.
struct NoDistances {};
// In participating media: where the distances to events along the segments up to one vertex come from.
template <class F, class Numbers>
struct MediumDistances {
  const Numbers& numbers;
  Uint<F> first;           // dimension of the first segment's pair of numbers; those of crossings follow
  Spectrum<F> throughput;  // of the path at the ray's origin
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
//
// With MediumDistances the rays go through participating media: `found` are all rays, also those that have met nothing,
// whose hit is at infinity; the vertex may be an event in a medium; the sky, and what the media emit, are in the light.
template <class F, class Rays, class Weight, class Sink = NoSink, class Distances = NoDistances>
NextVertex<F> follow_ray(const Scene& scene, const Rays& rays, const ReferencePoint<F>& from, const Ray<F>& ray,
                         Hit<F> hit, Mask<F> found, RandomStream<F> random, std::uint64_t& traced, Weight weight,
                         Sink sink = {}, [[maybe_unused]] const Distances& distances = {}) {
  using U = Uint<F>;
  constexpr bool in_media = !std::is_same_v<Distances, NoDistances>;
  Spectrum<F> light = gray(F(0.0f)), left = gray(F(1.0f));
  F passing(1.0f);
  Segment<F> segment{ray, hit, from.media};
  U crossings = U(0u);
  Mask<F> events(false);  // in media
  F distance(0.0f);       // to these
  // What a segment leaves of light that is met; what participating media leave is in the weight of the distance.
  const auto left_along = [](const Media<F>& media, F way) {
    if constexpr (!in_media) return media.left(way);
    return select(media.medium == U(empty_space), media.left(way), gray(F(1.0f)));
  };
  const auto meet = [&](Mask<F> on) {
    const Mask<F> surfaces = on & !events;
    return Vertex<F>(scene, segment, {surfaces, surfaces, Mask<F>(on & events), distance},
                     BsdfContext<F>{TransportMode::radiance, random.fork(crossings)}, InMedia<in_media>{});
  };
  // The distances along the present segments: events, and rays that leave the scene, which stay out of `open`.
  [[maybe_unused]] const auto go_through_media = [&]([[maybe_unused]] Mask<F>& open) {
    if constexpr (!in_media)
      return;
    else {
      const MediumSet& media = scene.media;
      const U medium = segment.media.medium;
      if constexpr (!std::is_same_v<Weight, NoWeight>)
        if (media.emits()) {
          const Spectrum<F> emitted = select(open, left * media.emitted<F>(medium, segment.hit.t), gray(F(0.0f)));
          light += emitted;
          sink(open, emitted, U(scene.lights.count()), Technique::bsdf_sampling);  // after all lights
        }
      const DistanceSample<F> way = media.sample_distance<F>(
          medium, distances.throughput * left, segment.hit.t,
          distances.numbers.get2(distances.first + crossings * U(path_dimension::per_crossing)));
      left = select(open, left * way.weight, left);
      events = events | (open & way.is_event);
      distance = select(open, way.distance, distance);
      const F length = select(way.is_event, way.distance, segment.hit.t);
      passing = select(open, passing * media.mean_passing<F>(medium, length), passing);
      const Mask<F> escapes = open & !way.is_event & !(segment.hit.t < F(ray_infinity));
      if (!any(escapes)) return;
      const Spectrum<F> through = left * left_along(segment.media, F(ray_infinity));
      const auto dimmed = [&](const Mask<F>& on, const Spectrum<F>& sky, const U& number, Technique technique) {
        sink(on, through * sky, number, technique);
      };
      light += through * sky_light<F>(scene.lights, {from.p, from.n}, ray.d, escapes, weight, dimmed, passing);
      open = open & !escapes, found = found & !escapes;
    }
  };
  Mask<F> open = found;
  if constexpr (in_media) go_through_media(open);
  Vertex<F> v = meet(found);
  bool crossed = false;
  while (any(open)) {
    if (crossed) v = meet(open);
    if (const Mask<F> emits = open & (v.x.light != U(0u)); any(emits)) {
      const LightHit<F> emitter = emission_met<F>(scene.lights, from, v.x, ray.d, emits);
      const U number = select(emits, v.x.light - U(1u), U(0u));
      const F share = weight_of_met<F>(weight, emitter.density, {number, v.x.point.p, v.x.point.ng, emits, passing});
      const Spectrum<F> met =
          select(emits, left * left_along(segment.media, v.x.distance) * emitter.radiance * share, gray(F(0.0f)));
      light += met;
      sink(emits, met, number, Technique::bsdf_sampling);
    }
    const Mask<F> passes = open & v.bsdf.is_interface;
    segment.media = select_media<F>(open, v.media.along_wo(), segment.media);
    left = select(open, left * left_along(segment.media, v.x.distance), left);
    if (!any(passes)) break;
    crossed = true;
    cross_interface(segment, v, passes);
    crossings = crossings + select(passes, U(1u), U(0u));
    traced += std::uint64_t(count(passes));
    const auto [further, next] = rays.template trace<F>({segment.ray.o, ray.d, F(ray_infinity), ray.time}, passes);
    if constexpr (in_media) {
      segment.hit = select_hit(passes, next, segment.hit);
      open = passes;
      go_through_media(open);
    } else {
      const Mask<F> escapes = passes & !further;
      light += sky_light<F>(scene.lights, from, ray.d, escapes, weight, sink);
      found = found & !escapes;
      open = passes & further;
      segment.hit = select_hit(open, next, segment.hit);
    }
  }
  if (crossed) v = meet(found);
  return {v, found, length(v.x.point.p - ray.o), light, left, passing};
}

// Traces the ray first. Lanes that are off return with nothing.
template <class F, class Rays, class Weight, class Sink = NoSink, class Distances = NoDistances>
NextVertex<F> next_vertex(const Scene& scene, const Rays& rays, const ReferencePoint<F>& from, const Ray<F>& ray,
                          Mask<F> on, RandomStream<F> random, std::uint64_t& traced, Weight weight, Sink sink = {},
                          const Distances& distances = {}) {
  traced += std::uint64_t(count(on));
  const auto [found, hit] = rays.template trace<F>(ray, on);
  if constexpr (!std::is_same_v<Distances, NoDistances>)
    return follow_ray(scene, rays, from, ray, hit, on, random, traced, weight, sink, distances);
  NextVertex<F> next = follow_ray(scene, rays, from, ray, hit, found, random, traced, weight, sink);
  next.light += sky_light<F>(scene.lights, from, ray.d, Mask<F>(on & !found), weight, sink);
  return next;
}

}  // namespace montelux
