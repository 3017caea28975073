#include "lab/integral/integrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "lab/integral/choose.h"
#include "lab/integral/density_sampler.h"
#include "lab/integral/sampled.h"
#include "lab/integral/summary.h"
#include "lab/integral/technique.h"

namespace montelux::lab {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t default_samples = 1u << 20;
constexpr std::uint64_t most_samples_of_pass = std::uint64_t(1) << 31;
constexpr std::uint64_t most_of_whole_pass = std::uint64_t(1) << 22;  // where a pass cannot be cut: a stop waits for it

void check(const Problem& problem, const Budget& budget) {
  const auto fail = [](std::string message) { throw std::invalid_argument(std::move(message)); };
  if (!problem.integrand.evaluate) fail("there is no integrand");
  if (problem.integrand.dimension < 1 || problem.integrand.dimension > 64)
    fail(fmt::format("an integrand has 1 to 64 dimensions, not {}", problem.integrand.dimension));
  if (budget.samples && *budget.samples < 2) fail("at least two samples are needed");
  if (budget.seconds && !(*budget.seconds > 0)) fail("the time must be positive");
  if (budget.target_error && !(*budget.target_error > 0)) fail("the target error must be positive");
  if (!(budget.confidence > 0 && budget.confidence < 1)) fail("the confidence must lie between 0 and 1");
}

// How many samples the run will have, as far as that is known before it.
std::uint64_t planned_samples(const Budget& budget) {
  constexpr std::uint64_t unknown = 1u << 16;
  if (budget.samples) return *budget.samples;
  if (budget.target_error) return unknown;
  return budget.seconds ? std::uint64_t(std::clamp(1e6 * *budget.seconds, 1e5, 1e8)) : default_samples;
}

// A share of the samples small enough that it costs little where it brings nothing, and no more than a map can use.
std::uint64_t training_plan(std::uint64_t samples) {
  constexpr std::uint64_t least = 128, most = 1u << 16;
  return std::clamp<std::uint64_t>(samples / 6, least, most);
}

// What a run is made of before its first pass.
struct Start {
  IntegralState state;
  std::unique_ptr<Technique> technique;
  std::string why;  // of the choice of `auto`
};
Start begin(const Problem& problem, const Method& method, const Budget& budget, const Execution& execution) {
  Start start;
  IntegralState& state = start.state;
  const bool resumed = execution.resume.has_value();
  if (resumed) {
    state = *execution.resume;
    if (state.dimension != problem.integrand.dimension)
      throw std::invalid_argument(fmt::format("the state is of an integral in {} dimensions, this one has {}",
                                              state.dimension, problem.integrand.dimension));
  } else {
    state.method = method, state.dimension = problem.integrand.dimension, state.seed = execution.seed;
    const bool may_train = method.kind == MethodKind::automatic || trains(method);
    if (may_train) state.training_samples = training_plan(planned_samples(budget));
  }
  MapTraining training(problem.integrand, state.seed, state.training_samples);
  if (state.method.kind == MethodKind::automatic) {
    const Choice choice = choose_method(problem, state.seed, planned_samples(budget), training);
    state.method = choice.method, state.training_evaluations = choice.evaluations;
    start.why = choice.why;
    if (!trains(state.method)) state.training_evaluations += training.evaluations();
  }
  if (trains(state.method)) training.go_to(MapTraining::steps);
  start.technique = make_technique(problem, state.method, state.seed, &training);
  if (!resumed) {
    state.training_evaluations += start.technique->traits().training_evaluations;
    state.evaluations = state.training_evaluations;
  }
  return start;
}

// The part of the integral where what points are drawn by is 0: the bias that this causes.
struct MissedRegion {
  double integral = 0, standard_error = 0;
  std::uint64_t points = 0;  // of the uniform ones that met it
};
constexpr std::uint64_t missed_samples = 4096;

MissedRegion measure_missed(const Integrand& integrand, const BatchFunction& support, std::uint64_t seed,
                            std::uint64_t samples) {
  const std::size_t dimension = integrand.dimension, most = batch_size(dimension);
  std::vector<double> points(dimension * most), p(most), f(most);
  MissedRegion region;
  Moments moments;
  for (std::uint64_t done = 0; done < samples;) {
    const std::size_t n = std::size_t(std::min<std::uint64_t>(most, samples - done));
    const PointBatch batch{std::span(points).first(dimension * n), dimension, n};
    fill_independent(CubeKey::of(seed, ~0u).fork(0xdec1a7edu), {dimension, done, n, points.data()});
    support(batch, std::span(p).first(n));
    integrand.evaluate(batch, std::span(f).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      const bool missed = p[i] == 0 && f[i] != 0;
      region.points += missed ? 1 : 0;
      moments.add(missed ? f[i] : 0);
    }
    done += n;
  }
  region.integral = moments.mean, region.standard_error = moments.standard_error();
  return region;
}

IntegralWarning warning_of(const MissedRegion& region) {
  return {IntegralWarning::Kind::missed_region,
          fmt::format(
              "the integrand is not 0 where the density it is sampled by is: the result lacks about {:.3g} +- {:.1g}",
              region.integral, region.standard_error)};
}

// Grows a state by whole parts of passes: all of them, or none where it is stopped on the way.
class Runner {
 public:
  Runner(const Technique& technique, const Execution& execution, IntegralState& state)
      : technique_(technique), traits_(technique.traits()), execution_(execution), state_(state) {}

