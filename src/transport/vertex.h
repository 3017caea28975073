// A vertex of a path: where a ray ends, how it scatters there, and the media around it.
#pragma once
#include "scene/scene.h"
#include "transport/media.h"
#include "transport/medium_vertex.h"

namespace montelux {

// The point that light arrives at or a ray leaves from, as the lights' densities take it.
template <class F>
struct ReferencePoint {
  Vec3<F> p, n;                    // n: unit normal of the side that scatters; zero: both sides, or no surface
  Media<F> media = no_media<F>();  // along the ray in question
};
// A point without a side: the lens, or a light.
template <class F>
MONTELUX_INLINE ReferencePoint<F> free_point(const Vec3<F>& p, const Media<F>& media = no_media<F>()) {
  return {p, {F(0.0f), F(0.0f), F(0.0f)}, media};
}

// The last segment of a path: a ray, what it meets, and the media along it.
template <class F>
struct Segment {
  Ray<F> ray;
  Hit<F> hit;  // t is infinite where nothing is met
  Media<F> media;
};

// Which lanes of a pack need what of a vertex.
template <class F>
struct VertexLanes {
  Mask<F> on_surface;                  // the segment ends at a surface
  Mask<F> scatters;                    // of these: it must be known how the surface scatters
  Mask<F> in_medium = Mask<F>(false);  // the segment ends in its medium instead,
  F distance = F(0.0f);                // after this length
};

// Whether the scene has participating media; without them they cost nothing.
template <bool in_media>
using InMedia = std::bool_constant<in_media>;

template <class F>
struct Vertex {
  SurfaceHit<F> x;  // of a medium: a point without extent and without a side
  SurfaceScattering<F> bsdf;
  Mask<F> in_medium;       // not on a surface
  Vec3<F> d;               // unit: along which the path arrives
  Vec3<F> wo;              // -d in the local frame
  F time;                  // of the whole path
  BsdfContext<F> context;  // with the random numbers of this vertex
  MediaAt<F> media;

  // The vertex at the end of a segment, which arrives along it. Where a lane is neither on a surface nor in a medium,
  // the vertex has no meaning.
  template <bool with_media = false>
  MONTELUX_INLINE Vertex(const Scene& scene, const Segment<F>& segment, const VertexLanes<F>& lanes,
                         const BsdfContext<F>& numbers, InMedia<with_media> = {})
      : x(point_of<with_media>(scene, segment, lanes)),
        bsdf(scattering_of<with_media>(scene, x, segment.ray.d, lanes, numbers.random)),
        in_medium(lanes.in_medium),
        d(segment.ray.d),
        wo(bsdf.frame.to_local(-d)),
        time(segment.ray.time),
        context(numbers),
        media(segment.media, d, scene.media, x, bsdf) {}

  // The same vertex, for choosing lights: the media are those of no direction.
  MONTELUX_INLINE ReferencePoint<F> reference() const { return {x.point.p, bsdf.light_normal}; }
  MONTELUX_INLINE ReferencePoint<F> reference_toward(const Vec3<F>& wi) const {
    return {x.point.p, bsdf.light_normal, media_toward(wi)};
  }
  MONTELUX_INLINE Media<F> media_toward(const Vec3<F>& wi) const { return media.toward(wi); }
  // What the media leave of light that comes along the unit wi from that far.
  MONTELUX_INLINE Spectrum<F> left_of_light(const Vec3<F>& wi, F distance) const {
    return media_toward(wi).left(distance);
  }
  // Where rays toward wi start, off the surface.
  MONTELUX_INLINE Vec3<F> origin_toward(const Vec3<F>& wi) const {
    return offset_origin(x.point.p, x.point.p_error, x.point.ng, wi);
  }
  MONTELUX_INLINE Ray<F> ray_toward(const Vec3<F>& wi, F t_max = F(ray_infinity)) const {
    return {origin_toward(wi), wi, t_max, time};
  }
  // To the point at that distance along the unit wi.
  MONTELUX_INLINE Ray<F> shadow_ray_to(const Vec3<F>& wi, F distance) const {
    return shadow_ray(x.point.p, x.point.p_error, x.point.ng, wi, distance, time);
  }

