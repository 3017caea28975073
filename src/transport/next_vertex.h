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
  F distance;           // from the ray's origin
  Spectrum<F> emitted;  // emitted toward the origin by the surface, by interfaces on the way and by the sky, weighted
  Spectrum<F> left;     // transmittance from the vertex to the ray's origin; in media the weights of sampled distances
  F passing;            // probability of no event before the vertex, as MediumSet::mean_passing
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
// The same, where each segment is reported before its distance is drawn:
//   segments.begin(Segment<F>, throughput of the path at its start, on, RandomStream<F> of the segment's end)
template <class F, class Numbers, class Segments>
struct ReportedDistances : MediumDistances<F, Numbers> {
  Segments& segments;
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

// An emitter that a ray meets. `left` of its light reaches the ray's origin, `passing` is as NextVertex has it, and
// `crossings` are the interfaces before it.
template <class F>
struct EmitterOnRay {
  const Vertex<F>& v;
  Mask<F> passes;  // an interface, behind which the ray continues
  Spectrum<F> left;
  F passing;
  Uint<F> crossings;
};

// What follow_segment() reports light to:
//   void emitter(EmitterOnRay, on)
//   void sky(SkyOnRay, on)               where a ray leaves the scene behind an interface, or in a medium
//   void medium(Spectrum<F> radiance, on)  what a participating medium emits along a segment; if `sees_media`
// This one counts light as it is seen from `from`: weight(density), or weight(density, MetLight), is the weight of
// light that is met, as for sky_light().
template <class F, class Weight, class Sink = NoSink>
struct WeighedLight {
  static constexpr bool sees_media = !std::is_same_v<Weight, NoWeight>;
  const Scene& scene;
  const ReferencePoint<F>& from;
  const Vec3<F>& d;
  Weight weight;
  Sink sink;
  Spectrum<F> sum = gray(F(0.0f));

  MONTELUX_INLINE void emitter(const EmitterOnRay<F>& met, Mask<F> on) {
    const SurfaceHit<F>& x = met.v.x;
    const LightHit<F> light = emission_met<F>(scene.lights, from, x, d, on);
    const Uint<F> number = select(on, x.light - Uint<F>(1u), Uint<F>(0u));
    const F share = weight_of_met<F>(weight, light.density, {number, x.point.p, x.point.ng, on, met.passing});
    add(select(on, met.left * light.radiance * share, gray(F(0.0f))), on, number, Technique::bsdf_sampling);
  }
  MONTELUX_INLINE void sky(const SkyOnRay<F>& met, Mask<F> on) {
    sum += sky_light<F>(scene.lights, from, d, met, on, weight, sink);
  }
  MONTELUX_INLINE void medium(const Spectrum<F>& radiance, Mask<F> on) {
    add(select(on, radiance, gray(F(0.0f))), on, Uint<F>(scene.lights.count()), Technique::bsdf_sampling);  // after all
  }

 private:
  MONTELUX_INLINE void add(const Spectrum<F>& radiance, Mask<F> on, const Uint<F>& number, Technique technique) {
    sum += radiance;
    sink(on, radiance, number, technique);
  }
};

// Rays on their way through interfaces: their present segments, and what is known of all up to these.
template <class F>
struct RayProgress {
  Segment<F> segment;
  Spectrum<F>
      left;  // what reaches the start of light along the ray; or what a path there contributes for each unit of it
  F passing = F(1.0f);              // as NextVertex has it
  Uint<F> crossings = Uint<F>(0u);  // interfaces
};
// The lanes of rays, and how much of a surface at their end must be known.
template <class F>
struct RayLanes {
  Mask<F> found;     // whose segment has met its hit
  Mask<F> scatters;  // of these: how it scatters
};
// The end of a segment.
template <class F>
struct SegmentEnd {
  Vertex<F> v;
  VertexLanes<F> lanes;  // where the vertex is: elsewhere the ray has left the scene
  Mask<F> passes;        // the vertex is an interface, behind which the ray continues

