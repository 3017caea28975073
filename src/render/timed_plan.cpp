#include "render/timed_plan.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace montelux {

namespace {

// Forwards only the request to stop.
class StopAlone final : public RenderObserver {
 public:
  explicit StopAlone(RenderObserver& other) : other_(other) {}
  bool stop_requested() override { return other_.stop_requested(); }

 private:
  RenderObserver& other_;
};

// Seconds that one sample of every pixel takes: measured on a part of the pixels first, and on four times as many while
// this takes a small part of the time; of a small image on more samples of each, since a pass of one takes longer.
double measure_sample(const PixelIntegrator& integrator, RenderSettings settings, double seconds,
                      RenderObserver& observer) {
  constexpr double share = 0.01, share_of_more = 0.0025;  // of the time, for one measurement; on more samples
  constexpr int first_cells = 128, max_samples = 64;
  const PixelBounds& bounds = settings.image.bounds;
  int &stride = settings.plan.stride, &samples = settings.plan.samples_per_pass;
  while (PixelGrid{bounds, 2 * stride}.cells().area() >= first_cells) stride *= 2;
  for (;;) {
    const RenderResult result = render(integrator, settings, observer);
    const double cells = PixelGrid{bounds, stride}.cells().area();
    const double enough = (stride > 1 ? share : share_of_more) * seconds;
    if (samples >= max_samples || result.seconds > enough || observer.stop_requested())
      return result.seconds / samples * (bounds.area() / cells);
    stride > 1 ? stride /= 2 : samples *= 4;
  }
}

// So that a thread looks at the clock about thirty times a second.
int unit_samples_for(const RenderSettings& settings, double sample_seconds) {
  constexpr double unit_seconds = 0.03;
  const double threads = settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  const double samples = unit_seconds / (sample_seconds * threads) * settings.image.bounds.area();
  return int(std::clamp(samples, 64.0, double(settings.plan.max_unit_samples)));
}

// The time of the first sample of a series, as a function of the number of cells: a part of it may not depend on the
// pixels.
struct SeriesSeconds {
  double fixed = 0, cell = 0;
  double warm_up_share = 0;  // of the time, as far as it counts
  double of(double cells) const { return fixed + cell * cells; }
};

// Ends a measurement after the frame in which these seconds are over, whether that one is shown or not.
class AfterFrames final : public StoppingRule {
 public:
  explicit AfterFrames(double seconds) : seconds_(seconds) {}
  bool stops(const RenderState& state) const override { return state.next_frame > 0 && state.seconds >= seconds_; }
  double seconds_left(const RenderState& state) const override { return std::max(seconds_ - state.seconds, 0.0); }
  double time_for_estimate(const RenderState&) const override { return 0; }

 private:
  double seconds_;
};

// Measures the first sample of a series on two sets of cells, and on larger ones while that takes a small part of the
// time.
class SeriesMeasurement {
 public:
  SeriesMeasurement(const CoupledIntegrator& coupled, RenderSettings settings, const TimeLimit& limit,
                    RenderObserver& observer)
      : coupled_(coupled), settings_(std::move(settings)), limit_(limit), observer_(observer) {
    // The frames of a long warm-up are like those after it: if they count, one of them is enough.
    const bool by_one = coupled.warm_up() > 1 && limit.warm_up_counts();
    settings_.stop = std::make_shared<AfterFrames>(by_one ? 0 : max_share * limit.seconds());
    if (limit.warm_up_counts()) warm_up_share_ = double(coupled.warm_up()) / (1 + coupled.warm_up());
  }

  SeriesSeconds run() {
    constexpr int first_cells = 32;
    const PixelBounds& bounds = settings_.image.bounds;
    int& stride = settings_.plan.stride;
    while (PixelGrid{bounds, 2 * stride}.cells().area() >= first_cells) stride *= 2;
    double cells = PixelGrid{bounds, stride}.cells().area(), seconds = shortest();
    SeriesSeconds series{0, seconds / cells};
    double cells_of_lowest = cells, lowest = seconds;
    while (stride > 1 && !observer_.stop_requested()) {
      stride /= 2;
      cells = PixelGrid{bounds, stride}.cells().area(), seconds = shortest();
      // What does not depend on the pixels is within the shortest measurement. Its difference from this one is as
      // inaccurate as they are, and too little time for a cell would be worse than too much.
      const double difference = std::max(seconds - lowest, 0.0) + accuracy * seconds;
      series.cell = std::min(difference / (cells - cells_of_lowest), seconds / cells);
      // Something else has slowed down the measurement before, so it is not used.
      if (seconds < (1 - accuracy) * lowest) series.cell = seconds / cells;
      series.fixed = seconds - series.cell * cells;
      if (seconds < lowest) cells_of_lowest = cells, lowest = seconds;
      if (seconds > enough * limit_.seconds() || used_ + series.of(4 * cells) > max_share * limit_.seconds()) break;
    }
    series.warm_up_share = warm_up_share_;
    return series;
  }

 private:
  // Shares of the time: for all measurements; for one that is long enough. The accuracy of one, relative.
  static constexpr double max_share = 0.2, enough = 0.03, accuracy = 0.05;

