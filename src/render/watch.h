// What the two kinds of render share: the film that they begin with, what an observer receives, and when to look.
#pragma once
#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "render/render.h"

namespace montelux {

// The film that a render adds to, with its tiles named; what was begun is moved out of the settings.
inline Film first_film(const RenderSettings& settings, int tile_side) {
  Film film =
      settings.begun ? std::move(settings.begun->film) : Film(settings.bounds, settings.layers, settings.stride);
  if (film.tiles().empty())
    for (const PixelBounds& tile : tiles_of(film.grid().cells(), tile_side)) film.name_tile(tile);
  return film;
}

inline std::vector<PixelBounds> tiles_of(const Film& film) {
  std::vector<PixelBounds> tiles;
  for (const auto& [index, tile] : film.tiles()) tiles.push_back(tile.cells);
  return tiles;
}

// How far a render is, as a share of its work, when it begins and now.
struct Share {
  double begun = 0, now = 0;
};

// The time that was set, where one was, may be nearer its end. `elapsed` is since the render began, `before` what the
// film had taken by then.
inline Progress progress_after(double elapsed, Share share, const std::optional<double>& seconds, bool finished,
                               double before = 0) {
  Progress p;
  p.finished = finished, p.elapsed = before + elapsed;
  p.fraction = std::min(seconds ? std::max(share.now, elapsed / *seconds) : share.now, 1.0);
  const double begun = seconds ? 0 : share.begun;
  p.remaining = p.fraction > begun ? elapsed * (1 - p.fraction) / (p.fraction - begun) : 0;
  return p;
}

// When a film is to be left.
class KeepingWatch {
 public:
  explicit KeepingWatch(const FilmKeeping& keeping) : keeping_(keeping) {}
  bool is_due(double elapsed) const { return keeping_.keep && elapsed >= next_; }
  // What `snapshot` returns, of `work` units: none where the film has not grown since.
  template <class Snapshot>
  void keep(double elapsed, std::uint64_t work, Snapshot snapshot) {
    if (!keeping_.keep) return;
    next_ = elapsed + keeping_.every;
    if (work == kept_) return;
    kept_ = work;
    keeping_.keep(snapshot());
  }

 private:
  const FilmKeeping& keeping_;
  double next_ = keeping_.every;
  std::uint64_t kept_ = 0;
};

// Estimates the error of a picture now and then, so that it takes a small part of the time, and ends before the time
// is over.
class ErrorWatch {
 public:
  // Of a picture of so many pixels, which is to end after so many seconds, if it has such a limit.
  ErrorWatch(double pixels, const std::optional<double>& end) : expected_(pixels * pixel_seconds), end_(end) {}

  // The last estimate, or a new one where it is due; `estimate` returns it.
  template <class Estimate>
  const ErrorEstimate& of(double elapsed, Estimate estimate) {
    constexpr double share = 0.02;  // of the time
    if (elapsed < next_ || (end_ && elapsed + expected_ > *end_)) return error_;
    const Stopwatch since_start;
    error_ = estimate();
    expected_ = since_start.seconds();
    next_ = elapsed + std::max(expected_ / share, 0.1);
    return error_;
  }

 private:
  static constexpr double pixel_seconds = 4e-7;  // until the first estimate shows how long it takes
  ErrorEstimate error_;
  double expected_;  // seconds of the next estimate
  std::optional<double> end_;
  double next_ = 0;  // when it is due
};

// How long to sleep before looking again. Short at first, so that a quick render is not held up; then a few times a
// second.
inline std::chrono::milliseconds poll_interval(double elapsed) {
  return std::chrono::milliseconds(elapsed < 0.5 ? 20 : 200);
}

}  // namespace montelux
