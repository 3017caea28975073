#include "render/render.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "render/coupled.h"
#include "render/float_mode.h"
#include "render/watch.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

// Side of a tile: large enough that packs stay full, small enough that a unit of work is done within a moment, so that
// threads share the work evenly and a stop is obeyed soon.
int tile_side(int samples_per_pass, int max_unit_samples) {
  int side = 32;
  while (side > 1 && side * side * samples_per_pass > max_unit_samples) side /= 2;
  return side;
}

// How long units in work may still take after a request to stop, or after the time is over, before they are dropped.
constexpr double stop_grace = 0.25, time_grace = 0.1;

// Set once, by any thread.
class StopFlag final : public StopQuery {
 public:
  bool stop_requested() const override { return set_; }
  void request_stop() { set_ = true; }

 private:
  std::atomic<bool> set_{false};
};

// A tile, whose part of the film its mutex guards.
struct TileState {
  PixelBounds bounds;
  std::mutex mutex;
  explicit TileState(const PixelBounds& b) : bounds(b) {}
};

// The shared state of one render. Work units are numbered pass by pass.
class Job {
 public:
  Job(const PixelIntegrator& integrator, const RenderSettings& settings, int side)
      : integrator_(integrator),
        settings_(settings),
        film_(first_film(settings, side)),
        units_(std::uint64_t(film_.tiles().size()) * std::uint64_t(settings.plan.passes)) {
    for (const PixelBounds& tile : tiles_of(film_)) {
      tiles_.emplace_back(tile);
      const int passes = film_.passes(tile);
      if (passes > 0) ++tiles_with_one_;
      if (passes > 1) ++tiles_with_two_;
      for (int pass : film_.pass_numbers(tile)) units_done_ += is_ours(pass);
    }
    units_before_ = units_done_.load();
    first_units_ = tiles_with_one_ == tiles_.size() ? 0 : tiles_.size();
    if (settings.begun) rays_ = settings.begun->rays, seconds_before_ = settings.begun->seconds;
  }

  // Watches over the threads; true if the observer stopped them before the work was done.
  bool watch(int threads, RenderObserver& observer) {
    std::jthread driver([this, threads] { drive(threads); });
    bool interrupted = false;
    std::unique_lock lock(mutex_);
    double requested = 0;  // when the observer wanted to stop
    while (!finished_.wait_for(lock, next_look(), [this] { return ended_; })) {
      lock.unlock();
      if (!interrupted && observer.stop_requested()) {
        stop_ = interrupted = true;
        requested = since_start_.seconds();
      }
      if (time_is_over()) stop_ = true;
      // Units in work are left unfinished then, and do not enter the film.
      if (interrupted && since_start_.seconds() > requested + stop_grace) drop_.request_stop();
      if (time_is_over() && first_pass_is_done() && since_start_.seconds() > *settings_.seconds + time_grace)
        drop_.request_stop();
      observer.progress(progress(false));
      if (keeping_.is_due(since_start_.seconds())) keep();
      lock.lock();
    }
    lock.unlock();
    driver.join();
    if (failure_) std::rethrow_exception(failure_);
    keep();
    observer.progress(progress(true));
    return interrupted && units_done_ < units_;
  }

  RenderResult take_result(bool interrupted) {
    return {std::move(film_), rays_, seconds_before_ + since_start_.seconds(), interrupted};
  }

 private:
  // A picture has one pass at least: units are taken pass by pass, and those of the first one are done.
  bool time_is_over() const {
    return settings_.seconds && units_begun_ >= first_units_ && since_start_.seconds() >= *settings_.seconds;
  }
  bool first_pass_is_done() const { return tiles_with_one_ == tiles_.size(); }
  // The error takes two passes of every pixel.
  bool has_two_passes() const { return tiles_with_two_ == tiles_.size(); }
  bool is_ours(int pass) const {
    return pass >= settings_.first_pass && pass - settings_.first_pass < settings_.plan.passes;
  }

