// How far a comparison has come: its pieces of work against what they were expected to take. Inside the facade only.
#pragma once
#include "api/comparison.h"
#include "render/stopwatch.h"

namespace montelux {

class ComparisonMeter {
 public:
  explicit ComparisonMeter(const ComparisonObserver& observer);
  ComparisonMeter(const ComparisonMeter&) = delete;
  ComparisonMeter& operator=(const ComparisonMeter&) = delete;

  // What the work calls; valid as long as the meter.
  const lab::ComparisonWatch& watch() const { return watch_; }
  // From here on the work is expected to take so many seconds in all; takes the place of what was expected before.
  void expect(double seconds);
  double elapsed() const { return since_start_.seconds(); }

 private:
  void state(const lab::WorkPiece& piece, double done);
  // Seconds that are left: the expected ones, by how much the work so far took longer or shorter than expected.
  double remaining() const;

  const ComparisonObserver& observer_;
  lab::ComparisonWatch watch_;
  const Stopwatch since_start_;
  double expected_ = 0, done_ = 0, piece_ = 0;  // seconds since expect(), as they were expected
  double expected_at_ = 0;                      // when
  bool under_way_ = false;                      // a piece
};

}  // namespace montelux
