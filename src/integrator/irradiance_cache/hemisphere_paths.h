// Paths from a point of a diffuse surface into its hemisphere: what other surfaces send there.
#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "integrator/irradiance_cache/cache.h"
#include "integrator/path/loop.h"
#include "math/lane_queue.h"

namespace montelux {

// A diffuse surface on the side that is looked at, whose irradiance is wanted.
struct CachePoint {
  CacheQuery query;
  Vec3f p_error, ng;
  Media<float> media;   // on that side
  float time;           // of the path that arrived there
  std::uint32_t depth;  // its scattering events before
  std::uint32_t x, y;   // its pixel: no two points of a frame have the same one
  float distance = 0;   // harmonic mean of those around, once it is known
};

// The numbers of the paths of all points of one frame that serve one purpose: every pixel has its own.
inline PointSet hemisphere_points(PointSet points, int frame, std::uint32_t purpose, const HemisphereStrata& strata) {
  points.kind = PointSetKind::independent;
  points.samples_per_pass = std::uint32_t(strata.count());
  points.seed = mix_bits(points.seed ^ mix_bits(std::uint32_t(frame) * 2 + purpose + 0x1f83d9abu));
  return points;
}

// The numbers of the paths, and the plan of the layers into which their light is split; null: there are none.
struct HemisphereNumbers {
  PointSet points;
  const LayerPlan* layers = nullptr;
};

// The path loop, through participating media where the scene has any.
template <class F, class Rays, class Source, class Tally>
RayCounts run_cache_paths(const Scene& scene, const Rays& rays, const PathSettings& settings, const TilePass& pass,
                          std::span<PixelSample> out, Source& source, Tally& tally) {
  if (scene.media.empty()) return run_paths<F>(scene, scene.lights, rays, settings, pass, out, source, tally);
  return run_paths<F, true>(scene, scene.lights, rays, settings, pass, out, source, tally);
}

// One direction in each cell of the strata, followed by the path loop. Emission that a direction meets is direct light
// of the point, and does not count; nor does what a medium emits on the way to it.
template <class F, class Rays>
class HemispherePaths {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // What is referred to must outlive this; adds the rays to `counts`.
  HemispherePaths(const Scene& scene, const Rays& rays, const PathSettings& settings, const HemisphereStrata& strata,
                  const HemisphereNumbers& numbers, RayCounts& counts)
      : scene_(scene),
        rays_(rays),
        settings_(settings),
        strata_(strata),
        counts_(counts),
        pass_{{}, numbers.points},
        layers_(numbers.layers) {}

  // The harmonic mean distance of the surfaces around the point: that of estimate() at the cost of its first rays.
  float distance(const CachePoint& at) {
    begin(at);
    return harmonic_mean_distance(distances_);
  }
  // A record for the point.
  CacheRecord estimate(const CachePoint& at) {
    begin(at);
    results_.assign(distances_.size(), PixelSample{});
    std::optional<PartsTally> tally;
    if (layers_) tally.emplace(*layers_, results_.size(), at.depth);
    if (!starts_.is_empty()) counts_ += tally ? run(*tally) : run(no_tally);
    samples_.clear();
    for (std::size_t i = 0; i < results_.size(); ++i)
      samples_.push_back({from_rgb(results_[i].radiance), distances_[i]});
    const HemisphereEstimate all = integrate(at);
    CacheRecord record{at.query, all.irradiance, all.gradients, all.distance};
    if (tally) add_parts(at, *tally, record);
    return record;
  }

  // For the path loop.
  M refill(PathState<F>& path, M on) { return on | starts_.fill(path, on); }
  M counts_light(const PathState<F>& path, M on) const { return on & (path.depth != U(first_depth_)); }

 private:
  template <class Tally>
  RayCounts run(Tally& tally) {
    return run_cache_paths<F>(scene_, rays_, settings_, pass_, results_, *this, tally);
  }
  HemisphereEstimate integrate(const CachePoint& at) const {
    return integrate_hemisphere(strata_, samples_, LocalFrame<float>::from_normal(at.query.n));
  }
  // What each origin alone sends there.
  void add_parts(const CachePoint& at, PartsTally& tally, CacheRecord& record) {
    std::vector<LightPart> origins;
    std::vector<std::vector<LightPart>> by_cell(results_.size());
    for (std::size_t i = 0; i < by_cell.size(); ++i) {
      by_cell[i] = tally.take(i);
      for (const LightPart& part : by_cell[i]) add_part(origins, part.from, part.contribution);
    }
    for (const LightPart& origin : origins) {
      for (std::size_t i = 0; i < by_cell.size(); ++i) {
        samples_[i].radiance = gray(0.0f);
        for (const LightPart& part : by_cell[i])
          if (same_origin(part.from, origin.from)) samples_[i].radiance = part.contribution;
      }
      const HemisphereEstimate estimate = integrate(at);
      record.parts.push_back({origin.from, estimate.irradiance, estimate.gradients});
    }
  }
  // The paths at their first vertices, and the distances of these.
  void begin(const CachePoint& at) {
    first_depth_ = at.depth + 1;
    const int cells = strata_.count();
    distances_.assign(std::size_t(cells), std::numeric_limits<float>::infinity());
    const LocalFrame<float> local = LocalFrame<float>::from_normal(at.query.n);
    const LocalFrame<F> frame{splat<F>(local.s), splat<F>(local.t), splat<F>(local.n)};
    const Vec3<F> p = splat<F>(at.query.p), p_error = splat<F>(at.p_error), ng = splat<F>(at.ng);
    Media<F> media{};
    for (int k = 0; k < lanes_of<F>; ++k) set_lane_words(media, k, at.media);
    for (int first = 0; first < cells; first += lanes_of<F>) {
      const U cell = lane_index<F>() + U(std::uint32_t(first));
      const M on = cell < U(std::uint32_t(cells));
      PathStart<F> start{};
      F row(0.0f), column(0.0f);
      for (int k = 0; k < lanes_of<F>; ++k) {
        set_lane(row, k, float((first + k) / strata_.columns)),
            set_lane(column, k, float((first + k) % strata_.columns));
      }
      start.x = U(at.x), start.y = U(at.y), start.index = select(on, cell, U(0u)), start.output = start.index;
      const Vec2<F> u =
          numbers_of<F>(pass_.points, PathSite<F>{start.x, start.y, start.index}).get2(U(path_dimension::film));
      start.d = frame.to_world(strata_.template direction<F>(row, column, u));
      start.o = offset_origin(p, p_error, ng, start.d);
      start.weight = F(1.0f), start.time = F(at.time);
      counts_.scattered += std::uint64_t(count(on));
      const auto [found, hit] = rays_.template trace<F>({start.o, start.d, F(ray_infinity), start.time}, on);
      start.hit = hit;
      PathState<F> path{};
      begin_paths(path, start, media, on);
      path.p = p, path.depth = U(first_depth_);
      for_each_lane(found, [&](int k) { distances_[lane(start.output, k)] = lane(start.hit.t, k); });
      // In a medium a path may scatter on a ray that meets no surface.
      const M in_medium(at.media.medium != empty_space);
      starts_.add(path, on & (found | in_medium));
    }
  }

  const Scene& scene_;
  const Rays& rays_;
  const PathSettings& settings_;
  const HemisphereStrata strata_;
  RayCounts& counts_;
  TilePass pass_;  // for its points alone
  const LayerPlan* layers_;
  std::uint32_t first_depth_ = 0;
  LaneQueue<PathState, F> starts_;
  std::vector<float> distances_;
  std::vector<PixelSample> results_;
  std::vector<HemisphereSample> samples_;
};

}  // namespace montelux
