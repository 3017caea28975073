#include "render/watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "render/float_mode.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

// How long units in work may take after a request to stop, or after the rule has stopped the render, before they are
// dropped.
constexpr double stop_grace = 0.25, rule_grace = 0.1;

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

RenderWatch::RenderWatch(const RenderSettings& settings)
    : settings_(settings),
      since_start_(settings.clock),
      seconds_before_(settings.begun ? settings.begun->seconds : 0),
      keeper_(settings.keeping) {}

bool RenderWatch::query(const RenderState& state) {
  if (stops_ || !settings_.stop) return stops_;
  RenderState with_error = state;
  const std::scoped_lock lock(mutex_);
  with_error.error = error_.error;
  if (!stops_ && settings_.stop->stops(with_error)) {
    rule_at_ = state.seconds;
    stops_ = true;
  }
  return stops_;
}

bool RenderWatch::run(StagedWork& work, RenderObserver& observer) {
  std::jthread driver([&] {
    std::exception_ptr failure;
    try {
      drive(work);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    failure_ = failure, ended_ = true;
    changed_.notify_all();
  });
  while (!wait_for_end(interval(work))) look(work, observer);
  driver.join();
  if (failure_) std::rethrow_exception(failure_);
  keep(work);
  return interrupted_;
}

void RenderWatch::drive(StagedWork& work) {
  Scheduler scheduler(settings_.threads);
  work.begin(scheduler.threads());
  const auto run_unit = [&work](std::size_t unit, int worker) {
    FlushDenormals flush;
    work.run_unit(unit, worker);
  };
  StageLimits limits;
  if (work.stops_within_stage()) limits.stop = [this] { return stops(); };
  while (const std::optional<std::size_t> units = work.next_stage()) {
    scheduler.run(*units, run_unit, limits);
    work.end_stage();
  }
}

void RenderWatch::report_end(StagedWork& work, RenderObserver& observer) { observer.progress(progress(work, true)); }

bool RenderWatch::wait_for_end(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, limit, [this] { return ended_; });
}

void RenderWatch::look(StagedWork& work, RenderObserver& observer) {
  if (!interrupted_ && observer.stop_requested()) {
    stops_ = interrupted_ = true;
    requested_at_ = seconds();
  }
  update_error(work);
  query(work.state());
  drop_late_units(work);
  observer.progress(progress(work, false));
  if (keeper_.is_due(seconds())) keep(work);
}

void RenderWatch::drop_late_units(StagedWork& work) {
  if (!stops_) return;
  if (interrupted_ && seconds() > requested_at_ + stop_grace) return work.drop_unfinished_units();
  const double rule_at = rule_at_;
  if (rule_at >= 0 && work.state().is_complete && seconds() > rule_at + rule_grace) work.drop_unfinished_units();
}

void RenderWatch::update_error(StagedWork& work) {
  const double available = settings_.stop ? settings_.stop->time_for_estimate(work.state()) : infinite;
  const FilmError error = error_watch_.of(seconds(), available, [&] { return work.error(); });
  const std::scoped_lock lock(mutex_);
  error_ = error;
}

Progress RenderWatch::progress(StagedWork& work, bool finished) {
  const WorkDone done = work.done();
  RenderState state = work.state();
  Progress p;
  TargetState target;
  {
    const std::scoped_lock lock(mutex_);
    state.error = error_.error, target = error_.target;
  }
  // At the end the film has a better estimate.
  if (!finished) p.error = state.error;
  p.finished = finished, p.elapsed = seconds_before_ + state.seconds, p.samples = done.samples;
  const double by_plan = done.now > done.begun ? state.seconds * (1 - done.now) / (done.now - done.begun) : infinite;
  const double by_rule = settings_.stop ? settings_.stop->seconds_left(state) : infinite;
  // The share of the time that the rule leaves.
  const double by_time = state.seconds + by_rule > 0 ? state.seconds / (state.seconds + by_rule) : 1;
  p.fraction = std::min(std::max(done.now, by_time), 1.0);
  double left = std::min(by_plan, by_rule);
  if (settings_.target && std::isfinite(target.work)) {
    const auto seconds_of = [&](double times) { return std::max(times - 1, 0.0) * p.elapsed; };
    p.to_target = {seconds_of(target.work), seconds_of(target.work_low), seconds_of(target.work_high)};
    left = std::min(left, p.to_target->seconds);
    if (!finished) p.fraction = std::clamp(p.elapsed / (p.elapsed + left), p.fraction, 1.0);
  } else if (settings_.target && !finished) {
    // The plan's end is the most that it may take: it says nothing of the time to the error.
    left = by_rule, p.fraction = std::isfinite(by_rule) ? by_time : 0;
  }
  p.remaining = std::isfinite(left) ? std::max(left, 0.0) : 0;
  return p;
}

void RenderWatch::keep(StagedWork& work) {
  keeper_.keep(seconds(), work.passes(), [&] {
    FilmSnapshot snapshot = work.snapshot();
    snapshot.seconds = seconds_before_ + seconds();
    return snapshot;
  });
}

std::chrono::milliseconds RenderWatch::interval(StagedWork& work) const {
  // Short at first and at the end, so that a quick render is not delayed; otherwise several times a second.
  const std::chrono::milliseconds interval(seconds() < 0.5 || stops_ ? 20 : 200);
  if (!settings_.stop) return interval;
  const double left = settings_.stop->seconds_left(work.state());
  if (!(left > 0) || left >= 1) return interval;
  return std::min(interval, std::chrono::milliseconds(1 + int(1000 * left)));
}

FilmError error_of(const FilmPlanes& planes, const RenderSettings& settings,
                   const std::function<ImageEstimate()>& image) {
  FilmError error{estimate_error(planes), {}};
  if (settings.target) error.target = settings.target->judge(planes, error.error, image());
  return error;
}

Film first_film(const RenderSettings& settings, int tile_side) {
  Film film = settings.begun
                  ? std::move(settings.begun->film)
                  : Film(settings.image.bounds, settings.image.layers, settings.plan.stride, settings.image.halves);
  film.set_max_chance_radiance(settings.image.max_chance_radiance);
  if (film.tiles().empty())
    for (const PixelBounds& tile : tiles_of(film.grid().cells(), tile_side)) film.name_tile(tile);
  return film;
}

std::vector<PixelBounds> tiles_of(const Film& film) {
  std::vector<PixelBounds> tiles;
  for (const auto& [index, tile] : film.tiles()) tiles.push_back(tile.cells);
  return tiles;
}

}  // namespace montelux
