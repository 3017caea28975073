#include "render/series.h"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "render/paired_bias.h"
#include "render/watch.h"

namespace montelux {

namespace {

constexpr int tile_side = 16;

struct SeriesTile {
  PixelBounds bounds;
  std::vector<PixelPass> pixels;  // of the current series
  std::vector<ExactRgb> sums;     // the same of its layers, if there are any
};

// The steps of all series, one series after the other, as stages. A unit is a tile, or what the step divides its work
// into.
class SeriesWork final : public StagedWork {
 public:
  SeriesWork(const CoupledIntegrator& integrator, const RenderSettings& settings)
      : integrator_(integrator),
        settings_(settings),
        frames_(integrator.warm_up() + settings.plan.samples_per_pass),
        film_(first_film(settings, tile_side)) {
    for (const PixelBounds& tile : tiles_of(film_))
      tiles_.push_back({tile, std::vector<PixelPass>(std::size_t(tile.area())), std::vector<ExactRgb>(sums_of(tile))});
    skip_passes();
    passes_begun_ = pass_;
    if (settings.begun) {
      rays_ = settings.begun->rays, bias_ = settings.begun->bias, mixing_ = settings.begun->mixing;
      has_image_ = film_.passes(tiles_.front().bounds) > 0;
      samples_before_ = std::uint64_t(film_.samples(settings.image.bounds.x0, settings.image.bounds.y0));
    }
    if (settings.unbiased) paired_.emplace(*settings.unbiased, tiles_.size(), settings.plan.samples_per_pass);
    over_ = is_whole_ = is_planned();
    if (!over_) begin_series();
  }

  RenderResult run(RenderObserver& observer) {
    const bool requested = watch_.run(*this, observer);
    // An incomplete series is in the image, but not in the saved film: it restarts when the film is continued.
    if (incomplete_) add_to_film(*incomplete_);
    if (bias_of_incomplete_) bias_[*incomplete_] = *bias_of_incomplete_;
    if (mixing_of_incomplete_) mixing_[*incomplete_] = *mixing_of_incomplete_;
    if (paired_) bias_ = paired_->bias();
    watch_.report_end(*this, observer);
    memories_.keep_first(std::size_t(pass_));
    const double seconds = watch_.seconds();
    return {std::move(film_),
            rays_,
            watch_.seconds_before() + seconds,
            requested && !is_whole_,
            seconds - frame_began_,
            warm_up_seconds(seconds),
            memories_.forgotten(),
            frames_run_,
            std::move(bias_),
            std::move(mixing_)};
  }

  void begin(int workers) override { workers_.resize(std::size_t(workers)); }

  std::optional<std::size_t> next_stage() override {
    if (over_) return std::nullopt;
    units_ = series_->units(step_);
    return units_.value_or(tiles_.size());
  }

  void end_stage() override {
    const std::scoped_lock lock(mutex_);
    for (Worker& worker : workers_) rays_ += std::exchange(worker.rays, {});
    if (++step_.stage == integrator_.stages()) finish_frame();
  }

  // Pixels of a frame share information: a frame is completed.
  bool stops_within_stage() const override { return false; }

  void run_unit(std::size_t unit, int number) override {
    Worker& worker = workers_[std::size_t(number)];
    worker.rays += units_ ? series_->run_unit(step_, unit) : do_tile(unit, worker);
  }

  RenderState state() override {
    const std::scoped_lock lock(mutex_);
    return state_now();
  }

  WorkDone done() override {
    const std::scoped_lock lock(mutex_);
    const double frames = double(pass_) * frames_ + (over_ ? 0 : step_.frame);
    const double all = double(settings_.plan.passes) * frames_;
    return {double(passes_begun_) * frames_ / all, frames / all,
            std::uint64_t(film_.grid().cells().area()) * (samples_before_ + shown_frames_)};
  }

  std::uint64_t passes() override {
    const std::scoped_lock lock(mutex_);
    return std::uint64_t(film_.passes(tiles_.front().bounds));
  }