  // The shortest time of a few series if each is short, since other programs may interrupt one.
  double shortest() {
    constexpr int tries = 3;
    double lowest = measured();
    for (int i = 1;
         i < tries && (i + 1) * lowest < 0.5 * max_share * limit_.seconds() && used_ < max_share * limit_.seconds();
         ++i)
      lowest = std::min(lowest, measured());
    return lowest;
  }
  // Of a series that takes too much of the time, only the first frames are measured.
  double measured() {
    const RenderResult result = render(coupled_, settings_, observer_);
    used_ += result.seconds;
    const int frames = 1 + coupled_.warm_up();
    if (result.frames >= frames) {
      if (!limit_.warm_up_counts()) return result.shown_seconds();
      warm_up_share_ = result.warm_up / result.seconds;
      return result.seconds;
    }
    return result.seconds / std::max(result.frames, 1) * (limit_.warm_up_counts() ? frames : 1);
  }

  const CoupledIntegrator& coupled_;
  RenderSettings settings_;
  const TimeLimit& limit_;
  RenderObserver& observer_;
  double used_ = 0;
  double warm_up_share_ = 0;  // of the last series that was measured
};

// The stride of a picture within the time: the smallest for which whole series of one sample fill it to within a tenth,
// of the first few that leave room for one at all.
int stride_within(const SeriesSeconds& series, const PixelBounds& bounds, double seconds) {
  constexpr double margin = 1.05, filled = 0.9;
  constexpr int largest = 64, tried = 4;
  int first = 0;
  for (int stride = 1; stride <= largest && (first == 0 || stride < first + tried); ++stride) {
    const double one = margin * series.of(PixelGrid{bounds, stride}.cells().area());
    if (one > seconds) continue;
    if (first == 0) first = stride;
    // A whole picture is worth more than the rest of the time.
    if (stride == 1 || std::floor(seconds / one) * one >= filled * seconds) return stride;
  }
  if (first > 0) return first;
  // Too little time for any: what does not depend on the pixels takes it, and they should take little more.
  int stride = 1;
  while (stride < largest && series.cell * PixelGrid{bounds, stride}.cells().area() > 0.1 * series.fixed) ++stride;
  return stride;
}

// For a coupled integrator of whose series of one frame so many fit into the time.
PassPlan plan_series_for_time(const CoupledIntegrator& coupled, double warm_up_share, double affordable) {
  const double frames = (affordable / min_series - warm_up_share) / std::max(1 - warm_up_share, 1e-3);
  return {int(std::clamp(frames, 1.0, double(coupled.frames()))), endless_passes};
}

}  // namespace

TimedPlan plan_for_time(const AnyIntegrator& integrator, RenderSettings settings, const TimeLimit& limit,
                        RenderObserver& observer) {
  constexpr int measured_pass = 1 << 30;  // which the render itself never takes
  settings.plan = {1, 1, measured_pass};
  settings.stop = nullptr, settings.begun = nullptr, settings.keeping = {}, settings.sequence = {};
  StopAlone silent(observer);
  const double max_share = is_fixed(settings.image.sampler) ? max_fixed_samples : 1e6;
  TimedPlan timed;
  const Stopwatch since_start(settings.clock);
  if (const CoupledIntegrator* coupled = integrator.coupled()) {
    const PixelBounds& bounds = settings.image.bounds;
    const SeriesSeconds series = SeriesMeasurement(*coupled, settings, limit, silent).run();
    timed.sample_seconds = std::max(series.of(bounds.area()), 1e-6);
    const double affordable = std::min(limit.seconds() / timed.sample_seconds, max_share);
    timed.plan = plan_series_for_time(*coupled, series.warm_up_share, affordable);
    timed.plan.stride = stride_within(series, bounds, limit.seconds() - since_start.seconds());
    timed.first_seconds = series.of(PixelGrid{bounds, timed.plan.stride}.cells().area());
    if (timed.plan.stride > 1) timed.plan.samples_per_pass = 1;
    return timed;
  }
  timed.sample_seconds = std::max(measure_sample(*integrator.pixel(), settings, limit.seconds(), silent), 1e-6);
  const double affordable = std::min((limit.seconds() - since_start.seconds()) / timed.sample_seconds, max_share);
  // The measurement is accurate to some percent, and the first pass is always completed.
  constexpr double margin = 1.05;
  int stride = 1;
  while (stride < 64 && affordable * stride * stride < margin) ++stride;
  if (stride == 1) timed.plan = plan_passes(std::max(int(affordable), 1), settings.image.sampler);
  if (!is_fixed(settings.image.sampler)) timed.plan.passes = endless_passes;
  timed.plan.stride = stride;
  timed.first_seconds = timed.sample_seconds / (stride * stride);
  timed.plan.max_unit_samples = unit_samples_for(settings, timed.sample_seconds);
  return timed;
}

PassPlan plan_for_budget(const AnyIntegrator& integrator) {
  constexpr int longest_series = 1024;
  if (integrator.coupled()) return {longest_series, 1};
  PassPlan plan{1, endless_passes};
  plan.synchronous = true;
  return plan;
}

}  // namespace montelux
