// A cache that fills: in stages, each by many threads, with a barrier between two, so that its records depend neither
// on threads nor on tiles.
#pragma once
#include <algorithm>
#include <vector>

#include "integrator/irradiance_cache/cached_paths.h"
#include "integrator/irradiance_cache/settings.h"
#include "math/lane_queue.h"

namespace montelux {

// The paths of some pixels at their first surface, as FirstHits has those of a whole tile.
template <class F>
class PixelStarts {
 public:
  struct Pixel {
    std::uint32_t x, y;
  };
  // One path for each pixel, the sample `pass.only` of the pass; the pixel's place in the list is the path's output.
  template <class Rays>
  PixelStarts(const Scene& scene, const Rays& rays, const TilePass& pass, std::span<const Pixel> pixels,
              RayCounts& counts)
      : media_(media_of<F>(scene.media, Uint<F>(scene.camera_medium))) {
    for (std::size_t first = 0; first < pixels.size(); first += lanes_of<F>) {
      PathSite<F> site{Uint<F>(0u), Uint<F>(0u), Uint<F>(pass.only.value_or(0))};
      Uint<F> output(0u);
      const int n = int(std::min(pixels.size() - first, std::size_t(lanes_of<F>)));
      for (int k = 0; k < n; ++k) {
        const Pixel& pixel = pixels[first + std::size_t(k)];
        set_lane(site.x, k, pixel.x), set_lane(site.y, k, pixel.y);
        set_lane(output, k, std::uint32_t(first) + std::uint32_t(k));
      }
      PathStart<F> start = start_of_path<F>(scene, pass, site);
      start.output = output;
      counts.camera += std::uint64_t(n);
      const Mask<F> on = lane_index<F>() < Uint<F>(std::uint32_t(n)), in_medium(scene.camera_medium != empty_space);
      const auto [found, hit] =
          rays.template trace<F>({start.o, start.d, F(ray_infinity), start.time}, on, RayUse::camera);
      start.hit = hit;
      starts_.add(start, on & (found | in_medium));
    }
  }
  Mask<F> refill(PathState<F>& path, Mask<F> on) {
    PathStart<F> start{};
    const Mask<F> fresh = starts_.fill(start, on);
    if (any(fresh)) begin_paths(path, start, media_, fresh);
    return on | fresh;
  }

 private:
  LaneQueue<PathStart, F> starts_;
  Media<F> media_;
};

// The paths of an irradiance cache: what `path` does by default, as long as the settings say.
inline PathSettings cached_path_settings(const IrradianceCacheSettings& settings) {
  PathSettings path;
  path.mis = PathMis::power;
  path.max_depth = settings.max_depth, path.roulette_depth = settings.roulette_depth;
  return path;
}

// The cache of one series. In the first frame, which is not shown, it is filled from coarse to fine: each level looks
// at the pixels of a grid twice as dense as that before, and makes records where there are none yet. Later frames add
// records where the frame before had none.
//
// A level has four stages: points without a record are found, with the distances around them (find, over tiles); it is
// decided which of them become records (thin, one unit); their hemispheres are sampled (compute, units of a few
// records); they are added to the cache (add, one unit).
template <class F, class Rays>
class CacheFilling {
 public:
  static constexpr int levels = 5, stages_of_level = 4, stages = levels * stages_of_level;
  static constexpr std::size_t records_per_unit = 4;

  // What is referred to must outlive this. The spacings of the settings are not zero.
  CacheFilling(const Scene& scene, const Rays& rays, const IrradianceCacheSettings& settings, const SeriesPass& pass)
      : scene_(scene),
        rays_(rays),
        settings_(settings),
        path_(cached_path_settings(settings)),
        pass_(shown(pass)),
        random_(mix_bits(pass.points.seed ^ mix_bits(pass.points.pass + 0x510e527fu))),
        strata_(HemisphereStrata::of(settings.samples)),
        rules_{settings.accuracy, settings.min_spacing, std::max(settings.max_spacing, settings.min_spacing),
               settings.gradients, settings.clamping},
        cache_(rules_),
        found_(std::size_t(pass.bounds.area())),
        missed_(std::size_t(pass.bounds.area())) {}

  // The units of a stage of the filling; none: they are the tiles.
  std::optional<std::size_t> units(int frame, int stage) const {
    // The few pixels of a sparse picture have hardly a record in common: their paths continue instead.
    if (pass_.grid || (frame > 0 && level_of(stage) + 1 < levels)) return 0;
    switch (stage % stages_of_level) {
      case find_stage:
        return std::nullopt;
      case compute_stage:
        return (chosen_.size() + records_per_unit - 1) / records_per_unit;
      default:
        return 1;
    }
  }
  RayCounts run_unit(int frame, int stage, std::size_t unit) {
    RayCounts counts;
    if (stage % stages_of_level == thin_stage)
      thin();
    else if (stage % stages_of_level == compute_stage)
      compute(frame, unit, counts);
    else
      add();
    return counts;
  }
  // The stage whose units are tiles.
  RayCounts run(int frame, int stage, const PixelBounds& tile) {
    RayCounts counts;
    find(frame, level_of(stage), tile, counts);
    return counts;
  }

