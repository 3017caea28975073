// What the two kinds of render share: the tiles that threads take, and what an observer receives.
#pragma once
#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "render/render.h"

namespace montelux {

// The squares that cover the bounds in row-major order; those at the right and at the bottom may be cut off.
inline std::vector<PixelBounds> tiles_of(const PixelBounds& b, int side) {
  std::vector<PixelBounds> tiles;
  for (int y = b.y0; y < b.y1; y += side)
    for (int x = b.x0; x < b.x1; x += side) tiles.push_back({x, y, std::min(x + side, b.x1), std::min(y + side, b.y1)});
  return tiles;
}

// `share` of the work is done; the time that was set, where one was, may be nearer its end.
inline Progress progress_after(double elapsed, double share, const std::optional<double>& seconds, bool finished) {
  Progress p;
  p.elapsed = elapsed, p.finished = finished;
  p.fraction = std::min(seconds ? std::max(share, elapsed / *seconds) : share, 1.0);
  p.remaining = p.fraction > 0 ? elapsed * (1 - p.fraction) / p.fraction : 0;
  return p;
}

// Estimates the error of a picture now and then, so that it takes a small part of the time.
class ErrorWatch {
 public:
  // The last estimate, or a new one where it is due; `estimate` returns it.
  template <class Estimate>
  const ErrorEstimate& of(double elapsed, Estimate estimate) {
    constexpr double share = 0.02;  // of the time
    if (elapsed < next_) return error_;
    const Stopwatch since_start;
    error_ = estimate();
    next_ = elapsed + std::max(since_start.seconds() / share, 0.1);
    return error_;
  }

 private:
  ErrorEstimate error_;
  double next_ = 0;  // when it is due
};

// How long to sleep before looking again. Short at first, so that a quick render is not held up; then a few times a
// second.
inline std::chrono::milliseconds poll_interval(double elapsed) {
  return std::chrono::milliseconds(elapsed < 0.5 ? 20 : 200);
}

}  // namespace montelux
