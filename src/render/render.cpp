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

namespace montelux {

namespace {

// Side of a tile: large enough that packs stay full, small enough that a unit of work is done within a moment, so that
// threads share the work evenly and a stop is obeyed soon.
int tile_side(int samples_per_pass) {
  constexpr int most_samples = 1 << 16;
  int side = 32;
  while (side > 1 && side * side * samples_per_pass > most_samples) side /= 2;
  return side;
}

// A tile, and how many of its passes are in the film.
struct TileState {
  PixelBounds bounds;
  int passes_added = 0;
  std::mutex mutex;
  std::condition_variable added;
  explicit TileState(const PixelBounds& b) : bounds(b) {}
};

// The shared state of one render. Work units are numbered pass by pass; a unit enters the film after the same tile's
// previous pass, whichever thread did that one.
class Job {
 public:
  Job(const PixelIntegrator& integrator, const RenderSettings& settings, const std::vector<PixelBounds>& tiles)
      : integrator_(integrator),
        settings_(settings),
        film_(settings.bounds, settings.layers),
        tiles_(tiles.begin(), tiles.end()),
        units_(std::uint64_t(tiles_.size()) * std::uint64_t(settings.plan.passes)) {}

  void work() {
    FlushDenormals flush;
    RayCounts rays;
    Workspace space;
    try {
      for (std::uint64_t unit; !stop_ && (unit = next_unit_.fetch_add(1)) < units_;) {
        rays += do_unit(unit, space);
        units_done_.fetch_add(1);
      }
    } catch (...) {
      std::scoped_lock lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
      for (TileState& tile : tiles_) tile.added.notify_all();
    }
    std::scoped_lock lock(mutex_);
    rays_ += rays;
    if (--running_ == 0) finished_.notify_all();
  }

  // Watches over the threads; true if the observer stopped them before the work was done.
  bool watch(int threads, RenderObserver& observer) {
    running_ = threads;
    std::vector<std::jthread> pool;
    for (int i = 0; i < threads; ++i) pool.emplace_back([this] { work(); });
    bool interrupted = false;
    std::unique_lock lock(mutex_);
    while (!finished_.wait_for(lock, poll_interval(since_start_.seconds()), [this] { return running_ == 0; })) {
      lock.unlock();
      if (observer.stop_requested()) stop_ = interrupted = true;
      if (time_is_over()) stop_ = true;
      observer.progress(progress(false));
      lock.lock();
    }
    lock.unlock();
    pool.clear();
    if (failure_) std::rethrow_exception(failure_);
    observer.progress(progress(true));
    return interrupted && units_done_ < units_;
  }

  RenderResult take_result(bool interrupted) { return {std::move(film_), rays_, since_start_.seconds(), interrupted}; }

 private:
  // A picture has one pass at least: units are taken pass by pass, and those that are taken are done.
  bool time_is_over() const {
    return settings_.seconds && next_unit_ >= tiles_.size() && since_start_.seconds() >= *settings_.seconds;
  }

  // What a thread keeps from one unit of work to the next.
  struct Workspace {
    std::vector<PixelSample> samples;
    std::vector<ExactRgb> sums;
  };

  RayCounts trace(const TilePass& request, Workspace& space) {
    if (!settings_.layers) return integrator_.trace(request, space.samples);
    space.sums.assign(std::size_t(request.tile.area()) * (std::size_t(settings_.layers->count()) + 1), {});
    return integrator_.trace_layers(request, *settings_.layers, space.samples, space.sums);
  }

  RayCounts do_unit(std::uint64_t unit, Workspace& space) {
    const int pass = int(unit / tiles_.size());
    TileState& tile = tiles_[unit % tiles_.size()];
    const int k = settings_.plan.samples_per_pass;
    space.samples.resize(std::size_t(tile.bounds.area()) * std::size_t(k));
    TilePass request{tile.bounds,
                     {settings_.sampler, settings_.seed, std::uint32_t(settings_.first_pass + pass), std::uint32_t(k),
                      std::uint32_t(settings_.width), std::uint32_t(settings_.height)},
                     settings_.shutter};
    RayCounts rays = trace(request, space);
    std::unique_lock lock(tile.mutex);
    tile.added.wait(lock, [&] { return tile.passes_added == pass || failure_; });
    film_.add_pass(tile.bounds, pass, k, space.samples, space.sums);
    ++tile.passes_added;
    tile.added.notify_all();
    return rays;
  }

