// The loop of light tracing, for one path (F = float) and for a pack of them.
#pragma once
#include "integrator/first_vertex.h"
#include "integrator/light_tracing/settings.h"
#include "integrator/light_tracing/splats.h"
#include "mc/roulette.h"
#include "transport/numbers.h"

namespace montelux {

// All that the paths of a frame share.
template <class Rays>
struct LightTracingScene {
  const Scene& scene;
  const Rays& rays;
  const LightTracingSettings& settings;
  const AliasTable& by_power;
  const ChainPass& pass;
  std::uint32_t frame;
  bool one_sided;  // some surface is not there for camera rays that meet its back
  SplatPlane& plane;
};

// A path on its way, one a lane.
template <class F>
struct LightPathState {
  Ray<F> ray;              // to the next vertex
  ReferencePoint<F> from;  // where it starts
  Spectrum<F> flux;        // that the path carries: what the light sends over the path's density
  F start;                 // the greatest component of the flux with which it left the light
  Uint<F> depth;           // scattering events so far
  Uint<F> x, y;            // the site of its sample point
};

template <class F>
MONTELUX_INLINE LightPathState<F> select_path(Mask<F> m, const LightPathState<F>& a, const LightPathState<F>& b) {
  return {
      {select(m, a.ray.o, b.ray.o), select(m, a.ray.d, b.ray.d), select(m, a.ray.t_max, b.ray.t_max),
       select(m, a.ray.time, b.ray.time)},
      {select(m, a.from.p, b.from.p), select(m, a.from.n, b.from.n), select_media<F>(m, a.from.media, b.from.media)},
      select(m, a.flux, b.flux),
      select(m, a.start, b.start),
      select(m, a.depth, b.depth),
      select(m, a.x, b.x),
      select(m, a.y, b.y)};
}

// The factor by which a shading normal makes the scattering of importance differ from that of radiance (Veach 1997, eq.
// 5.19): from `in`, where light comes from, to `out`; their local directions, and their cosines with the geometric
// normal.
struct AdjointCorrection {
  template <class F>
  MONTELUX_INLINE F operator()(const Vec3<F>& in, F ng_in, const Vec3<F>& out, F ng_out) const {
    const F below = abs(ng_in * out.z);
    return select(below > F(0.0f), abs(in.z * ng_out) / max(below, F(1e-30f)), F(0.0f));
  }
};

// `Correction` is AdjointCorrection, but in tests that plant a fault.
template <class F, class Rays, class Correction = AdjointCorrection>
class LightTracingLoop {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  explicit LightTracingLoop(const LightTracingScene<Rays>& shared)
      : shared_(shared), scene_(shared.scene), scale_(scene_.imaging_ratio / float(shared.pass.bounds.area())) {}

  // One path for each pixel of the tile.
  RayCounts run(const PixelBounds& tile) {
    const auto paths = std::uint32_t(tile.area());
    LightPathState<F> path{};
    M on(false);
    for (std::uint32_t next = 0;;) {
      // Lanes that are off take the next paths.
      U x(0u), y(0u);
      std::uint32_t fresh = 0;
      for (int k = 0; k < lanes_of<F> && next < paths; ++k) {
        if ((bits(on) >> k) & 1u) continue;
        set_lane(x, k, std::uint32_t(tile.x0) + next % std::uint32_t(tile.width()));
        set_lane(y, k, std::uint32_t(tile.y0) + next / std::uint32_t(tile.width()));
        fresh |= 1u << k, ++next;
      }
      if (fresh != 0) {
        const M starts = mask_of_bits<F>(fresh);
        const auto [state, valid] = start(x, y, starts);
        path = select_path<F>(starts, state, path);
        on = (on & !starts) | valid;
      }
      if (!any(on)) {
        if (next == paths) return counts_;
        continue;
      }
      on = step(path, on);
    }
  }

