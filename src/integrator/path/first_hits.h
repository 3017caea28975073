// Camera rays of a tile, traced as coherent packets, and the store of their hits from which the path loop fills its
// lanes.
#pragma once
#include <utility>

#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/path/lamp_pixels.h"
#include "integrator/tally.h"
#include "math/lane_queue.h"
#include "scene/scene.h"
#include "scene/surface.h"
#include "transport/light_met.h"
#include "transport/next_vertex.h"
#include "transport/numbers.h"
#include "transport/path_state.h"

namespace montelux {

// The paths of a tile that met a surface, in a fixed order: that of the packets. A loop that sets paths aside takes
// them through their first vertex in full packs of neighbours, whose materials, texels, lights and shadow rays are
// alike; then they take the place of others that have ended, in any order.
template <class F>
class FirstHits {
 public:
  // `rays` has trace() as Accel does.
  template <class Rays, class Tally>
  FirstHits(const Scene& scene, const Rays& rays, const TilePass& pass, std::span<PixelSample> out, Tally& tally,
            const LampRays& lamps = {});
  template <class Rays>
  FirstHits(const Scene& scene, const Rays& rays, const TilePass& pass, std::span<PixelSample> out)
      : FirstHits(scene, rays, pass, out, no_tally) {}

  // Fills lanes that are off, as long as there are paths left; returns the lanes that are on now. None is on once the
  // caller of the pass wants to stop.
  Mask<F> refill(PathState<F>& state, Mask<F> on);
  // For loops that keep nothing of a path but its state: `on` are the paths that continue beyond a vertex. Returns
  // those that stay in their lanes.
  Mask<F> set_aside(const PathState<F>& state, Mask<F> on);
  // The lanes in which the path loop adds the light of emitters that paths meet: not what lamp rays have shown of it.
  Mask<F> counts_emitter(const PathState<F>& state, Mask<F> on) const;
  std::uint64_t rays() const { return rays_; }

 private:
  // Fills lanes that are off with paths at their first vertex.
  Mask<F> begin(PathState<F>& state, Mask<F> on);