  Progress progress(bool finished) {
    Progress p =
        progress_after(since_start_.seconds(), double(units_done_) / double(units_), settings_.seconds, finished);
    for (TileState& tile : tiles_) {
      std::scoped_lock lock(tile.mutex);
      p.samples += std::uint64_t(tile.bounds.area()) * std::uint64_t(tile.passes_added) *
                   std::uint64_t(settings_.plan.samples_per_pass);
      ErrorEstimate e = film_.error(tile.bounds);
      p.error.mse += e.mse * double(e.pixels), p.error.relative_mse += e.relative_mse * double(e.pixels);
      p.error.pixels += e.pixels;
    }
    if (p.error.pixels > 0) p.error.mse /= double(p.error.pixels), p.error.relative_mse /= double(p.error.pixels);
    return p;
  }

  const PixelIntegrator& integrator_;
  const RenderSettings& settings_;
  const Stopwatch since_start_{settings_.clock};
  Film film_;
  std::deque<TileState> tiles_;
  const std::uint64_t units_;
  std::atomic<std::uint64_t> next_unit_{0}, units_done_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // guards what follows
  std::condition_variable finished_;
  int running_ = 0;
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
constexpr int least_chains = 4;

PassPlan plan_passes(const AnyIntegrator& integrator, int samples, PointSetKind kind) {
  if (!integrator.coupled()) return plan_passes(samples, kind);
  const int frames = std::min(integrator.coupled()->frames(), std::max(1, samples / least_chains));
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

PassPlan plan_for_time(const AnyIntegrator& integrator, RenderSettings settings, double seconds,
                       RenderObserver& observer) {
  constexpr int endless = 1 << 20;  // time ends it
  settings.seconds.reset();
  settings.memories = nullptr;
  settings.plan = {1, 1};
  settings.first_pass = 1 << 30;  // a pass that the render itself will never take
  StopAlone silent(observer);
  const RenderResult one = render(integrator, settings, silent);
  const double one_sample = std::max(settings.warm_up_counts ? one.seconds : one.shown_seconds(), 1e-6);
  const double most = is_fixed(settings.sampler) ? most_fixed_samples : 1e6;
  const auto affordable = int(std::min(seconds / one_sample, most));
  if (const CoupledIntegrator* coupled = integrator.coupled()) {
    const int warm_up = settings.warm_up_counts ? coupled->warm_up() : 0;
    const int frames = affordable * (1 + warm_up) / least_chains - warm_up;
    return {std::clamp(frames, 1, coupled->frames()), endless};
  }
  PassPlan plan = plan_passes(std::max(affordable, 1), settings.sampler);
  if (!is_fixed(settings.sampler)) plan.passes = endless;
  return plan;
}

PassPlan plan_for_budget(const AnyIntegrator& integrator) {
  constexpr int longest_chain = 1024, most_passes = 1 << 20;
  return integrator.coupled() ? PassPlan{longest_chain, 1} : PassPlan{1, most_passes};
}

RenderResult render(const AnyIntegrator& integrator, const RenderSettings& settings, RenderObserver& observer) {
  if (integrator.coupled()) return render_chains(*integrator.coupled(), settings, observer);
  if (settings.budget) return render_chains(PassesAsChains(*integrator.pixel()), settings, observer);
  int threads = settings.threads > 0 ? settings.threads : int(std::max(1u, std::thread::hardware_concurrency()));
  Job job(*integrator.pixel(), settings, tiles_of(settings.bounds, tile_side(settings.plan.samples_per_pass)));
  bool interrupted = job.watch(threads, observer);
  return job.take_result(interrupted);
}

}  // namespace montelux
