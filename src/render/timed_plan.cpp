#include "render/timed_plan.h"

#include <algorithm>
#include <thread>

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
// this takes a small part of the time.
double measure_sample(const PixelIntegrator& integrator, RenderSettings settings, double seconds,
                      RenderObserver& observer) {
  constexpr double share = 0.01;  // of the time, for one measurement
  constexpr int first_cells = 128;
  const PixelBounds& bounds = settings.image.bounds;
  int& stride = settings.plan.stride;
  while (PixelGrid{bounds, 2 * stride}.cells().area() >= first_cells) stride *= 2;
  for (;; stride /= 2) {
    const RenderResult result = render(integrator, settings, observer);
    const double cells = PixelGrid{bounds, stride}.cells().area();
    if (stride == 1 || result.seconds > share * seconds || observer.stop_requested())
      return result.seconds * (bounds.area() / cells);
  }
}

// So that a thread looks at the clock about thirty times a second.
int unit_samples_for(const RenderSettings& settings, double sample_seconds) {
  constexpr double unit_seconds = 0.03;
  const double threads = settings.threads > 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  const double samples = unit_seconds / (sample_seconds * threads) * settings.image.bounds.area();
  return int(std::clamp(samples, 64.0, double(settings.plan.max_unit_samples)));
}

// For a coupled integrator, after the measurement of one frame.
PassPlan plan_chains_for_time(const CoupledIntegrator& coupled, bool warm_up_counts, double affordable) {
  const int warm_up = warm_up_counts ? coupled.warm_up() : 0;
  const int frames = int(affordable) * (1 + warm_up) / min_chains - warm_up;
  return {std::clamp(frames, 1, coupled.frames()), endless_passes};
}

}  // namespace

TimedPlan plan_for_time(const AnyIntegrator& integrator, RenderSettings settings, const TimeLimit& limit,
                        RenderObserver& observer) {
  constexpr int measured_pass = 1 << 30;  // which the render itself never takes
  settings.plan = {1, 1, measured_pass};
  settings.stop = nullptr, settings.begun = nullptr, settings.keeping = {}, settings.sequence = {};
  StopAlone silent(observer);
  const double most = is_fixed(settings.image.sampler) ? max_fixed_samples : 1e6;
  TimedPlan timed;
  if (const CoupledIntegrator* coupled = integrator.coupled()) {
    const RenderResult one = render(*coupled, settings, silent);
    timed.sample_seconds = std::max(limit.warm_up_counts() ? one.seconds : one.shown_seconds(), 1e-6);
    const double affordable = std::min(limit.seconds() / timed.sample_seconds, most);
    timed.plan = plan_chains_for_time(*coupled, limit.warm_up_counts(), affordable);
    return timed;
  }
  const Stopwatch since_start(settings.clock);
  timed.sample_seconds = std::max(measure_sample(*integrator.pixel(), settings, limit.seconds(), silent), 1e-6);
  const double affordable = std::min((limit.seconds() - since_start.seconds()) / timed.sample_seconds, most);
  // The measurement is accurate to some percent, and the first pass is always completed.
  constexpr double margin = 1.05;
  int stride = 1;
  while (stride < 64 && affordable * stride * stride < margin) ++stride;
  if (stride == 1) timed.plan = plan_passes(std::max(int(affordable), 1), settings.image.sampler);
  if (!is_fixed(settings.image.sampler)) timed.plan.passes = endless_passes;
  timed.plan.stride = stride;
  timed.plan.max_unit_samples = unit_samples_for(settings, timed.sample_seconds);
  return timed;
}

PassPlan plan_for_budget(const AnyIntegrator& integrator) {
  constexpr int longest_chain = 1024;
  if (integrator.coupled()) return {longest_chain, 1};
  PassPlan plan{1, endless_passes};
  plan.synchronous = true;
  return plan;
}

}  // namespace montelux
