// Drives a render, stage by stage, and watches over its threads: stops, progress, snapshots and estimates of the error,
// for both kinds of integrator.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "render/render.h"

namespace montelux {

// How much of a render's plan is done, as shares of it, and the samples of the film.
struct WorkDone {
  double begun = 0, now = 0;  // when the render began (the film may have passes then), and now
  std::uint64_t samples = 0;
};

// The error of a film, and what is known of it against the target, if there is one.
struct FilmError {
  ErrorEstimate error;
  TargetState target;
};

// A render as stages of numbered units, one stage after the other.
class StagedWork {
 public:
  virtual ~StagedWork() = default;

  // By the driving thread.
  virtual void begin(int workers) = 0;                  // once; workers are numbered from 0
  virtual std::optional<std::size_t> next_stage() = 0;  // its number of units; none: the render is over
  virtual void end_stage() = 0;                         // after its units
  virtual bool stops_within_stage() const = 0;          // whether units may be left out when the render stops

  // By several threads at once, with different workers.
  virtual void run_unit(std::size_t unit, int worker) = 0;

  // By the watching thread, while others work.
  virtual RenderState state() = 0;
  virtual WorkDone done() = 0;
  virtual std::uint64_t passes() = 0;            // of all tiles of the film
  virtual std::optional<FilmError> error() = 0;  // it needs two passes of every pixel
  virtual FilmSnapshot snapshot() = 0;           // the watch sets its seconds
  virtual void drop_unfinished_units() {}        // units in work should end at once, and do not enter the film
};

// Estimates the error of a film now and then, so that this takes a small part of the time.
class ErrorWatch {
 public:
  explicit ErrorWatch(double pixels) : expected_(pixels * pixel_seconds) {}

  // The last estimate, or a new one if it is due and takes at most `available` seconds. `estimate` returns it; nothing:
  // it is not possible yet.
  template <class Estimate>
  const FilmError& of(double elapsed, double available, Estimate estimate) {
    constexpr double share = 0.02;  // of the time
    if (elapsed < next_ || expected_ > available) return error_;
    const Stopwatch since_start;
    const std::optional<FilmError> error = estimate();
    if (!error) return error_;
    error_ = *error, expected_ = since_start.seconds();
    next_ = elapsed + std::max(expected_ / share, 0.1);
    return error_;
  }

 private:
  static constexpr double pixel_seconds = 4e-7;  // until the first estimate shows how long it takes
  FilmError error_;
  double expected_;  // seconds of the next estimate
  double next_ = 0;  // when it is due
};

class RenderWatch {
 public:
  // The settings must outlive it.
  explicit RenderWatch(const RenderSettings& settings);

  double seconds() const { return since_start_.seconds(); }
  double seconds_before() const { return seconds_before_; }  // of the film that is continued
  // Whether no more work should begin.
  bool stops() const { return stops_; }
  // The same after a query of the stopping rule. By any thread.
  bool query(const RenderState& state);

  // Runs the stages in a thread of its own and those of the scheduler, watches over the work until it ends, and saves
  // the film. True if the observer requested a stop. Throws what a unit throws.
  bool run(StagedWork& work, RenderObserver& observer);
  // The last progress.
  void report_end(StagedWork& work, RenderObserver& observer);

 private:
  void drive(StagedWork& work);
  bool wait_for_end(std::chrono::milliseconds limit);  // of the stages; false: the time is over
  void look(StagedWork& work, RenderObserver& observer);
  void drop_late_units(StagedWork& work);
  void update_error(StagedWork& work);
  Progress progress(StagedWork& work, bool finished);
  void keep(StagedWork& work);
  // How long to sleep before the next look.
  std::chrono::milliseconds interval(StagedWork& work) const;

  const RenderSettings& settings_;
  const Stopwatch since_start_;
  const double seconds_before_;
  std::atomic<bool> stops_{false};
  std::atomic<double> rule_at_{-1};  // when the rule stopped the render; negative: it did not
  bool interrupted_ = false;
  double requested_at_ = 0;  // when the observer requested a stop
  ErrorWatch error_watch_{double(settings_.image.bounds.area())};
  FilmKeeper keeper_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  FilmError error_;     // the last one
  bool ended_ = false;  // all stages, or one by an exception
  std::exception_ptr failure_;
};

// The error that the planes show, and what is known of the target. `image` returns the estimate of the image's mean.
FilmError error_of(const FilmPlanes& planes, const RenderSettings& settings,
                   const std::function<ImageEstimate()>& image);

// The film that a render adds to, with its tiles named; a film that is continued is moved out of the settings.
Film first_film(const RenderSettings& settings, int tile_side);
std::vector<PixelBounds> tiles_of(const Film& film);

}  // namespace montelux
