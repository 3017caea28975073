#include "render/coupled.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "render/float_mode.h"
#include "render/watch.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

constexpr int tile_side = 16;

struct ChainTile {
  PixelBounds bounds;
  std::vector<PixelPass> pixels;  // of the chain at hand
};

// The shared state of one render. A driver runs the steps of the chains, each as a stage of the scheduler with a unit
// for each tile; the thread that requested the render reports progress.
class ChainJob {
 public:
  ChainJob(const CoupledIntegrator& integrator, const RenderSettings& settings)
      : integrator_(integrator),
        settings_(settings),
        frames_(integrator.warm_up() + settings.plan.samples_per_pass),
        film_(first_film(settings, tile_side)) {
    for (const PixelBounds& tile : tiles_of(film_))
      tiles_.push_back({tile, std::vector<PixelPass>(std::size_t(tile.area()))});
    skip_passes();
    passes_begun_ = pass_;
    if (settings.begun) {
      rays_ = settings.begun->rays, seconds_before_ = settings.begun->seconds;
      has_picture_ = film_.passes(tiles_.front().bounds) > 0;
      samples_before_ = std::uint64_t(film_.samples(settings.bounds.x0, settings.bounds.y0));
    }
    over_ = is_whole_ = pass_ == settings.plan.passes;
    if (!over_) begin_chain();
  }