  // Adds samples [first, first + count) to passes [begin, end) of this run. False: stopped, and the state is as before.
  bool add(std::uint32_t begin, std::uint32_t end, std::uint64_t first, std::uint64_t count) {
    std::vector<Unit> units;
    for (std::uint32_t pass = begin; pass < end; ++pass) {
      const std::uint64_t cut = traits_.unit == 0 ? count : traits_.unit;
      for (std::uint64_t done = 0; done < count; done += cut)
        units.push_back(
            {{CubeKey::of(state_.seed, pass), first + done, std::min(cut, count - done), first, count}, pass, {}});
    }
    if (!run_all(units, count * (end - begin))) return false;
    for (const Unit& unit : units) enter(unit);
    return true;
  }

 private:
  struct Unit {
    PassPart part;
    std::uint32_t pass;
    TermSums sums;
  };

  bool run_all(std::vector<Unit>& units, std::uint64_t samples) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> stopped{false};
    std::exception_ptr failure;
    std::mutex mutex;
    const auto work = [&] {
      try {
        for (std::size_t i; !stopped && (i = next.fetch_add(1)) < units.size();) {
          Unit& unit = units[i];
          unit.sums = technique_.run(unit.part);
          if (execution_.stop) {
            std::scoped_lock lock(mutex);
            if (execution_.stop()) stopped = true;
          }
        }
      } catch (...) {
        std::scoped_lock lock(mutex);
        if (!failure) failure = std::current_exception();
        stopped = true;
      }
    };
    // A thread costs tens of microseconds to start: not for less than a few thousand samples each.
    const int wanted = execution_.threads > 0 ? execution_.threads : int(std::thread::hardware_concurrency());
    const int threads = int(std::clamp<std::uint64_t>(samples / 16384, 1, std::uint64_t(std::max(1, wanted))));
    {
      std::vector<std::jthread> pool;
      for (int i = 1; i < threads; ++i) pool.emplace_back(work);
      work();
    }
    if (failure) std::rethrow_exception(failure);
    return next >= units.size() && !stopped;
  }

