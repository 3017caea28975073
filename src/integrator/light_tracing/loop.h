// The loop of light tracing, for one path (F = float) and for a pack of them.
#pragma once
#include "integrator/light_paths/lens.h"
#include "integrator/light_paths/walk.h"
#include "integrator/light_tracing/settings.h"
#include "integrator/splats.h"

namespace montelux {

// All that the paths of a frame share.
template <class Rays>
struct LightTracingScene {
  const Scene& scene;
  const Rays& rays;
  const LightTracingSettings& settings;
  const AliasTable& by_power;
  const SeriesPass& pass;
  std::uint32_t frame;
  bool one_sided;  // some surface is not there for camera rays that meet its back
  SplatPlane& plane;
  const LightMedia* light_media = nullptr;  // null: the scene has no media
};

// Splats what the vertices of light paths send to the lens, and the lights themselves. `Correction` is
// AdjointCorrection, but in tests that plant a fault. `in_media`: the scene has participating media.
template <class F, class Rays, class Correction = AdjointCorrection, bool in_media = false>
class LightTracingLoop {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  explicit LightTracingLoop(const LightTracingScene<Rays>& shared)
      : shared_(shared),
        scene_(shared.scene),
        scale_(scene_.imaging_ratio / float(shared.pass.bounds.area())),
        lens_(scene_, shared.rays, shared.one_sided, shared.plane, counts_) {}

  // One path for each pixel of the tile, or for each cell if the pass has a grid: with the numbers of its pixel.
  RayCounts run(const PixelBounds& tile) {
    const LightWalkScene<Rays> walk{scene_,
                                    shared_.rays,
                                    shared_.by_power,
                                    shared_.pass.points,
                                    shared_.pass.shutter.value_or(scene_.shutter),
                                    {},
                                    shared_.settings.max_depth,
                                    shared_.settings.roulette_depth,
                                    Densities::for_weights,
                                    shared_.light_media};
    const auto width = std::uint32_t(tile.width());
    LightWalk<F, Rays, LightTracingLoop, Correction, in_media>(walk, *this, counts_)
        .run(std::uint32_t(tile.area()), [&](std::uint32_t number) {
          const PixelGrid& grid = shared_.plane.grid();
          return PathSite<float>{std::uint32_t(grid.pixel_x(tile.x0 + int(number % width))),
                                 std::uint32_t(grid.pixel_y(tile.y0 + int(number / width))), shared_.frame};
        });
    return counts_;
  }

  // ---- what the walk shows

  // Every valid ray starts somewhere that the lens may see.
  void leave(const LightPathStart<F>& s, M on) {
    light_ = select(on, s.choice.index, light_);
    show_light(s.choice, s.emission, s.numbers, s.time, on);
  }

  struct Query {
    LensConnection<F> lens;
    Vec3<F> toward;  // the lens, local
    M on;
  };
  // The connection with the lens, where the surface scatters.
  Query query(const LightPathVertex<F>& v, M on) const {
    const LensConnection<F> lens =
        lens_.toward(v.at.x.point.p, v.numbers.get2(v.dimension + U(light_dimension::vertex_lens)), v.path.ray.time);
    return {lens, v.at.bsdf.frame.to_local(-lens.d), M(on & !v.at.bsdf.is_delta & lens.seen)};
  }
  void visit(const LightPathVertex<F>& v, const Query& query, const BsdfValue<F>& value, M) {
    if (!any(query.on)) return;
    const NextVertex<F>& at = v.at;
    const LensConnection<F>& lens = query.lens;
    const F ng_out = dot(at.x.point.ng, lens.d);
    const F correction = adjoint_correction<F, Correction, in_media>(v, query.toward, ng_out);
    const Spectrum<F> contribution = v.path.flux * value.f_cos * (correction * lens.across.value * scale_);
    lens_.connect({at.x.point.p, at.x.point.p_error, at.x.point.ng},
                  {at.media_toward(-lens.d), lens, v.path.ray.time,
                   v.numbers.stream(v.dimension + U(light_dimension::vertex_lens))},
                  contribution, query.on & !is_black(contribution), origin(v.path.depth + U(1u), light_));
  }
  // It shows in the pixel whose sample point the path has.
  void broken(F value, const PathSite<F>& site, M on) {
    lens_.splat({to_float(site.x) + 0.5f, to_float(site.y) + 0.5f}, gray(value), on, origin(U(0u), light_));
  }

 private:
  // The lens is the only vertex that is not drawn from the light.
  static LightOrigin<F> origin(const U& bounces, const U& light) {
    return {bounces, light, Technique::light_sampling, bounces + U(1u)};
  }
  void show_light(const DiscreteSample<F>& choice, const LightEmission<F>& e, const Sampler<F>& numbers, const F& time,
                  M on) {
    const Vec2<F> lens_u = numbers.get2(U(light_dimension::lens));
    const RandomStream<F> random = numbers.stream(U(light_dimension::lens));
    if (const M surfaces = on & e.on_surface; any(surfaces)) {
      const LensConnection<F> lens = lens_.toward(e.p, lens_u, time);
      const F cos = dot(e.n, -lens.d);
      const M lit = surfaces & lens.seen & ((cos > F(0.0f)) | e.both_sides);
      const Spectrum<F> contribution = e.radiance * (abs(cos) * lens.across / (choice.mass * e.position) * scale_);
      Media<F> media = no_media<F>();
      if (shared_.light_media)
        media = shared_.light_media->template around<F>(scene_.media, choice.index, (cos > F(0.0f)) ^ e.behind, lit);
      lens_.connect({e.p, e.p_error, e.n}, {media, lens, time, random}, contribution, lit, origin(U(0u), choice.index));
    }
    const M beyond = on & !e.on_surface & !e.delta_position & !e.delta_direction;
    if (!any(beyond) || !scene_.camera.sees_directions()) return;
    const LensDirection<F> lens = scene_.camera.toward_direction(-e.d, lens_u, time);
    const M queries = beyond & lens.seen & shared_.plane.reaches(lens.raster);
    if (!any(queries)) return;
    const Spectrum<F> contribution =
        e.radiance * (lens.density.value / (choice.mass.value * e.direction.value) * scale_);
    lens_.splat(lens.raster, contribution * lens_.sky_seen({lens.p, -e.d, F(ray_infinity), time}, random, queries),
                queries, origin(U(0u), choice.index));
  }

  const LightTracingScene<Rays>& shared_;
  const Scene& scene_;
  const float scale_;  // of one path's light: a frame has one path for each pixel or cell of the pass
  RayCounts counts_;
  LensSplats<F, Rays, in_media> lens_;
  U light_ = U(0u);  // of the paths at hand
};

}  // namespace montelux