  std::optional<FilmError> error() override {
    const std::scoped_lock lock(mutex_);
    if (film_.passes(tiles_.front().bounds) < 2 || film_.grid().stride > 1) return std::nullopt;
    FilmPlanes planes(settings_.image.bounds);
    planes.copy(film_, settings_.image.bounds);
    return error_of(planes, settings_, [this] { return film_.image(); });
  }

  FilmSnapshot snapshot() override {
    const std::scoped_lock lock(mutex_);
    FilmSnapshot snapshot;
    for (const SeriesTile& tile : tiles_) film_.write_tile(tile.bounds, snapshot.tiles);
    const PixelBounds& first = tiles_.front().bounds;
    snapshot.tile_side = std::max(first.width(), first.height());
    snapshot.rays = rays_, snapshot.bias = bias_, snapshot.mixing = mixing_;
    return snapshot;
  }

 private:
  struct Worker {
    RayCounts rays;
    std::vector<PixelSample> samples, unbiased;
    std::vector<ExactRgb> sums;
  };

  bool is_shown(int frame) const { return frame >= integrator_.warm_up(); }
  int pass_number() const { return settings_.plan.first_pass + pass_; }

  // A tile belongs to one thread at a time.
  RayCounts do_tile(std::size_t number, Worker& worker) {
    SeriesTile& tile = tiles_[number];
    std::vector<PixelSample>& samples = worker.samples;
    samples.assign(std::size_t(tile.bounds.area()), {});
    worker.sums.assign(tile.sums.size(), {});
    RayCounts rays = settings_.image.layers ? series_->run_layers(step_, tile.bounds, samples, worker.sums)
                                            : series_->run(step_, tile.bounds, samples);
    if (step_.stage + 1 < integrator_.stages() || !is_shown(step_.frame)) return rays;
    for (std::size_t i = 0; i < samples.size(); ++i) tile.pixels[i].add(samples[i]);
    for (std::size_t i = 0; i < worker.sums.size(); ++i) tile.sums[i] += worker.sums[i];
    if (paired_ && paired_->compares(number, pass_number(), step_.frame - integrator_.warm_up()))
      rays += compare(number, worker);
    return rays;
  }
  // The tile's samples in this frame with unbiased ones.
  RayCounts compare(std::size_t number, Worker& worker) {
    TilePass request{tiles_[number].bounds, settings_.image.points(pass_number(), frames_), settings_.image.shutter};
    request.only = std::uint32_t(step_.frame);
    if (film_.grid().stride > 1) request.grid = film_.grid();
    worker.unbiased.assign(worker.samples.size(), {});
    const RayCounts rays = paired_->unbiased().trace(request, worker.unbiased);
    paired_->add(number, pass_number(), worker.samples, worker.unbiased);
    return rays;
  }
  // The number of sums of a tile's layers.
  std::size_t sums_of(const PixelBounds& tile) const {
    const std::optional<LayerPlan>& layers = settings_.image.layers;
    return layers ? std::size_t(tile.area()) * (std::size_t(layers->count()) + 1) : 0;
  }

  // What follows is called with the mutex held.

  void finish_frame() {
    step_.stage = 0;
    if (is_shown(step_.frame)) ++shown_frames_;
    ++step_.frame, ++frames_run_;
    const double now = watch_.seconds();
    if (step_.frame == integrator_.warm_up()) warm_up_ += now - warm_up_began_;
    RenderState state = state_now();
    state.next_frame = state.seconds - std::exchange(frame_began_, state.seconds);
    const bool stops = watch_.query(state);
    const bool ends = step_.frame == frames_ || (stops && series_counts());
    if (ends) end_series();
    is_whole_ = step_.frame == frames_ && is_planned();
    over_ = stops || is_whole_ || pass_ == settings_.plan.passes;
    if (ends && !over_) begin_series();
  }

  RenderState state_now() const {
    RenderState now;
    now.seconds = watch_.seconds(), now.warm_up = warm_up_seconds(now.seconds);
    now.is_covered = now.is_complete = has_image_ || shown_frames_ > 0;
    return now;
  }