  LaneQueue<PathStart, F> starts_;
  LaneQueue<PathState, F> waiting_;  // beyond their first vertex
  bool sets_aside_ = false;          // the loop calls set_aside()
  bool begins_ = true;               // then: paths at their first vertex have the lanes, else those beyond it
  Media<F> media_;                   // of the camera
  const StopQuery* stop_ = nullptr;
  std::vector<std::uint8_t> shown_;  // by output, 1: by lamp rays; empty: none is
  std::uint64_t rays_ = 0;
};

// The sink of first_vertex() for light that the camera sees directly: adds it to the tally.
template <class F, class Tally>
auto seen_directly([[maybe_unused]] const PathState<F>& path, [[maybe_unused]] Tally& tally) {
  return [&]([[maybe_unused]] Mask<F> on, [[maybe_unused]] const Spectrum<F>& contribution,
             [[maybe_unused]] const Uint<F>& number, Technique) {
    if constexpr (Tally::records)
      tally.template add<F>(on, contribution * path.weight, {Uint<F>(0u), number, Technique::emission});
  };
}

// Camera packets cover blocks of pixels as square as the lanes allow.
template <class F>
constexpr int block_width() {
  return lanes_of<F> == 16 ? 4 : lanes_of<F> >= 4 ? lanes_of<F> / 2 : 1;
}

// The pixels that cells of the pass stand for in the samples of these numbers. Where cells show means, a pixel is drawn
// for each sample of each cell and pass. Lanes beyond the grid have any pixel.
template <class F>
std::pair<Uint<F>, Uint<F>> pixels_of(const std::optional<PixelGrid>& grid, const PointSet& points, Uint<F> x,
                                      Uint<F> y, Uint<F> index) {
  if (!grid || grid->stride == 1) return {x, y};
  for (int k = 0; k < lanes_of<F>; ++k) {
    const auto cell_x = int(lane(x, k)), cell_y = int(lane(y, k));
    const PixelBounds pixels = grid->pixels(cell_x, cell_y);
    if (!grid->is_mean || pixels.width() <= 0 || pixels.height() <= 0) {
      set_lane(x, k, std::uint32_t(grid->pixel_x(cell_x)));
      set_lane(y, k, std::uint32_t(grid->pixel_y(cell_y)));
      continue;
    }
    const std::uint32_t place = std::uint32_t(cell_y) * 0x10000u + std::uint32_t(cell_x);
    RandomStream<float> drawn(mix_bits(points.seed ^ mix_bits(points.pass)) + lane(index, k), place);
    const float u = drawn.next(), v = drawn.next();
    set_lane(x, k, std::uint32_t(pixels.x0 + std::min(int(u * float(pixels.width())), pixels.width() - 1)));
    set_lane(y, k, std::uint32_t(pixels.y0 + std::min(int(v * float(pixels.height())), pixels.height() - 1)));
  }
  return {x, y};
}

// The camera ray of a sample of a pixel, at this point of its filter, by the numbers of its sample point.
template <class F, NumberSource<F> Numbers>
PathStart<F> start_of_path(const Scene& scene, const TilePass& pass, const PathSite<F>& site, const Numbers& numbers,
                           FilterSample<F> filtered) {
  const auto& [x, y, index] = site;
  Vec2<F> on_lens = numbers.get2(Uint<F>(path_dimension::lens));
  if (scene.pixel_centres) filtered = {{F(0.0f), F(0.0f)}, F(1.0f)}, on_lens = {F(0.5f), F(0.5f)};
  // Pixels left of the image, or above it, have numbers below 0.
  const auto place = [](const Uint<F>& i) {
    constexpr std::uint32_t beyond = 1u << 16;
    return to_float(i + Uint<F>(beyond)) - float(beyond);
  };
  Vec2<F> raster{place(x) + 0.5f + filtered.offset.x, place(y) + 0.5f + filtered.offset.y};
  F time = 0.0f;
  if (scene.moves()) {
    const F drawn = scene.pixel_centres ? F(0.5f) : numbers.get1(Uint<F>(path_dimension::time));
    const F shutter_sample = pass.shutter_sample ? F(*pass.shutter_sample) : drawn;
    time = pass.shutter.value_or(scene.shutter).time(shutter_sample);
  }
  CameraRay<F> camera = scene.camera.generate(raster, on_lens, time);
  PathStart<F> state;
  state.o = camera.ray.o, state.d = camera.ray.d;
  state.weight = camera.weight * filtered.weight * scene.imaging_ratio;
  state.time = time;
  state.x = x, state.y = y, state.index = index;
  state.seen = gray(F(0.0f));
  return state;
}

// At the point that the numbers draw from the filter.
template <class F, NumberSource<F> Numbers>
PathStart<F> start_of_path(const Scene& scene, const TilePass& pass, const PathSite<F>& site, const Numbers& numbers) {
  return start_of_path<F>(scene, pass, site, numbers, scene.filter.sample(numbers.get2(Uint<F>(path_dimension::film))));
}

// At the offset that the pass states for the sample, if it does.
template <class F>
PathStart<F> start_of_path(const Scene& scene, const TilePass& pass, const PathSite<F>& site) {
  const auto numbers = numbers_of<F>(pass.points, site);
  if (pass.offsets.empty()) return start_of_path<F>(scene, pass, site, numbers);
  const Vec2<F> offset = gather2<F>(&pass.offsets.front().x, site.index * Uint<F>(2u));
  return start_of_path<F>(scene, pass, site, numbers, {offset, F(1.0f)});
}

// Camera rays that leave the scene show the sky: in a tally light by light.
template <class F, class Tally>
void show_sky(const Scene& scene, const PathStart<F>& start, Mask<F> left, std::span<PixelSample> out,
              [[maybe_unused]] Tally& tally) {
  if (!any(left)) return;
  const Spectrum<F> all = (scene.lights.template escaped_radiance<F>(start.d, left) + start.seen) * start.weight;
  const Spectrum<F> emission = start.seen * start.weight;
  for_each_lane(left, [&](int k) {
    PixelSample& sample = out[lane(start.output, k)];
    sample.radiance = to_rgb(lane(all, k)), sample.features.emission = to_rgb(lane(emission, k));
  });
  if constexpr (Tally::records) {
    const Vec3<F> nowhere{F(0.0f), F(0.0f), F(0.0f)};
    for (int i = 0; i < scene.lights.infinite_count(); ++i) {
      const LightHit<F> sky = scene.lights.template escaped<F>(i, start.o, nowhere, start.d, left);
      const Uint<F> light = Uint<F>(std::uint32_t(scene.lights.infinite_light(i)));
      tally.template add<F>(left, sky.radiance * start.weight, LightOrigin<F>{Uint<F>(0u), light, Technique::emission});
    }
    for_each_lane(left, [&](int k) { tally.finish(k, lane(start.output, k), out[lane(start.output, k)]); });
  }
}

// Numbers whose points on the picture are in a part of the pixel's filter.
template <class F, NumberSource<F> Numbers>
struct NumbersOfPart {
  const Numbers& all;
  const FilterPart<F>& part;
  F get1(const Uint<F>& dimension) const { return all.get1(dimension); }
  Vec2<F> get2(const Uint<F>& dimension) const {
    const Vec2<F> u = all.get2(dimension);
    if (lane(dimension, 0) != path_dimension::film) return u;
    return {part.low.x + part.size.x * u.x, part.low.y + part.size.y * u.y};
  }
  RandomStream<F> stream(const Uint<F>& dimension) const { return all.stream(dimension); }
};

// What follow_segment() reports the light of emitters to that a camera ray meets. Calls sink(on, radiance, light).
template <class F, class Sink>
struct EmittersOnRay {
  static constexpr bool sees_media = false;
  const Scene& scene;
  const Ray<F>& ray;
  Sink sink;
  void emitter(const EmitterOnRay<F>& met, Mask<F> on) {
    const Vec3<F> nowhere{F(0.0f), F(0.0f), F(0.0f)};
    const LightHit<F> light = emission_met<F>(scene.lights, {ray.o, nowhere}, met.v.x, ray.d, on);
    sink(on, met.left * light.radiance, met.v.x.light - Uint<F>(1u));
  }
  void sky(const SkyOnRay<F>&, Mask<F>) {}
  void medium(const Spectrum<F>&, Mask<F>) {}
};

// The light of emitters on camera rays that have met `hit` where `found`: through interfaces, less what media absorb
// and scatter. Calls sink(on, radiance, light). Adds the rays that are traced to `traced`.
template <class F, class Rays, class Numbers, class Sink>
void show_emitters(const Scene& scene, const Rays& rays, const Ray<F>& ray, const Hit<F>& hit, Mask<F> found,
                   const Numbers& numbers, std::uint64_t& traced, Sink sink) {
  if (scene.materials.has_interfaces()) {
    const Media<F> media = media_of<F>(scene.media, Uint<F>(scene.camera_medium));
    EmittersOnRay<F, Sink> emitters{scene, ray, sink};
    RayProgress<F> way{{ray, hit, media}, gray(F(1.0f)), F(1.0f), Uint<F>(0u)};
    follow_segment<F>(scene, rays, way, {found, Mask<F>(false)}, numbers.stream(Uint<F>(path_dimension::own)), traced,
                      emitters);
    return;
  }
  const Mask<F> met = meets_emitter<F>(scene, hit, found);
  if (!any(met)) return;
  const SurfaceHit<F> x = surface_at<F>(scene.geometry, ray, hit, ray.time, met);
  const Vec3<F> nowhere{F(0.0f), F(0.0f), F(0.0f)};
  const LightHit<F> light = emission_met<F>(scene.lights, {ray.o, nowhere}, x, ray.d, met);
  if (scene.camera_medium == empty_space) return sink(met, light.radiance, x.light - Uint<F>(1u));
  const Media<F> media = media_of<F>(scene.media, Uint<F>(scene.camera_medium));
  sink(met, media.left(hit.t) * light.radiance, x.light - Uint<F>(1u));
}

// The light of emitters that the pixels of these samples show directly, by rays of points of their own in a part of
// their filters, beyond which they show none: all points of a pixel in a pass are one (0,2)-set. Calls sink(on,
// contribution, light). Adds the rays beyond interfaces to `traced`.
template <class F, class Rays, class Sink>
void show_lamps(const Scene& scene, const Rays& rays, const TilePass& pass, std::uint32_t count,
                const PathSite<F>& site, const FilterPart<F>& part, Mask<F> on, std::uint64_t& traced, Sink sink) {
  using U = Uint<F>;
  PointSet points = pass.points;
  points.kind = PointSetKind::padded_sobol, points.seed = mix_bits(points.seed ^ 0x1f83d9abu);
  points.samples_per_pass *= count;
  TilePass of_rays = pass;
  of_rays.points = points;
  const F share_of_ray = part.mass() * F(1.0f / float(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    const PathSite<F> of_ray{site.x, site.y, site.index * U(count) + U(i)};
    const auto numbers = numbers_of<F>(points, of_ray);
    const NumbersOfPart<F, std::remove_cvref_t<decltype(numbers)>> of_part{numbers, part};
    const PathStart<F> start = start_of_path<F>(scene, of_rays, of_ray, of_part);
    const Ray<F> ray{start.o, start.d, F(ray_infinity), start.time};
    const auto [found, hit] = rays.template trace<F>(ray, on, RayUse::camera);
    const auto add = [&](Mask<F> met, const Spectrum<F>& radiance, const U& light) {
      sink(met, radiance * (start.weight * share_of_ray), light);
    };
    show_emitters<F>(scene, rays, ray, hit, found, numbers, traced, add);
  }
}

template <class F>
template <class Rays, class Tally>
FirstHits<F>::FirstHits(const Scene& scene, const Rays& rays, const TilePass& pass, std::span<PixelSample> out,
                        Tally& tally, const LampRays& lamps) {
  using U = Uint<F>;
  stop_ = pass.stop;
  media_ = media_of<F>(scene.media, Uint<F>(scene.camera_medium));
  const Mask<F> in_medium(scene.camera_medium != empty_space);
  constexpr int block_x = block_width<F>(), block_y = lanes_of<F> / block_x;
  const PixelBounds& tile = pass.tile;
  const std::uint32_t samples = pass.samples(), first = pass.only.value_or(0);
  starts_.reserve(std::size_t(tile.area()) * samples);
  const U lane_number = lane_index<F>();
  const U lane_x = lane_number & U(std::uint32_t(block_x - 1));
  U lane_y = U(0u);
  for (int k = 0; k < lanes_of<F>; ++k) set_lane(lane_y, k, std::uint32_t(k / block_x));

  for (std::uint32_t sample = 0; sample < samples; ++sample)
    for (int y0 = tile.y0; y0 < tile.y1; y0 += block_y)
      for (int x0 = tile.x0; x0 < tile.x1; x0 += block_x) {
        U x = lane_x + U(std::uint32_t(x0)), y = lane_y + U(std::uint32_t(y0));
        Mask<F> on = (U(x - U(std::uint32_t(tile.x0))) < U(std::uint32_t(tile.width()))) &
                     (U(y - U(std::uint32_t(tile.y0))) < U(std::uint32_t(tile.height())));
        const auto [pixel_x, pixel_y] = pixels_of<F>(pass.grid, pass.points, x, y, U(first + sample));
        PathStart<F> state = start_of_path<F>(scene, pass, {pixel_x, pixel_y, U(first + sample)});
        state.output =
            ((y - U(std::uint32_t(tile.y0))) * U(std::uint32_t(tile.width())) + x - U(std::uint32_t(tile.x0))) *
                U(samples) +
            U(sample);
        auto [found, hit] = rays.template trace<F>({state.o, state.d, F(ray_infinity), state.time}, on, RayUse::camera);
        state.hit = hit;
        rays_ += std::uint64_t(count(on));
        if (lamps.pixels) {
          const bool is_shared = !pass.offsets.empty();
          const PathSite<F> site{pixel_x, pixel_y, U(first + sample)};
          const Mask<F> wanted = lamps.pixels->template at<F>(scene, rays, site.x, site.y, on);
          if (is_shared) {
            // What counts for pixels without rays of their own.
            shown_.resize(out.size(), 1);
            const Ray<F> ray{state.o, state.d, F(ray_infinity), state.time};
            show_emitters<F>(scene, rays, ray, hit, found, numbers_of<F>(pass.points, site), rays_,
                             [&](Mask<F> met, const Spectrum<F>& radiance, [[maybe_unused]] const U& light) {
                               const Spectrum<F> emission = radiance * state.weight;
                               for_each_lane(met, [&](int k) {
                                 Rgb& sum = out[lane(state.output, k)].emission;
                                 const Rgb more = to_rgb(lane(emission, k));
                                 for (int c = 0; c < rgb_size; ++c) sum.c[c] += more.c[c];
                               });
                               if constexpr (TakesEarlyLight<Tally>)
                                 for_each_lane(met & !wanted, [&](int k) {
                                   tally.add_early(lane(state.output, k), lane(emission, k),
                                                   {0, lane(light, k), Technique::emission});
                                 });
                             });
          }
          if (any(wanted)) {
            shown_.resize(out.size());
            const FilterPart<F> part = lamps.pixels->template part<F>(site.x, site.y, wanted);
            // As many rays over all of the filter would have as many in this part.
            const F as_many = min(F(float(lamps.count)) / part.mass(), F(float(max_emission_rays)));
            for_each_lane(wanted, [&](int k) {
              const std::uint32_t output = lane(state.output, k);
              shown_[output] = 1;
              out[output].features.emission_rays = std::uint32_t(lane(as_many, k));
            });
            Spectrum<F> seen = gray(F(0.0f));
            show_lamps<F>(scene, rays, pass, lamps.count, site, part, wanted, rays_,
                          [&](Mask<F> met, const Spectrum<F>& contribution, [[maybe_unused]] const U& light) {
                            seen += select(met, contribution, gray(F(0.0f)));
                            if constexpr (TakesEarlyLight<Tally>)
                              for_each_lane(met, [&](int k) {
                                tally.add_early(lane(state.output, k), lane(contribution, k),
                                                {0, lane(light, k), Technique::emission});
                              });
                          });
            if (is_shared) {
              for_each_lane(wanted, [&](int k) { out[lane(state.output, k)].lamps = to_rgb(lane(seen, k)); });
            } else {
              state.seen = seen * select(state.weight != F(0.0f), F(1.0f) / state.weight, F(0.0f));
              // Of paths that meet no surface beyond; the first one writes it again.
              const Spectrum<F> emission = state.seen * state.weight;
              if (any(in_medium) || scene.materials.has_interfaces())
                for_each_lane(wanted,
                              [&](int k) { out[lane(state.output, k)].features.emission = to_rgb(lane(emission, k)); });
            }
            rays_ += std::uint64_t(count(wanted)) * lamps.count;
          }
        }
        // In a medium a path may scatter on a ray that meets no surface: its t is infinite.
        const Mask<F> starts = found | (on & in_medium);
        starts_.add(state, starts);
        show_sky<F>(scene, state, on & !starts, out, tally);
      }
}

template <class F>
Mask<F> FirstHits<F>::begin(PathState<F>& state, Mask<F> on) {
  PathStart<F> start{};
  const Mask<F> fresh = starts_.fill(start, on);
  if (any(fresh)) begin_paths(state, start, media_, fresh);
  return on | fresh;
}

template <class F>
Mask<F> FirstHits<F>::refill(PathState<F>& state, Mask<F> on) {
  if (stop_ && stop_->stop_requested()) return Mask<F>(false);
  if (!sets_aside_) return begin(state, on);
  // Enough for many packs, and so few that they stay in the nearest caches.
  constexpr std::size_t enough = 512;
  if (!begins_ && waiting_.is_empty() && !starts_.is_empty()) {
    begins_ = true;
    on = set_aside(state, on);
  }
  begins_ = begins_ && waiting_.size() < enough && !starts_.is_empty();
  return begins_ ? begin(state, on) : Mask<F>(on | waiting_.fill(state, on));
}

template <class F>
Mask<F> FirstHits<F>::counts_emitter(const PathState<F>& state, Mask<F> on) const {
  if (shown_.empty()) return on;
  std::uint32_t counts = bits(on);
  for_each_lane(on & (state.depth == Uint<F>(0u)),
                [&](int k) { counts &= ~(std::uint32_t(shown_[lane(state.output, k)]) << k); });
  return mask_of_bits<F>(counts);
}

template <class F>
Mask<F> FirstHits<F>::set_aside(const PathState<F>& state, Mask<F> on) {
  sets_aside_ = true;
  if (!begins_) return on;
  waiting_.add(state, on);
  return Mask<F>(false);
}

}  // namespace montelux
