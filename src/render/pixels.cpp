#include "render/pixels.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "render/paired_bias.h"
#include "render/shared_samples.h"
#include "render/watch.h"

namespace montelux {

namespace {

// Set once, by any thread.
class StopFlag final : public StopQuery {
 public:
  bool stop_requested() const override { return set_; }
  void request_stop() { set_ = true; }

 private:
  std::atomic<bool> set_{false};
};

struct TileState {
  PixelBounds bounds;
  std::mutex mutex;                // guards the tile's part of the film, and its rays
  std::atomic<bool> begun{false};  // it has a pass, or one in work
  std::uint64_t rays_before = 0;   // of the film that is continued
  RayCounts traced{};              // by this render
  std::uint64_t rays() const { return rays_before + traced.all(); }
  explicit TileState(const PixelBounds& b) : bounds(b) {}
};

// The rounds of a plan of work as stages. A unit is one pass of one tile.
class PixelWork final : public StagedWork {
 public:
  PixelWork(const PixelIntegrator& integrator, const RenderSettings& settings)
      : integrator_(integrator),
        settings_(settings),
        film_(first_film(settings, settings.plan.tile_side())),
        units_(plan().expected_units(film_, settings.plan)),
        units_before_(units_of(film_, settings.plan)),
        units_done_(units_before_) {
    for (const PixelBounds& bounds : tiles_of(film_)) {
      TileState& tile = tiles_.emplace_back(bounds);
      const int passes = film_.passes(bounds);
      samples_done_ += samples_of(bounds) * std::uint64_t(passes);
      if (passes > 0) tile.begun = true, ++tiles_begun_, ++tiles_with_one_;
      if (passes > 1) ++tiles_with_two_;
    }
    if (settings.begun) {
      rays_before_ = settings.begun->rays;
      if (const auto& rays = settings.begun->rays_of_tiles; rays.size() == tiles_.size())
        for (std::size_t i = 0; i < rays.size(); ++i) tiles_[i].rays_before = rays[i];
    }
    if (settings.unbiased) paired_.emplace(*settings.unbiased, tiles_.size(), settings.plan.samples_per_pass);
  }

  RenderResult run(RenderObserver& observer) {
    const bool requested = watch_.run(*this, observer);
    watch_.report_end(*this, observer);
    const bool is_cut = requested && plan().next_round(film_, settings_.plan, {}).count > 0;
    RenderResult result{std::move(film_), rays_before_, watch_.seconds_before() + watch_.seconds(), is_cut};
    if (paired_) result.bias = paired_->bias();
    for (const TileState& tile : tiles_) result.rays += tile.traced, result.rays_of_tiles.push_back(tile.rays());
    return result;
  }

  void begin(int workers) override { spaces_.resize(std::size_t(workers)); }

  std::optional<std::size_t> next_stage() override {
    if (watch_.stops()) return std::nullopt;
    round_ = plan().next_round(film_, settings_.plan, [this] { return watch_.stops(); }),
    units_before_round_ = units_done_;
    if (round_.count == 0) return std::nullopt;
    return round_.count;
  }

  void end_stage() override {
    if (units_done_ == units_before_round_ && !watch_.stops())
      throw std::logic_error("the plan has a round without new passes");
  }

  bool stops_within_stage() const override { return true; }

  void run_unit(std::size_t number, int worker) override {
    const WorkUnit unit = round_.unit(number);
    TileState& tile = tiles_.at(unit.tile);
    if (!tile.begun.exchange(true)) ++tiles_begun_;
    try {
      do_unit(unit.tile, unit.pass, spaces_[std::size_t(worker)]);
    } catch (...) {
      drop_.request_stop();
      throw;
    }
    watch_.query(state());
  }

  RenderState state() override {
    RenderState now;
    now.seconds = watch_.seconds();
    // A tile that is begun is completed: the first pass of a tile is never dropped because of the rule.
    now.is_covered = tiles_begun_ == tiles_.size(), now.is_complete = tiles_with_one_ == tiles_.size();
    return now;
  }

  WorkDone done() override {
    const auto all = double(std::max<std::uint64_t>(units_, 1));
    return {double(units_before_) / all, double(units_done_) / all, samples_done_};
  }

  std::uint64_t passes() override { return units_done_; }

  std::optional<FilmError> error() override {
    const bool has_two_passes = tiles_with_two_ == tiles_.size();
    if (!has_two_passes || settings_.plan.stride > 1) return std::nullopt;
    FilmPlanes planes(settings_.image.bounds);
    FilmTiles tiles;
    auto of_film = film_.tiles().begin();  // in the order of tiles_
    for (TileState& tile : tiles_) {
      const std::scoped_lock lock(tile.mutex);
      planes.copy(film_, tile.bounds);
      if (settings_.target) tiles.insert(tiles.end(), *of_film++);
    }
    return error_of(planes, settings_, [&] { return image_of(tiles, film_.grid().cells().area()); });
  }