  // Seconds of frames that are not shown, including the warm-up of the current series. All threads work on one frame at
  // a time.
  double warm_up_seconds(double now) const { return warm_up_ + (is_shown(step_.frame) ? 0 : now - warm_up_began_); }

  // Whether an incomplete series is a pass: much shorter ones would only add noise.
  bool series_counts() const {
    const int shown = step_.frame - integrator_.warm_up();
    return shown > 0 && (!has_image_ || 2 * shown >= settings_.plan.samples_per_pass);
  }

  // Whether the film has what the plan of work requires.
  bool is_planned() const {
    if (pass_ == settings_.plan.passes) return true;
    return settings_.work &&
           settings_.work->next_round(film_, settings_.plan, [this] { return watch_.stops(); }).count == 0;
  }

  // Skips the passes that the film has.
  void skip_passes() {
    while (pass_ < settings_.plan.passes && film_.has(tiles_.front().bounds, pass_number())) ++pass_;
  }

  void begin_series() {
    SeriesPass pass{film_.grid().cells(), settings_.image.points(pass_number(), frames_), settings_.image.shutter,
                    memories_.take(std::size_t(pass_))};
    if (film_.grid().stride > 1) pass.grid = film_.grid();
    if (settings_.image.layers) pass.layers = &*settings_.image.layers;
    series_ = integrator_.begin(pass);
    step_ = {};
    for (SeriesTile& tile : tiles_) {
      std::ranges::fill(tile.pixels, PixelPass{});
      std::ranges::fill(tile.sums, ExactRgb{});
    }
    warm_up_began_ = watch_.seconds();
  }

  void end_series() {
    const std::optional<MeanDifference> bias = series_->measured_bias();
    const std::optional<MixingFigures> mixing = series_->mixing();
    memories_.store(std::size_t(pass_), *series_, step_.frame);
    if (step_.frame == frames_) {
      add_to_film(pass_number());
      if (bias) bias_[pass_number()] = *bias;
      if (mixing) mixing_[pass_number()] = *mixing;
    } else {
      incomplete_ = pass_number(), bias_of_incomplete_ = bias, mixing_of_incomplete_ = mixing;
    }
    ++pass_, has_image_ = true;
    skip_passes();
  }

  void add_to_film(int pass) {
    for (const SeriesTile& tile : tiles_) film_.add_pass(tile.bounds, pass, tile.pixels, tile.sums);
  }

  const CoupledIntegrator& integrator_;
  const RenderSettings& settings_;
  const int frames_;  // of a series, including the warm-up
  RenderWatch watch_{settings_};
  std::mutex mutex_;  // guards what follows, except for what a unit of work writes
  Film film_;
  std::vector<SeriesTile> tiles_;
  MemoryExchange memories_{settings_.sequence};
  std::unique_ptr<FrameSeries> series_;
  SeriesStep step_;
  std::optional<std::size_t> units_;  // of the step; none: the tiles
  std::vector<Worker> workers_;
  int pass_ = 0;  // series of the plan that are done
  int passes_begun_ = 0;
  std::optional<int> incomplete_;  // the pass of the last series, if it ended early
  std::optional<MeanDifference> bias_of_incomplete_;
  std::optional<MixingFigures> mixing_of_incomplete_;
  std::optional<PairedBias> paired_;
  BiasOfPasses bias_;       // of the passes that are done
  MixingOfPasses mixing_;   // likewise
  bool has_image_ = false;  // a series is done
  std::uint64_t samples_before_ = 0;
  std::uint64_t shown_frames_ = 0;
  int frames_run_ = 0;        // including those that are not shown
  double frame_began_ = 0;    // seconds since the start
  double warm_up_began_ = 0;  // of the current series, likewise
  double warm_up_ = 0;        // seconds of all that have ended
  bool over_ = false;
  bool is_whole_ = false;  // all series have all frames
  RayCounts rays_;
};

}  // namespace

RenderResult render_series(const CoupledIntegrator& integrator, const RenderSettings& settings,
                           RenderObserver& observer) {
  return SeriesWork(integrator, settings).run(observer);
}

}  // namespace montelux
