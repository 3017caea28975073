// When a render stops before its plan is done.
#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "film/picture_error.h"

namespace montelux {

// A render at one time.
struct RenderState {
  double seconds = 0;        // since the render began
  double warm_up = 0;        // of these, the seconds of frames that are not shown
  double next_frame = 0;     // between two frames of a series: the expected seconds of the next one; otherwise 0
  bool is_covered = false;   // every pixel has a sample, or one that is being taken
  bool is_complete = false;  // every pixel has a sample
  ErrorEstimate error{};     // of the film, by the last estimate; before two passes of every pixel it has no pixels
};

// Decides when a render stops. The render queries it after each unit of work (series: after each frame) and several
// times a second, from several threads at once. A rule has no state: it depends only on the state of the render.
class StoppingRule {
 public:
  virtual ~StoppingRule() = default;
  virtual bool stops(const RenderState& state) const = 0;
  // Seconds until it stops the render, if that can be predicted; otherwise infinite.
  virtual double seconds_left(const RenderState& state) const = 0;
  // Seconds that an estimate of the film's error may take now; infinite by default.
  virtual double time_for_estimate(const RenderState& state) const;
};

// After so many seconds, as soon as every pixel has a sample. For series also before a frame that is expected to end
// `lateness` seconds after that.
class TimeLimit final : public StoppingRule {
 public:
  // `warm_up_counts`: false: the seconds of frames that are not shown are excluded.
  // `lateness`: by default a frame begins whenever it ends.
  TimeLimit(double seconds, bool warm_up_counts = true, double lateness = std::numeric_limits<double>::infinity())
      : seconds_(seconds), warm_up_counts_(warm_up_counts), lateness_(lateness) {}
  double seconds() const { return seconds_; }
  bool warm_up_counts() const { return warm_up_counts_; }
  bool stops(const RenderState& state) const override;
  double seconds_left(const RenderState& state) const override;
  double time_for_estimate(const RenderState& state) const override { return seconds_left(state); }

 private:
  double seconds_;
  bool warm_up_counts_;
  double lateness_;
};

// Before so many seconds are over: a frame begins only if it is expected to end in time. There is always one frame. For
// plans whose passes are synchronous, and for series.
class TimeBudget final : public StoppingRule {
 public:
  // `ending`: the expected seconds from the last frame to the end of the render.
  TimeBudget(double seconds, double ending) : seconds_(seconds), ending_(ending) {}
  double seconds() const { return seconds_; }
  double ending() const { return ending_; }
  bool stops(const RenderState& state) const override;
  double seconds_left(const RenderState& state) const override;
  double time_for_estimate(const RenderState&) const override { return 0; }

 private:
  double seconds_, ending_;
};

// As soon as one of several rules stops.
class FirstOf final : public StoppingRule {
 public:
  explicit FirstOf(std::vector<std::shared_ptr<const StoppingRule>> rules) : rules_(std::move(rules)) {}
  bool stops(const RenderState& state) const override;
  double seconds_left(const RenderState& state) const override;
  double time_for_estimate(const RenderState& state) const override;

 private:
  std::vector<std::shared_ptr<const StoppingRule>> rules_;
};

}  // namespace montelux