  void keep() {
    keeping_.keep(since_start_.seconds(), units_done_, [this] {
      FilmSnapshot snapshot;
      for (TileState& tile : tiles_) {
        std::scoped_lock lock(tile.mutex);
        film_.write_tile(tile.bounds, snapshot.tiles);
      }
      snapshot.tile_side = std::max(tiles_.front().bounds.width(), tiles_.front().bounds.height());
      std::scoped_lock lock(mutex_);
      snapshot.rays = rays_, snapshot.seconds = seconds_before_ + since_start_.seconds();
      return snapshot;
    });
  }

  std::chrono::milliseconds next_look() const {
    const double elapsed = since_start_.seconds();
    const std::chrono::milliseconds interval = poll_interval(elapsed);
    if (!settings_.seconds || elapsed >= *settings_.seconds) return interval;
    const std::chrono::milliseconds left(1 + int(1000 * std::min(*settings_.seconds - elapsed, 1.0)));
    return std::min(interval, left);
  }

  // What a worker keeps from one unit of work to the next.
  struct Workspace {
    std::vector<PixelSample> samples;
    std::vector<ExactRgb> sums;
  };

  // Runs all units, as one stage of the scheduler.
  void drive(int threads) {
    std::exception_ptr failure;
    try {
      Scheduler scheduler(threads);
      std::vector<Workspace> spaces(std::size_t(scheduler.threads()));
      const auto run_unit = [&](std::size_t unit, int worker) { run(unit, spaces[std::size_t(worker)]); };
      scheduler.run(units_, run_unit, {.stop = [this] { return stop_.load(); }});
    } catch (...) {
      failure = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    failure_ = failure, ended_ = true;
    finished_.notify_all();
  }

  void run(std::uint64_t unit, Workspace& space) {
    FlushDenormals flush;
    ++units_begun_;
    try {
      do_unit(unit, space);
    } catch (...) {
      drop_.request_stop();
      throw;
    }
    if (time_is_over()) stop_ = true;
  }

  RayCounts trace(const TilePass& request, Workspace& space) {
    if (!settings_.layers) return integrator_.trace(request, space.samples);
    space.sums.assign(std::size_t(request.tile.area()) * (std::size_t(settings_.layers->count()) + 1), {});
    return integrator_.trace_layers(request, *settings_.layers, space.samples, space.sums);
  }

  void do_unit(std::uint64_t unit, Workspace& space) {
    const int pass = settings_.first_pass + int(unit / tiles_.size());
    TileState& tile = tiles_[unit % tiles_.size()];
    if (is_done(tile, pass)) return;
    const int k = settings_.plan.samples_per_pass;
    space.samples.resize(std::size_t(tile.bounds.area()) * std::size_t(k));
    TilePass request{tile.bounds,
                     {settings_.sampler, settings_.seed, std::uint32_t(pass), std::uint32_t(k),
                      std::uint32_t(settings_.width), std::uint32_t(settings_.height)},
                     settings_.shutter};
    if (settings_.stride > 1) request.grid = film_.grid();
    request.stop = &drop_;
    const RayCounts rays = trace(request, space);
    {
      std::scoped_lock lock(tile.mutex);
      if (drop_.stop_requested()) return;
      film_.add_pass(tile.bounds, pass, k, space.samples, space.sums);
      const int passes = film_.passes(tile.bounds);
      ++units_done_, tiles_with_one_ += passes == 1, tiles_with_two_ += passes == 2;
    }
    std::scoped_lock lock(mutex_);
    rays_ += rays;
  }
  // Only of a film that was begun before.
  bool is_done(TileState& tile, int pass) {
    if (!settings_.begun) return false;
    std::scoped_lock lock(tile.mutex);
    return film_.has(tile.bounds, pass);
  }

  Progress progress(bool finished) {
    const auto all = double(std::max<std::uint64_t>(units_, 1));
    const Share share{double(units_before_) / all, double(units_done_) / all};
    Progress p = progress_after(since_start_.seconds(), share, settings_.seconds, finished, seconds_before_);
    for (TileState& tile : tiles_) {
      std::scoped_lock lock(tile.mutex);
      p.samples += std::uint64_t(tile.bounds.area()) * std::uint64_t(film_.passes(tile.bounds)) *
                   std::uint64_t(settings_.plan.samples_per_pass);
    }
    // At the end the film has it.
    if (!finished && has_two_passes()) p.error = error_.of(since_start_.seconds(), [&] { return error(); });
    return p;
  }

  ErrorEstimate error() {
    if (settings_.stride > 1) return {};  // as the film has it
    FilmPlanes planes(settings_.bounds);
    for (TileState& tile : tiles_) {
      std::scoped_lock lock(tile.mutex);
      planes.copy(film_, tile.bounds);
    }
    return estimate_error(planes);
  }

  const PixelIntegrator& integrator_;
  const RenderSettings& settings_;
  const Stopwatch since_start_{settings_.clock};
  Film film_;
  std::deque<TileState> tiles_;
  const std::uint64_t units_;
  std::atomic<std::uint64_t> units_begun_{0}, units_done_{0};
  // In the film before; and with so many that are begun every tile has a pass.
  std::uint64_t units_before_ = 0, first_units_ = 0;
  std::atomic<std::uint64_t> tiles_with_one_{0}, tiles_with_two_{0};  // passes, or more
  double seconds_before_ = 0;
  std::atomic<bool> stop_{false};
  StopFlag drop_;
  ErrorWatch error_{double(settings_.bounds.area()), settings_.seconds};
  KeepingWatch keeping_{settings_.keeping};
  std::mutex mutex_;  // guards what follows
  std::condition_variable finished_;
  bool ended_ = false;  // the driver
  RayCounts rays_;
  std::exception_ptr failure_;
};

}  // namespace