  // In the order of the units, whoever did them: the same bits for any number of threads.
  void enter(const Unit& unit) {
    PassRecord* record = &record_of(unit.pass);
    TermSums sums;
    sums.samples = record->samples, sums.sum = record->sum, sums.m2 = record->m2;
    sums.merge(unit.sums);
    record->samples = sums.samples, record->sum = sums.sum, record->m2 = sums.m2;
    record->own_variance += unit.sums.own_variance;
    record->control_sum += unit.sums.control_sum;
    record->control_squares += unit.sums.control_squares;
    record->control_products += unit.sums.control_products;
    state_.evaluations += unit.sums.evaluations, state_.non_finite += unit.sums.non_finite;
    state_.proposed += unit.sums.proposed, state_.accepted += unit.sums.accepted;
    state_.largest.merge(unit.sums.largest);
  }

  // The passes of a run stand one after the other, in the order of their numbers; a merged state may hold others.
  PassRecord& record_of(std::uint32_t pass) {
    std::vector<PassRecord>& all = state_.passes;
    const auto is_it = [&](std::size_t i) {
      return i < all.size() && all[i].index == pass && all[i].seed == state_.seed;
    };
    if (!is_it(last_) && is_it(last_ + 1)) ++last_;
    for (std::size_t i = 0; i < all.size() && !is_it(last_); ++i)
      if (is_it(i)) last_ = i;
    if (!is_it(last_)) {
      all.push_back({});
      last_ = all.size() - 1;
      all[last_].seed = state_.seed, all[last_].index = pass;
    }
    return all[last_];
  }

  const Technique& technique_;
  TechniqueTraits traits_;
  const Execution& execution_;
  IntegralState& state_;
  std::size_t last_ = 0;  // the record that was asked for last
};

// One run: decides how many passes of how many samples, and when it is enough.
class Run {
 public:
  Run(const Technique& technique, const Budget& budget, const Execution& execution, IntegralState& state,
      Clock::time_point start)
      : technique_(technique),
        traits_(technique.traits()),
        budget_(budget),
        execution_(execution),
        state_(state),
        runner_(technique, execution, state),
        start_(start),
        seconds_before_(state.seconds),
        evaluations_before_(state.evaluations - state.training_evaluations) {
    for (const PassRecord& p : state.passes)
      if (p.seed == state.seed) {
        passes_ = std::max(passes_, p.index + 1);
        length_ = std::max(length_, p.samples);
      }
  }

  StopReason go() {
    if (!budget_.seconds && !budget_.target_error) return run_fixed(budget_.samples.value_or(default_samples));
    return run_growing();
  }
  bool target_reached() const { return reached_; }
  double confidence() const { return confidence_; }

 private:
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  std::uint64_t spent() const {
    return (state_.evaluations - state_.training_evaluations - evaluations_before_) / traits_.cost;
  }

  std::uint64_t most_samples() const { return *budget_.samples / traits_.cost; }

  bool add(std::uint32_t begin, std::uint32_t end, std::uint64_t first, std::uint64_t count) {
    const bool done = runner_.add(begin, end, first, count);
    state_.seconds = seconds_before_ + elapsed();
    return done;
  }

  void observe(double fraction) const {
    if (!execution_.observer) return;
    const PassEstimate e = estimate_of(state_);
    execution_.observer({e.mean, e.standard_error, std::min(1.0, fraction), elapsed(), state_.evaluations,
                         std::uint64_t(state_.passes.size())});
  }

  // As many samples as are given, in passes of one length; new passes where the run goes on.
  StopReason run_fixed(std::uint64_t samples) {
    if (samples > state_.training_evaluations && passes_ == 0) samples -= state_.training_evaluations;
    samples /= traits_.cost;
    const bool passes_given = state_.method.passes > 0 && passes_ == 0;
    std::uint64_t passes = passes_given ? state_.method.passes : traits_.passes;
    if (traits_.unit == 0 && !passes_given) passes = std::max(passes, samples / most_of_whole_pass);
    if (passes_ == 0) length_ = std::max(traits_.least, technique_.fitting(std::max(traits_.least, samples / passes)));
    if (!passes_given) passes = std::max<std::uint64_t>(passes_ > 0 ? 1 : 2, samples / length_);
    const std::uint64_t length = length_;
    // Groups of passes small enough that progress is seen and a stop is obeyed soon.
    const std::uint64_t group = std::max<std::uint64_t>(1, (std::uint64_t(1) << 20) / length);
    const std::uint32_t last = passes_ + std::uint32_t(passes);
    for (std::uint32_t begin = passes_; begin < last;) {
      const auto end = std::uint32_t(std::min<std::uint64_t>(last, begin + group));
      if (!add(begin, end, 0, length)) return StopReason::stopped;
      begin = end;
      observe(double(begin - passes_) / double(last - passes_));
    }
    return StopReason::samples;
  }

