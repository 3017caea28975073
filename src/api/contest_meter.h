// How far a comparison has come: its pieces of work against what they were expected to take. Inside the facade only.
#pragma once
#include "api/contest.h"
#include "render/stopwatch.h"

namespace montelux {

class ContestMeter {
 public:
  explicit ContestMeter(const ContestObserver& observer);
  ContestMeter(const ContestMeter&) = delete;
  ContestMeter& operator=(const ContestMeter&) = delete;

  // What the work calls; valid as long as the meter.
  const lab::ContestWatch& watch() const { return watch_; }
  // From here on the work is expected to take so many seconds in all; takes the place of what was expected before.
  void expect(double seconds);
  double elapsed() const { return since_start_.seconds(); }

 private:
  void state(const lab::WorkPiece& piece, double done);
  // Seconds that are left: the expected ones, by how much the work so far took longer or shorter than expected.
  double remaining() const;

  const ContestObserver& observer_;
  lab::ContestWatch watch_;
  const Stopwatch since_start_;
  double expected_ = 0, done_ = 0, piece_ = 0;  // seconds since expect(), as they were expected
  double expected_at_ = 0;                      // when
  bool under_way_ = false;                      // a piece
};

}  // namespace montelux