 private:
  struct Start {
    LightPathState<F> state;
    M valid;
  };
  Sampler<F> sampler(const U& x, const U& y) const { return Sampler<F>(shared_.pass.points, x, y, U(shared_.frame)); }
  // A ray from a light, and the light itself as the lens sees it.
  Start start(const U& x, const U& y, M on) {
    const Sampler<F> numbers = sampler(x, y);
    const DiscreteSample<F> choice = shared_.by_power.sample(numbers.get1(U(light_dimension::choice)));
    const LightEmission<F> e = scene_.lights.template emit<F>(choice.index, numbers.get2(U(light_dimension::point)),
                                                              numbers.get2(U(light_dimension::direction)), on);
    F time = 0.0f;
    if (scene_.moves())
      time = shared_.pass.shutter.value_or(scene_.shutter).time(numbers.get1(U(light_dimension::time)));
    const Spectrum<F> flux = e.flux * (F(1.0f) / choice.mass.value);
    // Every valid ray starts somewhere that the lens may see.
    show_light(choice, e, numbers, time, on & e.valid);

    const M carries = on & e.valid & !is_broken(flux, x, y, on & e.valid) & (max_component(flux) > F(0.0f));
    const M leaves = shared_.settings.max_depth && *shared_.settings.max_depth == 0 ? M(false) : carries;
    const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
    const Vec3<F> o = select(e.on_surface, offset_origin(e.p, e.p_error, e.n, e.d), e.p);
    return {{{o, e.d, F(ray_infinity), time}, {e.p, zero}, flux, max_component(flux), U(0u), x, y}, leaves};
  }

  void show_light(const DiscreteSample<F>& choice, const LightEmission<F>& e, const Sampler<F>& numbers, const F& time,
                  M on) {
    const Vec2<F> lens_u = numbers.get2(U(light_dimension::lens));
    const RandomStream<F> random = numbers.stream(U(light_dimension::lens));
    if (const M surfaces = on & e.on_surface; any(surfaces)) {
      const LensConnection<F> lens = scene_.camera.toward(e.p, lens_u, time);
      const F cos = dot(e.n, -lens.d);
      const M lit = surfaces & lens.seen & shared_.plane.reaches(lens.raster) & ((cos > F(0.0f)) | e.both_sides);
      const Spectrum<F> light =
          e.radiance * (abs(cos) * lens.across.value / (choice.mass.value * e.position.value) * scale_);
      connect({e.p, e.p_error, e.n}, {no_media<F>(), lens, time, random}, light, lit);
    }
    const M beyond = on & !e.on_surface & !e.delta_position & !e.delta_direction;
    if (!any(beyond) || !scene_.camera.sees_directions()) return;
    const LensDirection<F> lens = scene_.camera.toward_direction(-e.d, lens_u, time);
    const M asks = beyond & lens.seen & shared_.plane.reaches(lens.raster);
    if (!any(asks)) return;
    const Spectrum<F> light = e.radiance * (lens.density.value / (choice.mass.value * e.direction.value) * scale_);
    splat(lens.raster, light, asks & sees_sky({lens.p, -e.d, F(ray_infinity), time}, random, asks));
  }

  // Goes to the next vertex, connects it with the lens, and scatters there.
  M step(LightPathState<F>& path, M on) {
    const Sampler<F> numbers = sampler(path.x, path.y);
    const U dimension = U(light_dimension::first_vertex) + path.depth * U(light_dimension::per_vertex);
    const NextVertex<F> at =
        next_vertex<F>(scene_, shared_.rays, path.from, path.ray, on,
                       numbers.stream(dimension + U(light_dimension::own)), counts_.scattered, NoWeight{});
    on = on & at.found;
    path.flux = select(on, path.flux * at.left, path.flux);
    BsdfContext<F> context = at.context;
    context.mode = TransportMode::importance;
    const F ng_in = dot(at.x.point.ng, at.d);

    // The lens is asked where the surface scatters, and a direction drawn.
    const LensConnection<F> lens =
        scene_.camera.toward(at.x.point.p, numbers.get2(dimension + U(light_dimension::vertex_lens)), path.ray.time);
    const Vec3<F> to_lens = at.bsdf.frame.to_local(-lens.d);
    const M asks = on & !at.bsdf.is_delta & lens.seen & shared_.plane.reaches(lens.raster);
    const Scattering<F> scattered =
        scatter<F>(at.bsdf.lanes(on),
                   {at.wo, to_lens, asks, numbers.get1(dimension + U(light_dimension::lobe)),
                    numbers.get2(dimension + U(light_dimension::vertex_direction))},
                   context);
    if (any(asks)) {
      const F ng_out = dot(at.x.point.ng, lens.d);
      const F correction = Correction()(at.wo, ng_in, to_lens, ng_out);
      const Spectrum<F> light = path.flux * scattered.toward_light.f_cos * (correction * lens.across.value * scale_);
      connect(
          {at.x.point.p, at.x.point.p_error, at.x.point.ng},
          {at.media_toward(-lens.d), lens, path.ray.time, numbers.stream(dimension + U(light_dimension::vertex_lens))},
          light, asks & !is_black(light));
    }

    const BsdfSample<F>& next = scattered.next;
    const Vec3<F> wi = at.bsdf.frame.to_world(next.wi);
    const U events = path.depth + U(1u);
    M continues = on & next.valid;
    if (shared_.settings.max_depth) continues = continues & (events < U(std::uint32_t(*shared_.settings.max_depth)));
    const F correction = Correction()(at.wo, ng_in, next.wi, dot(at.x.point.ng, wi));
    const Spectrum<F> flux = path.flux * next.weight * correction;
    continues = continues & !is_broken(flux, path.x, path.y, continues);
    // Survivors carry the same flux.
    const F share = max_component(flux) / path.start;
    const M plays = continues & (events > U(std::uint32_t(shared_.settings.roulette_depth)));
    const Roulette<F> survival = roulette(select(plays, min(share, F(max_survival)), F(1.0f)),
                                          numbers.get1(dimension + U(light_dimension::roulette)));
    continues = continues & survival.survives;
    path.flux = select(continues, flux * survival.weight, path.flux);
    path.depth = select(continues, events, path.depth);
    path.from.p = select(continues, at.x.point.p, path.from.p);
    path.from.media = select_media<F>(continues, at.media_toward(wi), path.from.media);
    const Ray<F> ray = at.ray_toward(wi);
    path.ray.o = select(continues, ray.o, path.ray.o), path.ray.d = select(continues, ray.d, path.ray.d);
    return continues;
  }