  // True if the observer stopped the work before it was done.
  bool watch(int threads, RenderObserver& observer) {
    std::jthread driver([this, threads] { drive(threads); });
    bool interrupted = false;
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, poll_interval(since_start_.seconds()), [this] { return ended_; })) {
      if (observer.stop_requested()) stop_ = interrupted = true;
      if (time_is_over()) stop_ = true;
      const Progress now = progress(false);
      if (keeping_.is_due(since_start_.seconds())) keep();
      lock.unlock();
      observer.progress(now);
      lock.lock();
    }
    const Progress last = progress(true);
    if (!failure_ && !is_kept_) keep();
    lock.unlock();
    driver.join();
    if (failure_) std::rethrow_exception(failure_);
    observer.progress(last);
    return interrupted && !is_whole_;
  }

  RenderResult take_result(bool interrupted) {
    // What chains of an earlier picture have left that this one has none of is not of the picture before the next.
    if (settings_.memories && settings_.memories->size() > std::size_t(pass_))
      settings_.memories->resize(std::size_t(pass_));
    const double seconds = since_start_.seconds();
    const double ending = settings_.budget ? seconds - frame_began_ : 0;
    return {std::move(film_),         rays_,     seconds_before_ + seconds, interrupted, ending,
            warm_up_seconds(seconds), forgotten_};
  }

 private:
  struct Worker {
    RayCounts rays;
    std::vector<PixelSample> samples;
  };

  // Runs the steps of all chains, one after the other; the tiles of a step are the units of a stage.
  void drive(int threads) {
    std::exception_ptr failure;
    try {
      Scheduler scheduler(threads);
      std::vector<Worker> workers(std::size_t(scheduler.threads()));
      const auto run_tile = [&](std::size_t i, int number) {
        FlushDenormals flush;
        Worker& worker = workers[std::size_t(number)];
        worker.rays += do_tile(tiles_[i], worker.samples);
      };
      while (!over_) {
        scheduler.run(tiles_.size(), run_tile);
        const std::scoped_lock lock(mutex_);
        for (Worker& worker : workers) rays_ += std::exchange(worker.rays, {});
        finish_step();
      }
    } catch (...) {
      failure = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    failure_ = failure, ended_ = true;
    changed_.notify_all();
  }

  bool is_shown(int frame) const { return frame >= integrator_.warm_up(); }

  // A tile belongs to one thread at a time, and the film's tiles to whom the tile belongs.
  RayCounts do_tile(ChainTile& tile, std::vector<PixelSample>& samples) {
    samples.assign(std::size_t(tile.bounds.area()), {});
    const RayCounts rays = chain_->run(step_, tile.bounds, samples);
    if (step_.stage + 1 < integrator_.stages() || !is_shown(step_.frame)) return rays;
    for (std::size_t i = 0; i < samples.size(); ++i) tile.pixels[i].add(samples[i]);
    return rays;
  }

  // With the mutex held, when all tiles of a step are done.
  void finish_step() {
    if (++step_.stage == integrator_.stages()) {
      step_.stage = 0;
      if (is_shown(step_.frame)) ++shown_frames_;
      ++step_.frame;
      if (step_.frame == integrator_.warm_up()) warm_up_ += since_start_.seconds() - warm_up_began_;
      const bool stops = stop_ || time_is_over() || !another_frame_fits();
      const bool ends = step_.frame == frames_ || (stops && chain_counts());
      if (ends) end_chain();
      over_ = stops || pass_ == settings_.plan.passes;
      is_whole_ = pass_ == settings_.plan.passes && step_.frame == frames_;
      if (ends && !over_) begin_chain();
    }
  }

  // Seconds of frames that are not shown, those of a chain that is being warmed up among them. All threads work on one
  // frame at a time, so it is theirs alone.
  double warm_up_seconds(double now) const { return warm_up_ + (is_shown(step_.frame) ? 0 : now - warm_up_began_); }
  // A picture has one shown frame at least.
  bool time_is_over() const {
    if (!settings_.seconds || !shows_something()) return false;
    const double now = since_start_.seconds();
    return now - (settings_.warm_up_counts ? 0 : warm_up_seconds(now)) >= *settings_.seconds;
  }

  // By the time that the last one took. A picture has one shown frame at least.
  bool another_frame_fits() {
    if (!settings_.budget) return true;
    const double now = since_start_.seconds(), took = now - std::exchange(frame_began_, now);
    return !shows_something() || now + took + settings_.budget->ending <= settings_.budget->seconds;
  }

  // Whether a chain that is broken off is a pass: much shorter ones would only add noise.
  bool chain_counts() const {
    const int shown = step_.frame - integrator_.warm_up();
    return shown > 0 && (!has_picture_ || 2 * shown >= settings_.plan.samples_per_pass);
  }
  bool shows_something() const { return has_picture_ || shown_frames_ > 0; }
  // Those that the film has.
  void skip_passes() {
    while (pass_ < settings_.plan.passes && film_.has(tiles_.front().bounds, settings_.first_pass + pass_)) ++pass_;
  }

  void begin_chain() {
    chain_ =
        integrator_.begin({settings_.bounds,
                           {settings_.sampler, settings_.seed, std::uint32_t(settings_.first_pass + pass_),
                            std::uint32_t(frames_), std::uint32_t(settings_.width), std::uint32_t(settings_.height)},
                           settings_.shutter,
                           take_memory()});
    step_ = {};
    for (ChainTile& tile : tiles_) std::fill(tile.pixels.begin(), tile.pixels.end(), PixelPass{});
    warm_up_began_ = since_start_.seconds();
  }
  // Out of the list, so that it is gone once the chain is.
  std::shared_ptr<const ChainMemory> take_memory() {
    const auto chain = std::size_t(pass_);
    if (!settings_.memories || chain >= settings_.memories->size()) return nullptr;
    return std::move((*settings_.memories)[chain]);
  }
  void leave_memory() {
    if (!settings_.memories) return;
    const auto chain = std::size_t(pass_);
    if (settings_.memories->size() <= chain) settings_.memories->resize(chain + 1);
    if (settings_.max_memory == 0) return;
    std::shared_ptr<const ChainMemory> memory = chain_->remember(step_.frame);
    const std::size_t bytes = memory ? memory->bytes() : 0;
    if (remembered_ + bytes > settings_.max_memory) {
      ++forgotten_;
      return;
    }
    remembered_ += bytes;
    (*settings_.memories)[chain] = std::move(memory);
  }
  void end_chain() {
    leave_memory();
    // An interrupted chain restarts when the film is resumed.
    if (step_.frame < frames_) keep(), is_kept_ = true;
    for (const ChainTile& tile : tiles_) film_.add_pass(tile.bounds, settings_.first_pass + pass_, tile.pixels);
    ++pass_, has_picture_ = true;
    skip_passes();
  }

  // With the mutex held.
  void keep() {
    keeping_.keep(since_start_.seconds(), std::uint64_t(film_.passes(tiles_.front().bounds)), [this] {
      FilmSnapshot snapshot;
      for (const ChainTile& tile : tiles_) film_.write_tile(tile.bounds, snapshot.tiles);
      const PixelBounds& first = tiles_.front().bounds;
      snapshot.tile_side = std::max(first.width(), first.height());
      snapshot.rays = rays_, snapshot.seconds = seconds_before_ + since_start_.seconds();
      return snapshot;
    });
  }

  // With the mutex held; the film's errors as of the last chain.
  Progress progress(bool finished) {
    const double frames = double(pass_) * frames_ + (finished ? 0 : step_.frame);
    const auto limit = settings_.budget ? std::optional(settings_.budget->seconds) : settings_.seconds;
    const double all = double(settings_.plan.passes) * frames_;
    const Share share{double(passes_begun_) * frames_ / all, frames / all};
    Progress p = progress_after(since_start_.seconds(), share, limit, finished, seconds_before_);
    p.samples = std::uint64_t(settings_.bounds.area()) * (samples_before_ + shown_frames_);
    // It takes time, of which a budget has none.
    if (!settings_.budget) p.error = error_.of(since_start_.seconds(), [&] { return film_.error(); });
    return p;
  }

  const CoupledIntegrator& integrator_;
  const RenderSettings& settings_;
  const int frames_;  // of a chain, those of the warm-up included
  const Stopwatch since_start_{settings_.clock};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // guards what follows, save what a tile's owner writes
  std::condition_variable changed_;
  Film film_;
  std::vector<ChainTile> tiles_;
  std::unique_ptr<Chain> chain_;
  ChainStep step_;
  ErrorWatch error_{double(settings_.bounds.area()), settings_.seconds};
  int pass_ = 0;  // chains that are in the film, of those that are to be
  int passes_begun_ = 0;
  bool has_picture_ = false;  // some chain is in the film
  bool is_kept_ = false;      // the film is left, without a chain that was broken off
  std::uint64_t samples_before_ = 0;
  double seconds_before_ = 0;
  KeepingWatch keeping_{settings_.keeping};
  std::uint64_t shown_frames_ = 0;
  double frame_began_ = 0;      // seconds since the start
  double warm_up_began_ = 0;    // of the chain at hand, likewise
  double warm_up_ = 0;          // seconds of all that is over
  std::size_t remembered_ = 0;  // bytes that chains have left
  int forgotten_ = 0;
  bool over_ = false;
  bool is_whole_ = false;  // all chains to their last frames
  bool ended_ = false;     // the driver
  RayCounts rays_;
  std::exception_ptr failure_;
};

}  // namespace

RenderResult render_chains(const CoupledIntegrator& integrator, const RenderSettings& settings,
                           RenderObserver& observer) {
  ChainJob job(integrator, settings);
  const bool interrupted = job.watch(settings.threads, observer);
  return job.take_result(interrupted);
}

}  // namespace montelux