  // Passes that double in length, looked at after each doubling, until the time, the samples or the target is reached;
  // what is left of the time or the samples goes into more passes of the same length.
  StopReason run_growing() {
    if (passes_ == 0) {
      passes_ = state_.method.passes > 0 ? state_.method.passes : std::max<std::uint32_t>(16, traits_.passes);
      length_ = std::bit_ceil(std::max(traits_.least, first_look / passes_));
      if (budget_.samples)
        length_ = std::min(length_, std::max<std::uint64_t>(traits_.least, *budget_.samples / passes_));
      if (!add(0, passes_, 0, length_)) return StopReason::stopped;
    }
    while (true) {
      observe(fraction());
      if (look()) return StopReason::target_error;
      const std::uint64_t cost = length_ * passes_;
      if (affordable(cost) && length_ < (traits_.unit == 0 ? most_of_whole_pass : most_samples_of_pass)) {
        if (!add(0, passes_, length_, length_)) return StopReason::stopped;
        length_ *= 2;
        continue;
      }
      const StopReason reason = spend_rest();
      if (look()) return StopReason::target_error;
      return reason;
    }
  }

  StopReason spend_rest() {
    while (affordable(length_)) {
      const std::uint64_t fit = budget_.samples ? (most_samples() - spent()) / length_ : passes_;
      const auto group =
          std::uint32_t(std::clamp<std::uint64_t>(std::min<std::uint64_t>(fit, (1u << 18) / length_), 1, 1u << 16));
      if (!add(passes_, passes_ + group, 0, length_)) return StopReason::stopped;
      passes_ += group;
      observe(fraction());
    }
    return budget_.samples && spent() + length_ > most_samples() ? StopReason::samples : StopReason::seconds;
  }

  // Do the samples fit what is left, as far as the speed so far tells?
  bool affordable(std::uint64_t samples) const {
    if (budget_.samples && spent() + samples > most_samples()) return false;
    if (!budget_.seconds) return true;
    // A run that goes on knows its speed from before.
    const std::uint64_t all = spent() + evaluations_before_ / traits_.cost;
    const double one = (seconds_before_ + elapsed()) / double(std::max<std::uint64_t>(1, all));
    const double left = *budget_.seconds - elapsed();
    return left > 0 && double(samples) * one <= left;
  }
  double fraction() const {
    double f = 0;
    if (budget_.samples) f = double(spent()) / double(most_samples());
    if (budget_.seconds) f = std::max(f, elapsed() / *budget_.seconds);
    if (budget_.target_error && target() > 0) {
      const double ratio = target() / std::max(1e-300, estimate_of(state_).reach(confidence_));
      f = std::max(f, std::min(1.0, ratio * ratio));
    }
    return f;
  }
  double target() const {
    return *budget_.target_error * (budget_.target_is_relative ? std::abs(estimate_of(state_).mean) : 1.0);
  }

  // One look of the stopping rule, at its share of the error rate.
  bool look() {
    if (!budget_.target_error) return false;
    confidence_ = confidence_of_look(budget_.confidence, ++state_.looks);
    const PassEstimate e = estimate_of(state_);
    // No spread at all may be a constant, or a peak that no sample has found yet.
    const bool seen_enough = e.standard_error > 0 || spent() >= trusted_without_spread;
    reached_ = seen_enough && e.reach(confidence_) <= target();
    return reached_;
  }