  FilmSnapshot snapshot() override {
    FilmSnapshot snapshot;
    snapshot.rays = rays_before_;
    // Each tile with the rays of the passes that it has, while other threads add more.
    for (TileState& tile : tiles_) {
      const std::scoped_lock lock(tile.mutex);
      film_.write_tile(tile.bounds, snapshot.tiles);
      snapshot.rays += tile.traced, snapshot.rays_of_tiles.push_back(tile.rays());
    }
    snapshot.tile_side = std::max(tiles_.front().bounds.width(), tiles_.front().bounds.height());
    return snapshot;
  }

  void drop_unfinished_units() override { drop_.request_stop(); }

 private:
  // The memory of one worker, reused for all its units.
  struct Workspace {
    std::vector<PixelSample> samples, compared, unbiased;
    std::vector<ExactRgb> sums;
    std::vector<PixelPass> pixels;  // where these share samples
  };

  const WorkPlan& plan() const { return settings_.work ? *settings_.work : pass_by_pass_; }

  // Of a tile in one pass.
  std::uint64_t samples_of(const PixelBounds& tile) const {
    return std::uint64_t(tile.area()) * std::uint64_t(settings_.plan.samples_per_pass);
  }

  void do_unit(std::size_t number, int pass, Workspace& space) {
    TileState& tile = tiles_.at(number);
    if (has(tile, pass)) return;
    const int k = settings_.plan.samples_per_pass;
    TilePass request{tile.bounds, settings_.image.points(pass, k), settings_.image.shutter};
    if (settings_.plan.stride > 1) request.grid = film_.grid();
    request.stop = &drop_;
    std::optional<SharedSamples> shared;
    if (settings_.plan.stride == 1 && filters_share_samples(settings_.image)) {
      shared.emplace(*settings_.image.sharing, tile.bounds, request.points);
      request.tile = shared->around(), request.offsets = shared->offsets();
    }
    space.samples.resize(std::size_t(request.tile.area()) * std::size_t(k));
    RayCounts rays = trace(request, space);
    if (shared && !drop_.stop_requested()) shared->sum(space.samples, space.pixels);
    if (paired_) rays += compare(number, pass, request, space);
    {
      const std::scoped_lock lock(tile.mutex);
      if (drop_.stop_requested()) return;
      if (shared)
        film_.add_pass(tile.bounds, pass, space.pixels);
      else
        film_.add_pass(tile.bounds, pass, k, space.samples, space.sums);
      tile.traced += rays;
      const int passes = film_.passes(tile.bounds);
      samples_done_ += samples_of(tile.bounds);
      ++units_done_, tiles_with_one_ += passes == 1, tiles_with_two_ += passes == 2;
    }
  }

  // Some of the tile's samples in this pass with unbiased ones.
  RayCounts compare(std::size_t number, int pass, const TilePass& request, Workspace& space) {
    const int k = settings_.plan.samples_per_pass;
    RayCounts rays;
    for (int sample = 0; sample < k; ++sample) {
      if (!paired_->compares(number, pass, sample)) continue;
      space.compared.clear();
      const PixelBounds &traced = request.tile, &tile = tiles_[number].bounds;
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
          const int pixel = (y - traced.y0) * traced.width() + x - traced.x0;
          space.compared.push_back(space.samples[std::size_t(pixel) * std::size_t(k) + std::size_t(sample)]);
        }
      space.unbiased.assign(space.compared.size(), {});
      TilePass one = request;
      one.tile = tile, one.only = std::uint32_t(sample);
      rays += paired_->unbiased().trace(one, space.unbiased);
      if (!drop_.stop_requested()) paired_->add(number, pass, space.compared, space.unbiased);
    }
    return rays;
  }

  bool has(TileState& tile, int pass) {
    const std::scoped_lock lock(tile.mutex);
    return film_.has(tile.bounds, pass);
  }

  RayCounts trace(const TilePass& request, Workspace& space) {
    const auto& layers = settings_.image.layers;
    if (!layers) return integrator_.trace(request, space.samples);
    space.sums.assign(std::size_t(request.tile.area()) * (std::size_t(layers->count()) + 1), {});
    return integrator_.trace_layers(request, *layers, space.samples, space.sums);
  }

  const PixelIntegrator& integrator_;
  const RenderSettings& settings_;
  const PassByPass pass_by_pass_{};
  RenderWatch watch_{settings_};
  Film film_;
  std::deque<TileState> tiles_;
  const std::uint64_t units_, units_before_;  // of the plan: all, and those that the film had before
  std::atomic<std::uint64_t> units_done_;
  std::atomic<std::uint64_t> samples_done_{0};
  std::atomic<std::size_t> tiles_begun_{0}, tiles_with_one_{0}, tiles_with_two_{0};  // with so many passes, or more
  WorkRound round_;
  std::uint64_t units_before_round_ = 0;
  std::vector<Workspace> spaces_;  // of the workers
  StopFlag drop_;
  RayCounts rays_before_;  // of the film that is continued
  std::optional<PairedBias> paired_;
};

}  // namespace

RenderResult render_pixels(const PixelIntegrator& integrator, const RenderSettings& settings,
                           RenderObserver& observer) {
  return PixelWork(integrator, settings).run(observer);
}

}  // namespace montelux