  // A flux that is not a number ends its path, and shows in the pixel whose sample point the path has.
  M is_broken(const Spectrum<F>& flux, const U& x, const U& y, M on) {
    F sum = flux.c[0];
    for (int i = 1; i < spectrum_size; ++i) sum += flux.c[i];
    const M broken = on & !is_finite(sum);
    if (any(broken)) splat({to_float(x) + 0.5f, to_float(y) + 0.5f}, gray(sum - sum), broken);
    return broken;
  }

  struct Place {
    Vec3<F> p, p_error, ng;
  };
  struct Way {
    Media<F> media;  // toward the lens
    LensConnection<F> lens;
    F time;
    RandomStream<F> random;  // for what half-open surfaces do on the way
  };

  // Splats the light that a place sends to the lens, where nothing is in between.
  void connect(const Place& from, const Way& way, const Spectrum<F>& light, M on) {
    if (!any(on)) return;
    splat(way.lens.raster, light * way.media.left(way.lens.distance), on & !is_hidden(from, way, on));
  }
  M is_hidden(const Place& from, const Way& way, M on) {
    counts_.shadow += std::uint64_t(count(on));
    const LensConnection<F>& lens = way.lens;
    if (!shared_.one_sided)
      return shared_.rays.template occluded<F>(
          shadow_ray(from.p, from.p_error, from.ng, -lens.d, lens.distance, way.time), on);
    // As the camera sees it, which passes by the backs of one-sided surfaces: what it sees must be the place.
    const NextVertex<F> seen = camera_ray({lens.p, lens.d, F(ray_infinity), way.time}, way.random, on);
    return on & !(seen.found & (abs(seen.distance - lens.distance) <= F(shadow_shortening) * lens.distance));
  }
  M sees_sky(const Ray<F>& ray, const RandomStream<F>& random, M on) {
    counts_.shadow += std::uint64_t(count(on));
    if (!shared_.one_sided) return on & !shared_.rays.template occluded<F>(ray, on);
    return on & !camera_ray(ray, random, on).found;
  }
  NextVertex<F> camera_ray(const Ray<F>& ray, const RandomStream<F>& random, M on) {
    const auto [found, hit] = shared_.rays.template trace<F>(ray, on, RayUse::camera);
    return follow_ray<F>(scene_, shared_.rays, free_point(ray.o), ray, hit, found, random, counts_.scattered,
                         NoWeight{});
  }

  void splat(const Vec2<F>& raster, const Spectrum<F>& light, M on) {
    for_each_lane(on, [&](int k) {
      const Rgb value = to_rgb(lane(light, k));
      scene_.camera.for_each_place(lane(raster, k), [&](Vec2f place) { shared_.plane.add(place, value); });
    });
  }

  const LightTracingScene<Rays>& shared_;
  const Scene& scene_;
  const float scale_;  // of one path's light: a frame has one path for each pixel
  RayCounts counts_;
};

}  // namespace montelux
