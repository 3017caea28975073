// The progress of a comparison: its pieces of work relative to their expected durations. Internal to the facade.
#pragma once
#include "api/comparison.h"
#include "render/stopwatch.h"

namespace montelux {

class ComparisonMeter {
 public:
  explicit ComparisonMeter(const ComparisonObserver& observer);
  ComparisonMeter(const ComparisonMeter&) = delete;
  ComparisonMeter& operator=(const ComparisonMeter&) = delete;

  // The callbacks of the work; valid as long as the meter.
  const lab::ComparisonWatch& watch() const { return watch_; }
  // Sets the expected duration of the remaining work in seconds; replaces the previous value.
  void expect(double seconds);
  double elapsed() const { return since_start_.seconds(); }

 private:
  void state(const lab::WorkPiece& piece, double done);
  // The remaining seconds: the expected ones, scaled by the ratio of actual to expected time so far.
  double remaining() const;

  const ComparisonObserver& observer_;
  lab::ComparisonWatch watch_;
  const Stopwatch since_start_;
  double expected_ = 0, done_ = 0, piece_ = 0;  // expected seconds since expect()
  double expected_at_ = 0;                      // time of expect()
  bool under_way_ = false;                      // a piece has begun
};

}  // namespace montelux