PassPlan plan_passes(int samples, PointSetKind kind) {
  samples = std::max(samples, 1);
  // Independent samples lose nothing by short passes; the others want the longest sets that leave enough replicates.
  constexpr int enough_replicates = 16, bare_replicates = 8;
  // Beyond this a unit of work takes so long that a stop would have to wait for it.
  constexpr int longest_pass = 1024;
  const int replicates = samples >= 256 ? enough_replicates : bare_replicates;
  // The same points once more would tell nothing: one pass, and so no error bar.
  if (is_fixed(kind)) return {samples, 1};
  int k = 1;
  if (kind == PointSetKind::independent) {
    while (samples / (2 * k) >= 64 && k < longest_pass) k *= 2;
  } else {
    while (samples / (2 * k) >= replicates && k < longest_pass) k *= 2;
  }
  return {k, (samples + k - 1) / k};
}

// Fewer chains would have no error bar to speak of.
constexpr int min_chains = 4;

PassPlan plan_passes(const AnyIntegrator& integrator, int samples, PointSetKind kind) {
  if (!integrator.coupled()) return plan_passes(samples, kind);
  const int frames = std::min(integrator.coupled()->frames(), std::max(1, samples / min_chains));
  return {frames, (std::max(samples, 1) + frames - 1) / frames};
}

// Passes on the wish to stop, and nothing else.
class StopAlone final : public RenderObserver {
 public:
  explicit StopAlone(RenderObserver& other) : other_(other) {}
  bool stop_requested() override { return other_.stop_requested(); }

 private:
  RenderObserver& other_;
};

