// Where a ray arrives, and the light that it meets on its way: what every integrator but the path loop is made of.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/path/path_state.h"
#include "integrator/tally.h"
#include "mc/mis.h"
#include "scene/scene.h"

namespace montelux {

// Roulette lets no path live on with certainty, or one between white walls would never end.
inline constexpr float most_survival = 0.97f;

// The point from which rays leave, as the lights' densities take it.
template <class F>
struct Departure {
  Vec3<F> p, n;                    // n: unit normal of the side that scatters; zero: both sides, or no surface
  Media<F> media = no_media<F>();  // into which the ray leaves
};

// A surface that scatters, at the end of a ray. Results hold where `found`.
template <class F>
struct Arrival {
  Mask<F> found;
  Vec3<F> d;          // in which the ray came
  F time;             // at which it came, and at which all rays leave
  F distance;         // from the ray's origin
  Spectrum<F> light;  // emitted toward the origin by the surface, by interfaces on the way and by the sky, weighted
  SurfaceHit<F> x;
  SurfaceScattering<F> bsdf;
  Vec3<F> wo;  // local
  BsdfContext<F> context;
  Media<F> media;    // in which the ray came last
  Spectrum<F> left;  // at the origin, of what the surface sends there

  // For choosing lights: the media are those of no direction.
  Departure<F> departure() const { return {x.point.p, bsdf.light_normal}; }
  Departure<F> departure_toward(const Vec3<F>& wi) const { return {x.point.p, bsdf.light_normal, media_toward(wi)}; }
  Media<F> media_toward(const Vec3<F>& wi) const {
    return MediaAt<F>(media, {bsdf.kind, bsdf.slots, x.point.ng, bsdf.frame}, d).toward(wi);
  }
  // What is left of light that comes along wi from that far.
  Spectrum<F> left_of_light(const Vec3<F>& wi, F far) const { return media_toward(wi).left(far); }
  // From the surface toward wi.
  Ray<F> ray_toward(const Vec3<F>& wi, F t_max = F(ray_infinity)) const { return {origin_toward(wi), wi, t_max, time}; }
  // To the point that far toward the unit wi.
  Ray<F> shadow_ray_to(const Vec3<F>& wi, F far) const {
    return shadow_ray(x.point.p, x.point.p_error, x.point.ng, wi, far, time);
  }
  Vec3<F> origin_toward(const Vec3<F>& wi) const { return offset_origin(x.point.p, x.point.p_error, x.point.ng, wi); }
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
struct NoWitness {
  template <class... All>
  MONTELUX_INLINE void operator()(const All&...) const {}
};

// The light from beyond the scene along d, each infinite light weighted by weight(density): the density, solid angle,
// with which light sampling at `from` would have drawn d.
template <class F, class Weight, class Witness>
Spectrum<F> sky_light(const Scene& scene, const Departure<F>& from, const Vec3<F>& d, Mask<F> on, Weight weight,
                      Witness witness) {
  Spectrum<F> sum = gray(F(0.0f));
  for (int i = 0; i < scene.lights.infinite_count() && any(on); ++i) {
    const LightHit<F> sky = scene.lights.template escaped<F>(i, from.p, from.n, d, on);
    const Spectrum<F> light =
        select(on, from.media.left(F(ray_infinity)) * sky.radiance * weight(sky.density.value), gray(F(0.0f)));
    sum += light;
    witness(on, light, Uint<F>(std::uint32_t(scene.lights.infinite_light(i))), Technique::environment);
  }
  return sum;
}

// Follows rays that have met `hit` where `found`, straight on through interfaces, to a surface that scatters.
// weight(density) is the weight of the light that is met, as for sky_light; `random` belongs to this vertex.
template <class F, class Rays, class Weight, class Witness = NoWitness>
Arrival<F> arrive(const Scene& scene, const Rays& rays, const Departure<F>& from, const Ray<F>& ray, Hit<F> hit,
                  Mask<F> found, RandomStream<F> random, RayCounts& counts, Weight weight, Witness witness = {}) {
  using U = Uint<F>;
  Arrival<F> a{};
  a.d = ray.d, a.time = ray.time, a.light = gray(F(0.0f));
  a.media = from.media, a.left = gray(F(1.0f));
  Vec3<F> o = ray.o;
  U crossings = U(0u);
  const auto meet_surface = [&](Mask<F> on) {
    a.x = surface<F>(scene.geometry, {o, ray.d, hit.t, ray.time}, hit, on);
    a.context = {TransportMode::radiance, random.fork(crossings)};
    a.bsdf = scene.materials.template scattering<F>(a.x, ray.d, on, a.context.random);
  };
  bool crossed = false;
  for (Mask<F> open = found; any(open);) {
    meet_surface(open);
    if (const Mask<F> emits = open & (a.x.light != U(0u)); any(emits)) {
      const LightHit<F> light = scene.lights.template hit<F>(select(emits, a.x.light - U(1u), U(0u)), from.p, from.n,
                                                             a.x.point.p, a.x.point.ng, a.x.point.uv, ray.d, emits);
      const Spectrum<F> left = a.left * a.media.left(a.x.distance);
      const Spectrum<F> met = select(emits, left * light.radiance * weight(light.density.value), gray(F(0.0f)));
      a.light += met;
      witness(emits, met, U(a.x.light - U(1u)), Technique::bsdf_sampling);
    }
    const Mask<F> passes = open & a.bsdf.is_interface;
    const Boundary<F> boundary(a.bsdf.kind, a.bsdf.slots, a.x.point.ng, a.bsdf.frame);
    a.media = select_media<F>(open, boundary.before(a.media, ray.d), a.media);
    a.left = select(open, a.left * a.media.left(a.x.distance), a.left);
    if (!any(passes)) break;
    crossed = true;
    o = select(passes, a.origin_toward(ray.d), o);
    crossings = crossings + select(passes, U(1u), U(0u));
    counts.scattered += std::uint64_t(count(passes));
    const auto [further, next] = rays.template trace<F>({o, ray.d, F(ray_infinity), ray.time}, passes);
    const Mask<F> left = passes & !further;
    a.light += sky_light(scene, from, ray.d, left, weight, witness);
    found = found & !left;
    open = passes & further;
    hit = select_hit(open, next, hit);
  }
  if (crossed) meet_surface(found);
  a.found = found;
  a.wo = a.bsdf.frame.to_local(-ray.d);
  a.distance = length(a.x.point.p - ray.o);
  return a;
}

// Traces the ray first. Lanes that are off come back with nothing.
template <class F, class Rays, class Weight, class Witness = NoWitness>
Arrival<F> trace_to_arrival(const Scene& scene, const Rays& rays, const Departure<F>& from, const Ray<F>& ray,
                            Mask<F> on, RandomStream<F> random, RayCounts& counts, Weight weight,
                            Witness witness = {}) {
  counts.scattered += std::uint64_t(count(on));
  const auto [found, hit] = rays.template trace<F>(ray, on);
  Arrival<F> a = arrive(scene, rays, from, ray, hit, found, random, counts, weight, witness);
  a.light += sky_light(scene, from, ray.d, Mask<F>(on & !found), weight, witness);
  return a;
}

// What the first surface of a camera path shows, for the feature layers.
template <class F>
void write_features(const Arrival<F>& at, const Spectrum<F>& albedo, const PathState<F>& path, Mask<F> on,
                    std::span<PixelSample> out) {
  const Vec3<F> normal = face_forward(at.x.point.ns, -at.d);
  const Spectrum<F> emission = at.light * path.weight;
  for_each_lane(on, [&](int k) {
    out[lane(path.slot, k)].features = {to_rgb(lane(emission, k)), to_rgb(lane(albedo, k)), lane(normal, k),
                                        lane(at.x.point.p, k),     lane(at.distance, k),    1.0f,
                                        lane(at.x.object, k)};
  });
}

}  // namespace montelux