  Mask<F> exists() const { return lanes.on_surface | lanes.in_medium; }
};

// Goes to the end of the rays' present segments, the step that all paths have in common. Light that is met there, or
// along the segment, is reported to `lights`; `random` belongs to this vertex.
//
// With MediumDistances the rays go through participating media: `found` are all rays, also those that have met nothing,
// whose hit is at infinity; the vertex may be an event in a medium; the sky, and what the media emit, are reported,
// too.
template <class F, class Lights, class Distances = NoDistances>
MONTELUX_INLINE SegmentEnd<F> end_segment(const Scene& scene, RayProgress<F>& way, const RayLanes<F>& rays,
                                          const RandomStream<F>& random, Lights& lights,
                                          [[maybe_unused]] const Distances& distances = {}) {
  using U = Uint<F>;
  constexpr bool in_media = !std::is_same_v<Distances, NoDistances>;
  Segment<F>& segment = way.segment;
  // What a segment leaves of light that is met; what participating media leave is in the weight of the distance.
  const auto left_along = [](const Media<F>& media, F distance) {
    if constexpr (!in_media) return media.left(distance);
    return select(media.medium == U(empty_space), media.left(distance), gray(F(1.0f)));
  };
  VertexLanes<F> at{rays.found, Mask<F>(false)};
  if constexpr (in_media) {
    const MediumSet& media = scene.media;
    const U medium = segment.media.medium;
    at.on_surface = rays.found & (segment.hit.t < F(ray_infinity));
    if constexpr (Lights::sees_media)
      if (media.emits()) lights.medium(way.left * media.emitted<F>(medium, segment.hit.t), rays.found);
    const Spectrum<F> throughput = distances.throughput * way.left;
    if constexpr (requires { distances.segments; }) distances.segments.begin(segment, throughput, rays.found, random);
    if (any(rays.found & (medium != U(empty_space)))) {
      const DistanceSample<F> sampled = media.sample_distance<F>(
          medium, throughput, segment.hit.t,
          distances.numbers.get2(distances.first + way.crossings * U(path_dimension::per_crossing)));
      way.left = select(rays.found, way.left * sampled.weight, way.left);
      at.in_medium = rays.found & sampled.is_event, at.on_surface = at.on_surface & !at.in_medium;
      at.distance = sampled.distance;
      const F length = select(sampled.is_event, sampled.distance, segment.hit.t);
      way.passing = select(rays.found, way.passing * media.mean_passing<F>(medium, length), way.passing);
    }
    if (const Mask<F> escapes = rays.found & !at.on_surface & !at.in_medium; any(escapes))
      lights.sky(SkyOnRay<F>{way.left * left_along(segment.media, F(ray_infinity)), way.passing, way.crossings},
                 escapes);
  }
  at.scatters = at.on_surface & (rays.scatters | Mask<F>(scene.materials.has_interfaces()));
  SegmentEnd<F> end{Vertex<F>(scene, segment, at, BsdfContext<F>{TransportMode::radiance, random}, InMedia<in_media>{}),
                    at, Mask<F>(false)};
  const Vertex<F>& v = end.v;
  end.passes = at.on_surface & v.bsdf.is_interface;
  if (const Mask<F> emits = at.on_surface & (v.x.light != U(0u)); any(emits))
    lights.emitter(
        EmitterOnRay<F>{v, end.passes, way.left * left_along(segment.media, v.x.distance), way.passing, way.crossings},
        emits);
  const Mask<F> exists = end.exists();
  segment.media = select_media<F>(exists, v.media.along_wo(), segment.media);
  way.left = select(exists, way.left * left_along(segment.media, v.x.distance), way.left);
  return end;
}

// The rest of follow_segment() where `end` has interfaces, which is rare.
template <class F, class Rays, class Lights, class Distances>
__attribute__((noinline)) NextVertex<F> follow_through(const Scene& scene, const Rays& rays, RayProgress<F>& way,
                                                       SegmentEnd<F> end, Mask<F> scatters,
                                                       const RandomStream<F>& random, std::uint64_t& traced,
                                                       Lights& lights, const Distances& distances) {
  using U = Uint<F>;
  constexpr bool in_media = !std::is_same_v<Distances, NoDistances>;
  const Vec3<F> o = way.segment.ray.o;
  VertexLanes<F> at = end.lanes;
  Mask<F> found = end.exists();
  while (any(end.passes)) {
    const Mask<F> passes = end.passes;
    cross_interface(way.segment, end.v, passes);
    way.crossings = way.crossings + select(passes, U(1u), U(0u));
    traced += std::uint64_t(count(passes));
    const auto [further, next] = rays.template trace<F>(way.segment.ray, passes);
    way.segment.hit = select_hit(passes, next, way.segment.hit);
    found = found & !passes;
    Mask<F> open = passes;
    if constexpr (!in_media) {
      if (const Mask<F> escapes = passes & !further; any(escapes))
        lights.sky(SkyOnRay<F>{way.left * way.segment.media.left(F(ray_infinity)), way.passing, way.crossings},
                   escapes);
      open = passes & further;
      if (!any(open)) break;
    }
    end = end_segment<F>(scene, way, {open, scatters}, random.fork(way.crossings), lights, distances);
    at.on_surface = (at.on_surface & !passes) | end.lanes.on_surface;
    at.in_medium = at.in_medium | end.lanes.in_medium, at.distance = select(open, end.lanes.distance, at.distance);
    found = found | end.exists();
  }
  at.scatters = at.on_surface;
  const Vertex<F> v(scene, way.segment, at, BsdfContext<F>{TransportMode::radiance, random.fork(way.crossings)},
                    InMedia<in_media>{});
  return {v, found, length(v.x.point.p - o), gray(F(0.0f)), way.left, way.passing};
}

// Follows rays from the end of their first segment, straight on through interfaces, to a surface that scatters, or,
// with MediumDistances, to an event in a medium. Arguments are as for end_segment(). Adds the rays that are traced to
// `traced`.
template <class F, class Rays, class Lights, class Distances = NoDistances>
MONTELUX_INLINE NextVertex<F> follow_segment(const Scene& scene, const Rays& rays, RayProgress<F>& way,
                                             const RayLanes<F>& lanes, const RandomStream<F>& random,
                                             std::uint64_t& traced, Lights& lights, const Distances& distances = {}) {
  const SegmentEnd<F> end = end_segment<F>(scene, way, lanes, random.fork(Uint<F>(0u)), lights, distances);
  if (any(end.passes))
    return follow_through<F>(scene, rays, way, end, lanes.scatters, random, traced, lights, distances);
  return {end.v, end.exists(), length(end.v.x.point.p - way.segment.ray.o), gray(F(0.0f)), way.left, way.passing};
}

// Follows rays that have met `hit` where `found`, and gathers the light that they meet by its weight, as WeighedLight
// has it, and sink(on, light, number, technique).
template <class F, class Rays, class Weight, class Sink = NoSink, class Distances = NoDistances>
NextVertex<F> follow_ray(const Scene& scene, const Rays& rays, const ReferencePoint<F>& from, const Ray<F>& ray,
                         const Hit<F>& hit, Mask<F> found, const RandomStream<F>& random, std::uint64_t& traced,
                         Weight weight, Sink sink = {}, const Distances& distances = {}) {
  RayProgress<F> way{{ray, hit, from.media}, gray(F(1.0f))};
  WeighedLight<F, Weight, Sink> lights{scene, from, ray.d, weight, sink};
  NextVertex<F> next = follow_segment<F>(scene, rays, way, {found, Mask<F>(true)}, random, traced, lights, distances);
  next.emitted = lights.sum;
  return next;
}

// Traces the ray first. Lanes that are off return with nothing.
template <class F, class Rays, class Weight, class Sink = NoSink, class Distances = NoDistances>
NextVertex<F> next_vertex(const Scene& scene, const Rays& rays, const ReferencePoint<F>& from, const Ray<F>& ray,
                          Mask<F> on, const RandomStream<F>& random, std::uint64_t& traced, Weight weight,
                          Sink sink = {}, const Distances& distances = {}) {
  traced += std::uint64_t(count(on));
  const auto [found, hit] = rays.template trace<F>(ray, on);
  if constexpr (!std::is_same_v<Distances, NoDistances>)
    return follow_ray<F>(scene, rays, from, ray, hit, on, random, traced, weight, sink, distances);
  NextVertex<F> next = follow_ray<F>(scene, rays, from, ray, hit, found, random, traced, weight, sink);
  next.emitted += sky_light<F>(scene.lights, from, ray.d, Mask<F>(on & !found), weight, sink);
  return next;
}

}  // namespace montelux