  const IrradianceCache& cache() const { return cache_; }
  const PathSettings& path() const { return path_; }
  // Points of a tile that had no record in this frame.
  void miss(const PixelBounds& tile, std::vector<CachePoint> points) {
    missed_[number_of(tile.x0, tile.y0)] = std::move(points);
  }
  const SeriesPass& pass() const { return pass_; }
  // A frame's sample of the pixels of a tile. The first frame looks where the second one, the first that is shown,
  // will.
  TilePass request(int frame, const PixelBounds& tile) const {
    return {tile, pass_.points, pass_.shutter, std::uint32_t(std::max(frame - 1, 0)), {}, pass_.grid};
  }

 private:
  static constexpr int find_stage = 0, thin_stage = 1, compute_stage = 2;
  static int level_of(int stage) { return stage / stages_of_level; }

  // The points of the frames that are shown.
  static SeriesPass shown(SeriesPass pass) {
    pass.points.samples_per_pass = std::max(pass.points.samples_per_pass, 2u) - 1;
    return pass;
  }
  std::size_t number_of(int x, int y) const {
    return std::size_t(y - pass_.bounds.y0) * std::size_t(pass_.bounds.width()) + std::size_t(x - pass_.bounds.x0);
  }

  void find(int frame, int level, const PixelBounds& tile, RayCounts& counts) {
    std::vector<CachePoint>& found = found_[number_of(tile.x0, tile.y0)];
    found = frame > 0 ? std::move(missed_[number_of(tile.x0, tile.y0)]) : points_of(tile, levels - 1 - level, counts);
    if (is_full()) found.clear();
    HemispherePaths<F, Rays> hemisphere(scene_, rays_, path_, strata_, {numbers(frame)}, counts);
    for (CachePoint& point : found) point.distance = hemisphere.distance(point);
  }
  // Points without a record in view of every 2^spacing-th pixel of every 2^spacing-th row.
  std::vector<CachePoint> points_of(const PixelBounds& tile, int spacing, RayCounts& counts) {
    std::vector<typename PixelStarts<F>::Pixel> pixels;
    // The grid lies elsewhere in every pass.
    const int mask = (1 << spacing) - 1, shift_x = int(random_ >> 16) & mask, shift_y = int(random_) & mask;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x)
        if (((x - pass_.bounds.x0) & mask) == shift_x && ((y - pass_.bounds.y0) & mask) == shift_y)
          pixels.push_back({std::uint32_t(x), std::uint32_t(y)});
    if (pixels.empty()) return {};
    const TilePass pass = request(0, tile);
    PixelStarts<F> starts(scene_, rays_, pass, pixels, counts);
    CachedPaths<F, PixelStarts<F>> paths(starts, cache_, pixels.size(), path_.max_depth.has_value());
    // The light of these paths is not wanted.
    PathSettings search = path_;
    search.nee = false;
    std::vector<PixelSample> ignored(pixels.size());
    counts += run_cache_paths<F>(scene_, rays_, search, pass, ignored, paths, no_tally);
    return std::move(paths.missed());
  }

  // Points that a record of another one would cover are left out, in an order that is random, so that the records do
  // not follow the rows of the picture.
  void thin() {
    using Place = std::pair<std::pair<std::uint32_t, std::uint64_t>, const CachePoint*>;
    std::vector<Place> order;
    for (const std::vector<CachePoint>& tile : found_)
      for (const CachePoint& point : tile) {
        const std::uint64_t pixel = std::uint64_t(point.y) << 32 | point.x;
        const std::uint32_t key = mix_bits(random_ ^ mix_bits(point.x + mix_bits(point.y)));
        order.emplace_back(std::pair(key, pixel), &point);
      }
    std::ranges::sort(order, {}, &Place::first);
    IrradianceCache planned(rules_);
    chosen_.clear();
    for (const auto& [key, point] : order) {
      if (cache_.size() + chosen_.size() >= std::size_t(settings_.records)) break;
      if (planned.covers(point->query)) continue;
      planned.insert({point->query, gray(0.0f), {}, point->distance});
      chosen_.push_back(*point);
    }
    estimates_.resize(chosen_.size());
    for (std::vector<CachePoint>& tile : found_) tile.clear();
  }

  void compute(int frame, std::size_t unit, RayCounts& counts) {
    HemispherePaths<F, Rays> hemisphere(scene_, rays_, path_, strata_, {numbers(frame), pass_.layers}, counts);
    const std::size_t first = unit * records_per_unit, end = std::min(first + records_per_unit, chosen_.size());
    for (std::size_t i = first; i < end; ++i) estimates_[i] = hemisphere.estimate(chosen_[i]);
  }

  void add() {
    for (CacheRecord& record : estimates_) {
      // A record that is not a number would spoil all around it: the paths there show it instead.
      if (!is_finite(max_component(record.irradiance))) continue;
      cache_.insert(std::move(record));
    }
    chosen_.clear(), estimates_.clear();
  }

  bool is_full() const { return cache_.size() >= std::size_t(settings_.records); }
  PointSet numbers(int frame) const { return hemisphere_points(pass_.points, frame, 0, strata_); }

  const Scene& scene_;
  const Rays& rays_;
  const IrradianceCacheSettings& settings_;
  const PathSettings path_;
  const SeriesPass pass_;
  const std::uint32_t random_;  // of the pass
  const HemisphereStrata strata_;
  const CacheRules rules_;
  IrradianceCache cache_;
  std::vector<std::vector<CachePoint>> found_, missed_;  // by the first pixel of a tile
  std::vector<CachePoint> chosen_;
  std::vector<CacheRecord> estimates_;
};

}  // namespace montelux
