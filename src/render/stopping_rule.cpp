#include "render/stopping_rule.h"

#include <algorithm>
#include <limits>

namespace montelux {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double counted_seconds(const RenderState& state, bool warm_up_counts) {
  return state.seconds - (warm_up_counts ? 0 : state.warm_up);
}

}  // namespace

double StoppingRule::time_for_estimate(const RenderState&) const { return infinite; }

bool TimeLimit::stops(const RenderState& state) const {
  const double counted = counted_seconds(state, warm_up_counts_);
  return state.is_covered && (counted >= seconds_ || counted + state.next_frame > seconds_ + lateness_);
}
double TimeLimit::seconds_left(const RenderState& state) const {
  return std::max(seconds_ - counted_seconds(state, warm_up_counts_), 0.0);
}

bool TimeBudget::stops(const RenderState& state) const {
  return state.is_complete && state.seconds + state.next_frame + ending_ > seconds_;
}
double TimeBudget::seconds_left(const RenderState& state) const { return std::max(seconds_ - state.seconds, 0.0); }

bool FirstOf::stops(const RenderState& state) const {
  return std::ranges::any_of(rules_, [&](const auto& rule) { return rule->stops(state); });
}
double FirstOf::seconds_left(const RenderState& state) const {
  double shortest = infinite;
  for (const auto& rule : rules_) shortest = std::min(shortest, rule->seconds_left(state));
  return shortest;
}
double FirstOf::time_for_estimate(const RenderState& state) const {
  double shortest = infinite;
  for (const auto& rule : rules_) shortest = std::min(shortest, rule->time_for_estimate(state));
  return shortest;
}

}  // namespace montelux
