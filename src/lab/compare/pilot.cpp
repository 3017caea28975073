#include "lab/compare/pilot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/flip.h"
#include "lab/compare/measure.h"
#include "lab/compare/passes.h"
#include "lab/compare/work.h"
#include "mc/moments.h"

namespace montelux::lab {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Passes of one half of a pilot: both together have as many as a repeat, and enough for a variance.
int half_passes(const PassPlan& plan, const ComparisonSettings& settings, double sample_seconds) {
  constexpr int min_passes = 4, max_passes = 64;
  double passes = plan.passes;
  if (settings.seconds) passes = *settings.seconds / settings.repeats / (plan.samples_per_pass * sample_seconds);
  return int(std::clamp(std::ceil(passes / 2), double(min_passes), double(max_passes)));
}

Pilot take_pilot(const ComparedMethod& compared_method, const ComparisonSettings& settings, PassPlan plan,
                 const PieceProgress& piece) {
  Pilot pilot;
  const Stopwatch wall;
  for (int h = 0; h < 2; ++h) {
    RenderSettings s = settings_for(compared_method, settings);
    s.plan = plan, s.plan.first_pass = pilot_pass + h * plan.passes;
    PartOfPiece part(piece, 0.5 * h, 0.5 * h + 0.5);
    const RenderResult r = render(compared_method.integrator, s, part);
    pilot.halves[std::size_t(h)] = {mean_of(r.film), variance_of(r.film)};
    pilot.all_seconds += r.seconds;
  }
  pilot.samples = 2.0 * plan.samples(), pilot.wall_seconds = wall.seconds();
  return pilot;
}

// The mean of a function of the finite values; infinite if there are none.
template <class Function>
double mean_of_finite(std::size_t count, Function f) {
  Moments moments;  // leaves out what is not finite
  for (std::size_t i = 0; i < count; ++i) moments.add(f(i));
  return moments.count > 0 ? moments.mean : infinite;
}

double mse_of(const Pilot::Half& half) {
  return mean_of_finite(half.variance.values.size(), [&](std::size_t i) { return double(half.variance.values[i]); });
}

// The mean of all trusted pilots in this half, each weighted by its precision.
PixelBuffer pooled_mean(const std::vector<Pilot>& pilots, const std::vector<std::size_t>& trusted, std::size_t half) {
  PixelBuffer pooled = pilots.front().halves[half].mean;
  std::vector<double> sum(pooled.values.size());
  double weights = 0;
  for (std::size_t i : trusted) {
    const Pilot::Half& h = pilots[i].halves[half];
    const double weight = 1 / std::max(mse_of(h), 1e-30);
    weights += weight;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * double(h.mean.values[k]);
  }
  if (weights > 0)
    for (std::size_t k = 0; k < sum.size(); ++k) pooled.values[k] = float(sum[k] / weights);
  return pooled;
}

double error_of(const Pilot::Half& half, const PixelBuffer& truth, ErrorMeasure measure) {
  switch (measure) {
    case ErrorMeasure::mse:
      return mse_of(half);
    case ErrorMeasure::relative_mse:
      return mean_of_finite(half.variance.values.size(), [&](std::size_t i) {
        const double mean = double(truth.values[i]);
        return double(half.variance.values[i]) / (mean * mean + 0.01);
      });
    case ErrorMeasure::flip:
      return std::pow(hdr_flip(half.mean, truth).mean, 2);
  }
  return infinite;
}

}  // namespace

std::vector<double> time_methods(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                                 const ComparisonSettings& settings, const ComparisonWatch& watch) {
  std::vector<double> sample_seconds;
  for (std::size_t i = 0; i < compared_methods.size(); ++i) {
    RenderSettings s = settings_for(compared_methods[i], settings);
    s.plan = {1, 1, timing_pass};
    const PieceProgress piece(watch, {"timing of " + compared_methods[i].shown_name(), 0});
    PartOfPiece part(piece, 0, 1);
    // The shortest of a few short passes: the first one has cold caches, and any may be delayed by other work.
    double one = infinite;
    const Stopwatch all;
    for (int k = 0; k < 5 && all.seconds() < 0.05; ++k) {
      const Stopwatch wall;
      (void)render(compared_methods[i].integrator, s, part);
      one = std::min(one, std::max(wall.seconds(), 1e-6));
    }
    // A series has only one warm-up for all its frames.
    if (const CoupledIntegrator* coupled = compared_methods[i].integrator.coupled()) {
      const double warm_up = coupled->warm_up(), frames = state.methods[i].plan.samples_per_pass;
      one *= (warm_up + frames) / (warm_up + 1) / frames;
    }
    sample_seconds.push_back(one);
  }
  return sample_seconds;
}

std::vector<Pilot> run_pilots(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                              const std::vector<double>& sample_seconds, const ComparisonSettings& settings,
                              const ComparisonWatch& watch) {
  std::vector<Pilot> pilots;
  for (std::size_t i = 0; i < compared_methods.size(); ++i) {
    PassPlan plan = state.methods[i].plan;
    plan.passes = half_passes(plan, settings, sample_seconds[i]);
    const PieceProgress piece(watch,
                              {"pilot of " + compared_methods[i].shown_name(), 2 * plan.samples() * sample_seconds[i]});
    pilots.push_back(take_pilot(compared_methods[i], settings, plan, piece));
    if (watch.stopped()) break;
  }
  return pilots;
}

std::vector<double> pilot_errors(const std::vector<Pilot>& pilots, const std::vector<std::size_t>& trusted,
                                 ErrorMeasure measure) {
  std::vector<double> errors(pilots.size());
  for (std::size_t half = 0; half < 2; ++half) {
    const PixelBuffer other = pooled_mean(pilots, trusted, 1 - half);
    // A half has half the samples, so twice the squared error of the whole; the result is the mean of both halves.
    for (std::size_t i = 0; i < pilots.size(); ++i)
      errors[i] += 0.25 * error_of(pilots[i].halves[half], other, measure);
  }
  return errors;
}

ReferenceGoal plan_reference(const std::vector<Pilot>& pilots, const std::vector<std::size_t>& may_serve,
                             const std::vector<double>& samples_of_repeat, ErrorMeasure measure, double share) {
  ReferenceGoal goal;
  goal.method = may_serve.front();
  double lowest_cost = infinite;
  const std::vector<double> ranked = pilot_errors(pilots, may_serve, measure);
  for (std::size_t i : may_serve)
    if (const double cost = ranked[i] * pilots[i].all_seconds; cost < lowest_cost) lowest_cost = cost, goal.method = i;
  // FLIP has no variance: the goal is stated by the others.
  const Pilot& best = pilots[goal.method];
  for (ErrorMeasure by : {ErrorMeasure::relative_mse, ErrorMeasure::mse}) {
    const std::vector<double> errors = by == measure ? ranked : pilot_errors(pilots, may_serve, by);
    double smallest = infinite;
    for (std::size_t i = 0; i < pilots.size(); ++i)
      if (errors[i] > 0) smallest = std::min(smallest, errors[i] * pilots[i].samples / samples_of_repeat[i]);
    const bool first = by == measure || (measure == ErrorMeasure::flip && by == ErrorMeasure::relative_mse);
    goal.variance[by] = (first ? 1 : 3) * share * smallest;
    const double samples = errors[goal.method] * best.samples / goal.variance[by];
    goal.samples = std::max(goal.samples, std::isfinite(samples) ? samples : 0);
  }
  goal.variance[ErrorMeasure::flip] = infinite;
  goal.seconds = goal.samples * best.wall_seconds / best.samples;
  return goal;
}

}  // namespace montelux::lab