namespace {

// Seconds that one sample of every pixel takes: of a part of the pixels at first, and of four times as many while that
// is a small part of the time that there is.
double measure_sample(const PixelIntegrator& integrator, RenderSettings settings, double seconds,
                      RenderObserver& observer) {
  constexpr double share = 0.01;  // of the time, for one measurement
  constexpr int first_cells = 128;
  while (PixelGrid{settings.bounds, 2 * settings.stride}.cells().area() >= first_cells) settings.stride *= 2;
  for (;; settings.stride /= 2) {
    const RenderResult result = render(integrator, settings, observer);
    const double cells = PixelGrid{settings.bounds, settings.stride}.cells().area();
    if (settings.stride == 1 || result.seconds > share * seconds || observer.stop_requested())
      return result.seconds * (settings.bounds.area() / cells);
  }
}

// So that a thread looks at the clock some thirty times a second.
int unit_samples_for(const RenderSettings& settings, double sample_seconds) {
  constexpr double unit_seconds = 0.03;
  const double threads = settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  const double samples = unit_seconds / (sample_seconds * threads) * settings.bounds.area();
  return int(std::clamp(samples, 64.0, double(settings.max_unit_samples)));
}

// Of a coupled integrator, by one frame.
PassPlan plan_chains_for_time(const CoupledIntegrator& coupled, const RenderSettings& settings, double affordable) {
  constexpr int endless = 1 << 20;  // time ends it
  const int warm_up = settings.warm_up_counts ? coupled.warm_up() : 0;
  const int frames = int(affordable) * (1 + warm_up) / min_chains - warm_up;
  return {std::clamp(frames, 1, coupled.frames()), endless};
}

}  // namespace

TimedPlan plan_for_time(const AnyIntegrator& integrator, RenderSettings settings, double seconds,
                        RenderObserver& observer) {
  constexpr int endless = 1 << 20;  // time ends it
  settings.seconds.reset();
  settings.memories = nullptr, settings.begun = nullptr, settings.keeping = {};
  settings.plan = {1, 1};
  settings.first_pass = 1 << 30;  // a pass that the render itself will never take
  StopAlone silent(observer);
  const double most = is_fixed(settings.sampler) ? max_fixed_samples : 1e6;
  TimedPlan timed{{1, 1}, 1, settings.max_unit_samples, 0};
  if (const CoupledIntegrator* coupled = integrator.coupled()) {
    const RenderResult one = render(*coupled, settings, silent);
    timed.sample_seconds = std::max(settings.warm_up_counts ? one.seconds : one.shown_seconds(), 1e-6);
    timed.plan = plan_chains_for_time(*coupled, settings, std::min(seconds / timed.sample_seconds, most));
    return timed;
  }
  const Stopwatch since_start(settings.clock);
  timed.sample_seconds = std::max(measure_sample(*integrator.pixel(), settings, seconds, silent), 1e-6);
  const double affordable = std::min((seconds - since_start.seconds()) / timed.sample_seconds, most);
  timed.max_unit_samples = unit_samples_for(settings, timed.sample_seconds);
  // The measurement is good to some percent, and the first pass is always completed.
  constexpr double margin = 1.05;
  while (timed.stride < 64 && affordable * timed.stride * timed.stride < margin) ++timed.stride;
  if (timed.stride > 1) {
    timed.plan.passes = is_fixed(settings.sampler) ? 1 : endless;
    return timed;
  }
  timed.plan = plan_passes(std::max(int(affordable), 1), settings.sampler);
  if (!is_fixed(settings.sampler)) timed.plan.passes = endless;
  return timed;
}

PassPlan plan_for_budget(const AnyIntegrator& integrator) {
  constexpr int longest_chain = 1024, max_passes = 1 << 20;
  return integrator.coupled() ? PassPlan{longest_chain, 1} : PassPlan{1, max_passes};
}

RenderResult render(const AnyIntegrator& integrator, const RenderSettings& settings, RenderObserver& observer) {
  if (integrator.coupled()) return render_chains(*integrator.coupled(), settings, observer);
  if (settings.budget) return render_chains(PassesAsChains(*integrator.pixel()), settings, observer);
  int threads = settings.threads > 0 ? settings.threads : int(std::max(1u, std::thread::hardware_concurrency()));
  Job job(*integrator.pixel(), settings, tile_side(settings.plan.samples_per_pass, settings.max_unit_samples));
  bool interrupted = job.watch(threads, observer);
  return job.take_result(interrupted);
}

}  // namespace montelux
