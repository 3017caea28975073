// Light that places of the scene send to the lens, splatted where the camera shows it.
#pragma once
#include "integrator/integrator.h"
#include "integrator/splats.h"
#include "scene/scene.h"
#include "transport/next_vertex.h"
#include "transport/transmittance.h"

namespace montelux {

// A place that sends light.
template <class F>
struct LensPlace {
  Vec3<F> p, p_error, ng;
};
// Its connection with the lens.
template <class F>
struct LensWay {
  Media<F> media;  // toward the lens
  LensConnection<F> lens;
  F time;
  RandomStream<F> random;  // for what half-open surfaces do on the way
};

// Whether some surface is not there for camera rays that meet its back.
inline bool has_one_sided_surfaces(const Scene& scene) {
  for (const GeometryRow& row : scene.geometry.rows)
    if ((row.flags & GeometryRow::one_sided) != 0) return true;
  return false;
}

// What the paths of a frame send to the lens; `rays` has the interface of Accel. `in_media`: the scene has
// participating media. `Plane` is a SplatPlane, or keeps the splat of each lane by record(raster, light, on, origin).
template <class F, class Rays, bool in_media = false, class Plane = SplatPlane>
class LensSplats {
 public:
  using M = Mask<F>;
  LensSplats(const Scene& scene, const Rays& rays, bool one_sided, Plane& plane, RayCounts& counts)
      : scene_(scene), rays_(rays), one_sided_(one_sided), plane_(plane), counts_(counts) {}

  // The lens as seen from p: where it is behind or the picture does not reach, `seen` is false.
  LensConnection<F> toward(const Vec3<F>& p, const Vec2<F>& u, const F& time) const {
    LensConnection<F> lens = scene_.camera.toward(p, u, time);
    lens.seen = lens.seen & plane_.reaches(lens.raster);
    return lens;
  }
  // Splats the light that a place sends to the lens, where nothing is in between.
  void connect(const LensPlace<F>& from, const LensWay<F>& way, const Spectrum<F>& contribution, M on,
               const LightOrigin<F>& origin) {
    connect(from, way, contribution, on, origin, [](const F&) { return F(1.0f); });
  }
  // weight(passing) is that of the light, as Transmitted has `passing`.
  template <class Weight>
  void connect(const LensPlace<F>& from, const LensWay<F>& way, const Spectrum<F>& contribution, M on,
               LightOrigin<F> origin, Weight weight) {
    if (!any(on)) return;
    Spectrum<F> left;
    if constexpr (in_media) {
      const Transmitted<F> seen = transmission(from, way, on);
      left = seen.left, origin.weight = weight(seen.passing), on = on & !is_black(left);
    } else {
      left = way.media.left(way.lens.distance), origin.weight = weight(F(1.0f)), on = on & !is_hidden(from, way, on);
    }
    splat(way.lens.raster, contribution * left * origin.weight, on, origin);
  }
  // What the lens sees of the sky along the ray: a share of its light.
  Spectrum<F> sky_seen(const Ray<F>& ray, const RandomStream<F>& random, M on) {
    if constexpr (in_media)
      return transmitted<F, false>(scene_, rays_, ray, media_of<F>(scene_.media, Uint<F>(scene_.camera_medium)), on,
                                   random, counts_.shadow, RayUse::camera)
          .left;
    return select(sees_sky(ray, random, on), gray(F(1.0f)), gray(F(0.0f)));
  }
  void splat(const Vec2<F>& raster, const Spectrum<F>& contribution, M on, const LightOrigin<F>& origin) {
    if constexpr (requires { plane_.record(raster, contribution, on, origin); })
      return plane_.record(raster, contribution, on, origin);
    else
      return splat_to_plane(raster, contribution, on, origin);
  }

 private:
  void splat_to_plane(const Vec2<F>& raster, const Spectrum<F>& contribution, M on, const LightOrigin<F>& origin) {
    if (plane_.layers()) return splat_to_layers(raster, contribution, on, origin);
    for_each_lane(on, [&](int k) {
      const Rgb value = to_rgb(lane(contribution, k));
      scene_.camera.for_each_place(lane(raster, k), [&](Vec2f place) { plane_.add(place, value); });
    });
  }
  void splat_to_layers(const Vec2<F>& raster, const Spectrum<F>& contribution, M on, const LightOrigin<F>& origin) {
    for_each_lane(on, [&](int k) {
      const Rgb value = to_rgb(lane(contribution, k));
      const LightOrigin<float> from = lane_of(origin, k);
      scene_.camera.for_each_place(lane(raster, k), [&](Vec2f place) { plane_.add(place, value, from); });
    });
  }
  M sees_sky(const Ray<F>& ray, const RandomStream<F>& random, M on) {
    counts_.shadow += std::uint64_t(count(on));
    if (!one_sided_) return on & !rays_.template occluded<F>(ray, on);
    return on & !camera_ray(ray, random, on).found;
  }
  Transmitted<F> transmission(const LensPlace<F>& from, const LensWay<F>& way, M on) {
    const LensConnection<F>& lens = way.lens;
    if (!one_sided_)
      return transmitted(scene_, rays_, shadow_ray(from.p, from.p_error, from.ng, -lens.d, lens.distance, way.time),
                         way.media, on, way.random, counts_.shadow);
    // As the camera sees it, which passes by the backs of one-sided surfaces.
    return transmitted(scene_, rays_, {lens.p, lens.d, lens.distance * (1 - shadow_shortening), way.time},
                       media_of<F>(scene_.media, Uint<F>(scene_.camera_medium)), on, way.random, counts_.shadow,
                       RayUse::camera);
  }
  M is_hidden(const LensPlace<F>& from, const LensWay<F>& way, M on) {
    counts_.shadow += std::uint64_t(count(on));
    const LensConnection<F>& lens = way.lens;
    if (!one_sided_)
      return rays_.template occluded<F>(shadow_ray(from.p, from.p_error, from.ng, -lens.d, lens.distance, way.time),
                                        on);
    // As the camera sees it, which passes by the backs of one-sided surfaces: what it sees must be the place.
    const NextVertex<F> seen = camera_ray({lens.p, lens.d, F(ray_infinity), way.time}, way.random, on);
    return on & !(seen.found & (abs(seen.distance - lens.distance) <= F(shadow_shortening) * lens.distance));
  }
  NextVertex<F> camera_ray(const Ray<F>& ray, const RandomStream<F>& random, M on) {
    const auto [found, hit] = rays_.template trace<F>(ray, on, RayUse::camera);
    return follow_ray<F>(scene_, rays_, free_point(ray.o), ray, hit, found, random, counts_.scattered, NoWeight{});
  }

  const Scene& scene_;
  const Rays& rays_;
  const bool one_sided_;
  Plane& plane_;
  RayCounts& counts_;
};

}  // namespace montelux
