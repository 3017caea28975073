#include "lab/integral/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace montelux::lab {
namespace {

constexpr std::uint64_t first_look = 4096, trusted_without_spread = 1u << 16;
// A run with only a target error gives up after this many samples that are all 0.
constexpr std::uint64_t max_zeros = 1u << 24;
constexpr std::uint64_t max_new_passes = 1u << 20;  // of the length that a saved run had
constexpr std::uint64_t max_group = 4096;           // passes that are added together

}  // namespace

Schedule::Schedule(const Technique& technique, const Budget& budget, const Execution& execution, IntegralState& state,
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

StopReason Schedule::run() {
  if (!budget_.seconds && !budget_.target_error) return run_fixed(budget_.samples.value_or(default_samples));
  return run_growing();
}

std::uint64_t Schedule::spent() const {
  return std::uint64_t(double(state_.evaluations - state_.training_evaluations - evaluations_before_) / traits_.cost);
}

// Longer passes of independent samples have no advantage, and a stop loses the current one.
std::uint64_t Schedule::max_length() const {
  constexpr std::uint32_t passes_of_independent = 32;
  const bool whole = traits_.unit == 0;
  return whole || traits_.passes >= passes_of_independent ? max_samples_of_whole_pass : max_samples_of_pass;
}

bool Schedule::add(std::uint32_t begin, std::uint32_t end, std::uint64_t first, std::uint64_t count) {
  if (end > max_passes) throw std::invalid_argument(fmt::format("a run has {} passes at most", max_passes));
  const bool done = runner_.add(begin, end, first, count);
  state_.seconds = seconds_before_ + elapsed();
  return done;
}

void Schedule::observe(double fraction) const {
  if (!execution_.observer) return;
  const PassEstimate e = estimate_of(state_);
  execution_.observer({e.mean, e.standard_error, std::min(1.0, fraction), elapsed(), state_.evaluations,
                       std::uint64_t(state_.passes.size()), note()});
}

std::string_view Schedule::note() const {
  if (found_nothing(state_)) return "no sample has found anything yet";
  if (!budget_.target_error || !budget_.target_is_relative) return {};
  const PassEstimate e = estimate_of(state_);
  return e.reach(confidence_) >= std::abs(e.mean) ? "the value may be 0, so a relative error may be impossible to reach"
                                                  : std::string_view();
}

// The number of passes; sets their length if it does not follow from an earlier run.
std::uint64_t Schedule::fixed_passes(std::uint64_t samples) {
  const bool given = state_.method.passes && passes_ == 0;
  if (passes_ > 0 && samples / length_ > max_new_passes)
    length_ = std::clamp(technique_.fitting(samples / max_new_passes), length_, std::max(length_, max_length()));
  if (passes_ == 0) {
    std::uint64_t passes = given ? std::uint64_t(*state_.method.passes) : traits_.passes;
    if (!given) passes = std::max(passes, (samples + max_length() - 1) / max_length());
    length_ = std::max(traits_.min_samples, technique_.fitting(std::max(traits_.min_samples, samples / passes)));
    if (length_ > max_samples_of_pass)
      throw std::invalid_argument(fmt::format("{} passes of {} samples are too long: a pass has {} at most", passes,
                                              length_, max_samples_of_pass));
    if (given) return passes;
  }
  return std::max<std::uint64_t>(passes_ > 0 ? 1 : 2, samples / length_);
}

// The given number of samples, in passes of one length; new passes if the run is resumed.
StopReason Schedule::run_fixed(std::uint64_t samples) {
  if (samples > state_.training_evaluations && passes_ == 0) samples -= state_.training_evaluations;
  const std::uint64_t passes = fixed_passes(std::uint64_t(double(samples) / traits_.cost)), length = length_;
  // Groups of passes small enough to show progress and to stop soon.
  const std::uint64_t group = std::clamp<std::uint64_t>((std::uint64_t(1) << 20) / length, 1, max_group);
  for (std::uint64_t done = 0; done < passes;) {
    const std::uint64_t next = std::min(passes, done + group);
    if (passes_ + next > max_passes)
      throw std::invalid_argument(fmt::format("a run has {} passes at most", max_passes));
    if (!add(passes_ + std::uint32_t(done), passes_ + std::uint32_t(next), 0, length)) return StopReason::stopped;
    done = next;
    observe(double(done) / double(passes));
  }
  return StopReason::samples;
}

// Passes that double in length, with a test after each doubling, until the time, the samples or the target is reached;
// the remaining time or samples are used for more passes of the same length.
StopReason Schedule::run_growing() {
  if (passes_ == 0) {
    const auto stated = state_.method.passes;
    passes_ = stated ? std::uint32_t(*stated) : std::max<std::uint32_t>(16, traits_.passes);
    length_ = std::bit_ceil(std::max(traits_.min_samples, first_look / passes_));
    if (budget_.samples) length_ = std::min(length_, *budget_.samples / passes_);
    length_ = std::max(traits_.min_samples, technique_.fitting(std::max(traits_.min_samples, length_)));
    if (!add(0, passes_, 0, length_)) return StopReason::stopped;
  }
  while (true) {
    observe(fraction());
    if (const auto end = look()) return *end;
    if (!affordable(length_ * passes_) || 2 * length_ > max_length()) return spend_rest();
    if (!add(0, passes_, length_, length_)) return StopReason::stopped;
    length_ *= 2;
  }
}

// More passes of the final length; a target error is tested after each increase by half.
StopReason Schedule::spend_rest() {
  std::uint64_t looked = passes_;
  while (affordable(length_)) {
    const std::uint64_t fit = budget_.samples ? (max_samples() - spent()) / length_ : passes_;
    const auto group =
        std::uint32_t(std::clamp<std::uint64_t>(std::min<std::uint64_t>(fit, (1u << 18) / length_), 1, max_group));
    if (!add(passes_, passes_ + group, 0, length_)) return StopReason::stopped;
    passes_ += group;
    observe(fraction());
    if (2 * std::uint64_t(passes_) < 3 * looked) continue;
    if (const auto end = look()) return *end;
    looked = passes_;
  }
  if (const auto end = look()) return *end;
  return budget_.samples && spent() + length_ > max_samples() ? StopReason::samples : StopReason::seconds;
}

// Whether the samples fit the remaining time, given the speed so far.
bool Schedule::affordable(std::uint64_t samples) const {
  if (budget_.samples && spent() + samples > max_samples()) return false;
  if (!budget_.seconds) return true;
  // A resumed run knows its speed.
  const double all = double(spent()) + double(evaluations_before_) / traits_.cost;
  const double one = (seconds_before_ + elapsed()) / std::max(1.0, all);
  const double left = *budget_.seconds - elapsed();
  return left > 0 && double(samples) * one <= left;
}

double Schedule::fraction() const {
  double f = 0;
  if (budget_.samples) f = double(spent()) / double(max_samples());
  if (budget_.seconds) f = std::max(f, elapsed() / *budget_.seconds);
  if (!budget_.target_error) return f;
  if (found_nothing(state_)) return std::max(f, std::min(1.0, double(spent()) / double(max_zeros)));
  const double ratio = target() / std::max(1e-300, estimate_of(state_).reach(confidence_));
  return std::max(f, std::min(1.0, ratio * ratio));
}

double Schedule::target() const {
  return *budget_.target_error * (budget_.target_is_relative ? std::abs(estimate_of(state_).mean) : 1.0);
}

// One test of the stopping rule, with its share of the error rate: the reason to end, if there is one.
std::optional<StopReason> Schedule::look() {
  if (!budget_.target_error) return std::nullopt;
  const bool bounded = budget_.samples || budget_.seconds, patient = spent() >= trusted_without_spread;
  confidence_ = confidence_of_look(budget_.confidence, ++state_.looks);
  if (found_nothing(state_))
    return !bounded && spent() >= max_zeros ? std::optional(StopReason::nothing_found) : std::nullopt;
  const PassEstimate e = estimate_of(state_);
  // A spread of zero may be a constant, or a peak that no sample has found yet.
  if (!e.spread && !patient) return std::nullopt;
  reached_ = e.reach(confidence_) <= target();
  if (reached_) return StopReason::target_error;
  return !e.spread && !bounded ? std::optional(StopReason::rounding) : std::nullopt;
}

}  // namespace montelux::lab