 private:
  template <bool with_media>
  MONTELUX_INLINE static SurfaceHit<F> point_of(const Scene& scene, const Segment<F>& segment,
                                                const VertexLanes<F>& lanes) {
    const Ray<F>& ray = segment.ray;
    if constexpr (!with_media)
      return surface<F>(scene.geometry, {ray.o, ray.d, segment.hit.t, ray.time}, segment.hit, lanes.on_surface);
    SurfaceHit<F> x =
        surface<F>(scene.geometry, {ray.o, ray.d, segment.hit.t, ray.time}, segment.hit, lanes.on_surface);
    put_medium_vertex(lanes.in_medium, ray.o, ray.d, lanes.distance, x);
    return x;
  }
  template <bool with_media>
  MONTELUX_INLINE static SurfaceScattering<F> scattering_of(const Scene& scene, const SurfaceHit<F>& x,
                                                            const Vec3<F>& d, const VertexLanes<F>& lanes,
                                                            const RandomStream<F>& random) {
    if constexpr (!with_media) return scene.materials.template scattering<F>(x, d, lanes.scatters, random);
    SurfaceScattering<F> bsdf = scene.materials.template scattering<F>(x, d, lanes.scatters, random);
    put_medium_scattering(lanes.in_medium, bsdf);
    return bsdf;
  }
};

// The segments of the lanes `passes` continue straight on beyond v, an interface at their end. What they meet there is
// not known yet.
template <class F>
MONTELUX_INLINE void cross_interface(Segment<F>& segment, const Vertex<F>& v, Mask<F> passes) {
  segment.media = select_media<F>(passes, v.media_toward(segment.ray.d), segment.media);
  segment.ray.o = select(passes, v.origin_toward(segment.ray.d), segment.ray.o);
}

// How a vertex scatters: toward the query's light, where wanted, and along a sampled direction (local directions).
template <class F, bool in_media = false>
MONTELUX_INLINE Scattering<F> scatter_at(const Scene& scene, const Vertex<F>& v, const ScatterQuery<F>& query,
                                         Mask<F> on) {
  if constexpr (!in_media) return scatter<F>(v.bsdf.lanes(on), query, v.context);
  Scattering<F> s = scatter<F>(v.bsdf.lanes(on & !v.in_medium), query, v.context);
  put_phase_scattering(on & v.in_medium, scene.media.phase<F>(v.media.along_wo().medium), query, s);
  return s;
}
// The value and the density for light from wi that is scattered along wo (local), with the numbers of a context.
template <class F, bool in_media = false>
MONTELUX_INLINE BsdfValue<F> evaluate_at(const Scene& scene, const Vertex<F>& v, const Vec3<F>& wo, const Vec3<F>& wi,
                                         const BsdfContext<F>& context, Mask<F> on) {
  if constexpr (!in_media) return evaluate<F>(v.bsdf.lanes(on), wo, wi, context);
  BsdfValue<F> value = evaluate<F>(v.bsdf.lanes(on & !v.in_medium), wo, wi, context);
  put_phase_value(on & v.in_medium, scene.media.phase<F>(v.media.along_wo().medium), wo, wi, value);
  return value;
}
// Along the vertex's own wo.
template <class F, bool in_media = false>
MONTELUX_INLINE BsdfValue<F> evaluate_at(const Scene& scene, const Vertex<F>& v, const Vec3<F>& wi, Mask<F> on) {
  return evaluate_at<F, in_media>(scene, v, v.wo, wi, v.context, on);
}
// |cos| of a unit direction of the world with the geometric normal, as densities per area take it; 1 in a medium, where
// they are per volume.
template <class F, bool in_media = false>
MONTELUX_INLINE F area_cosine(const Vertex<F>& v, const Vec3<F>& w) {
  const F cosine = abs(dot(v.x.point.ng, w));
  if constexpr (!in_media) return cosine;
  return select(v.in_medium, F(1.0f), cosine);
}

}  // namespace montelux
