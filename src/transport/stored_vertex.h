// Vertices as they are kept by algorithms that store paths, or that connect other paths to them. Made of 32-bit words
// alone, so that single vertices can be gathered into the lanes of a pack.
#pragma once
#include "transport/vertex.h"

namespace montelux {

// A point of a surface, or of a medium, and how it scatters. The random numbers of the model are stored, too, so that
// every query evaluates the same BSDF.
template <class F>
struct StoredSurface {
  Vec3<F> p, ng;  // ng is zero in a medium
  BsdfSlots<F> slots;
  Uint<F> kind;  // a BsdfKind, or in_medium_kind
  LocalFrame<F> frame;
  RandomStream<F> random;

  // f |cos wi| for unit directions of the world, and the density of wi.
  BsdfValue<F> scattered(const Vec3<F>& wo, const Vec3<F>& wi, Mask<F> on) const {
    return scattered_from_local(frame.to_local(wo), wi, on);
  }
  Boundary<F> boundary() const { return {kind, slots, ng, frame}; }
  Mask<F> in_medium() const { return kind == Uint<F>(in_medium_kind); }

 protected:
  BsdfValue<F> scattered_from_local(const Vec3<F>& wo, const Vec3<F>& wi, Mask<F> on) const {
    const BsdfContext<F> context{TransportMode::radiance, random, on, Densities::exact};
    return evaluate<F>(BsdfLanes<F>{kind, &slots, on}, wo, frame.to_local(wi), context);
  }
};

// The same of a path that has arrived there.
template <class F>
struct StoredVertex : StoredSurface<F> {
  Vec3<F> p_error;
  Vec3<F> light_normal;  // as SurfaceScattering has it
  Vec3<F> wo;            // local
  F time;                // of the whole path
  Media<F> media;        // along wo

  // f |cos| toward a unit direction of the world, and its density.
  BsdfValue<F> scattered(const Vec3<F>& wi, Mask<F> on) const { return this->scattered_from_local(wo, wi, on); }
  // A direction of the path, drawn by u3 (local).
  BsdfSample<F> sampled(const Vec3<F>& u3, const RandomStream<F>& random_of_model, Mask<F> on) const {
    const BsdfContext<F> context{TransportMode::radiance, random_of_model, on, Densities::exact};
    return sample<F>(BsdfLanes<F>{this->kind, &this->slots, on}, wo, u3, context);
  }
};

// Such a vertex from which rays start.
template <class F>
struct StoredOrigin : StoredVertex<F> {
  Uint<F> sides;  // as packed_sides() gives them

  Media<F> media_toward(const MediumSet& of_scene, const Vec3<F>& wi) const {
    return MediaAt<F>(this->media, -this->frame.to_world(this->wo), of_scene, sides, this->kind, this->slots, this->ng,
                      this->frame)
        .toward(wi);
  }
  ReferencePoint<F> reference_toward(const MediumSet& of_scene, const Vec3<F>& wi) const {
    return {this->p, this->light_normal, media_toward(of_scene, wi)};
  }
  Vec3<F> origin_toward(const Vec3<F>& wi) const { return offset_origin(this->p, this->p_error, this->ng, wi); }
  Ray<F> ray_toward(const Vec3<F>& wi, F t_max = F(ray_infinity)) const {
    return {origin_toward(wi), wi, t_max, this->time};
  }
  // To the point at that distance along the unit wi.
  Ray<F> shadow_ray_to(const Vec3<F>& wi, F distance) const {
    return shadow_ray(this->p, this->p_error, this->ng, wi, distance, this->time);
  }
};

// f |cos| for light from wi that is scattered along wo (local), and its density, with the numbers of a context.
template <class F, bool in_media = false>
BsdfValue<F> evaluate_at(const Scene& scene, const StoredVertex<F>& v, const Vec3<F>& wo, const Vec3<F>& wi,
                         const BsdfContext<F>& context, Mask<F> on) {
  if constexpr (!in_media) return evaluate<F>(BsdfLanes<F>{v.kind, &v.slots, on}, wo, wi, context);
  const Mask<F> in_medium = v.in_medium();
  BsdfValue<F> value = evaluate<F>(BsdfLanes<F>{v.kind, &v.slots, Mask<F>(on & !in_medium)}, wo, wi, context);
  put_phase_value(on & in_medium, scene.media.phase<F>(v.media.medium), wo, wi, value);
  return value;
}

template <class F>
StoredVertex<F> stored(const Vertex<F>& v) {
  return {{v.x.point.p, v.x.point.ng, v.bsdf.slots, v.bsdf.kind, v.bsdf.frame, v.context.random},
          v.x.point.p_error,
          v.bsdf.light_normal,
          v.wo,
          v.time,
          v.media.along_wo()};
}
template <class F>
StoredOrigin<F> stored_origin(const Vertex<F>& v) {
  return {stored(v), packed_sides(v.x)};
}

}  // namespace montelux