  static constexpr std::uint64_t first_look = 4096, trusted_without_spread = 1u << 16;

  const Technique& technique_;
  TechniqueTraits traits_;
  const Budget& budget_;
  const Execution& execution_;
  IntegralState& state_;
  Runner runner_;
  Clock::time_point start_;
  double seconds_before_;
  std::uint64_t evaluations_before_;
  std::uint32_t passes_ = 0;  // of this seed
  std::uint64_t length_ = 0;  // samples of each
  bool reached_ = false;
  double confidence_ = 0;  // of the last look
};

}  // namespace

std::string_view name_of(StopReason reason) {
  switch (reason) {
    case StopReason::samples:
      return "samples";
    case StopReason::seconds:
      return "seconds";
    case StopReason::target_error:
      return "target-error";
    case StopReason::stopped:
      break;
  }
  return "stopped";
}

IntegralResult integrate(const Problem& problem, const Method& method, const Budget& budget,
                         const Execution& execution) {
  const Clock::time_point start = Clock::now();
  check(problem, budget);
  auto [state, technique, why] = begin(problem, method, budget, execution);
  std::vector<IntegralWarning> missed;
  if (const BatchFunction support = technique->support()) {
    const MissedRegion region = measure_missed(problem.integrand, support, state.seed, missed_samples);
    if (!execution.resume) state.training_evaluations += missed_samples, state.evaluations += missed_samples;
    if (region.points > 0) missed.push_back(warning_of(region));
  }
  Run run(*technique, budget, execution, state, start);
  const StopReason reason = run.go();
  IntegralResult result = result_of(state, budget.confidence);
  for (IntegralWarning& w : missed) result.warnings.push_back(std::move(w));
  result.stopped_because = reason;
  result.why = why;
  result.target_reached = run.target_reached();
  if (budget.target_error) {
    const double reach = estimate_of(state).reach(run.confidence());
    result.interval = {result.mean - reach, result.mean + reach};
    if (!result.target_reached)
      result.warnings.push_back(
          {IntegralWarning::Kind::target,
           fmt::format("the budget ended before the target error: half the interval is {:.3g}", reach)});
  }
  return result;
}

bool DensityReport::normalised() const { return std::abs(integral - 1) <= std::max(1e-4, 5 * standard_error); }

DensityReport inspect_density(const Problem& problem, std::size_t which, std::uint64_t samples, std::uint64_t seed) {
  const UserDensity& density = problem.densities.at(which);
  const std::size_t dimension = problem.integrand.dimension, most = batch_size(dimension);
  constexpr std::uint32_t passes = 16;
  DensityReport report;
  Moments over_passes;
  std::vector<double> points(dimension * most), p(most);
  const std::uint64_t length = std::bit_ceil(std::max<std::uint64_t>(samples / passes, most));
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    Moments inside;
    for (std::uint64_t done = 0; done < length;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(most, length - done));
      fill_sobol(CubeKey::of(seed, ~0u).fork(pass), {dimension, done, n, points.data()});
      density.density({std::span(points).first(dimension * n), dimension, n}, std::span(p).first(n));
      for (std::size_t i = 0; i < n; ++i) {
        inside.add(p[i] * density.scale);
        report.negative |= p[i] < 0;
      }
      done += n;
    }
    over_passes.add(inside.mean);
    report.non_finite += inside.non_finite;
  }
  report.integral = over_passes.mean, report.standard_error = over_passes.standard_error();
  const MissedRegion region = measure_missed(problem.integrand, density.density, seed, samples);
  report.missed = region.integral, report.missed_error = region.standard_error;
  if (!report.negative && report.non_finite == 0 && report.integral > 0) {
    const DensitySampler sampler(density, dimension);
    if (sampler.sampling() == DensitySampling::rejection)
      report.acceptance = report.integral / (sampler.bound() * density.scale);
  }
  return report;
}

}  // namespace montelux::lab
