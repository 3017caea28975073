#include "render/integrator_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "work/scheduler.h"

namespace montelux {

namespace {

// Passes that the render itself and its other pilots never take.
constexpr int first_choice_pass = (1 << 30) + (1 << 20);
// Fewer windows have no usable interval.
constexpr std::size_t min_windows = 10;

class Pilots {
 public:
  Pilots(const std::vector<Candidate>& candidates, const ChoiceSettings& settings, RenderObserver& observer)
      : candidates_(candidates),
        settings_(settings),
        observer_(observer),
        windows_(windows_of(settings.image.bounds, settings.image.seed)),
        made_(candidates.size()),
        sample_costs_(candidates.size(), 0.0) {
    for (std::size_t k = 0; k < candidates.size(); ++k) sample_costs_[k] = candidates[k].sample_cost;
  }

  IntegratorChoice run() {
    if (candidates_.size() < 2) return choice_;
    choice_.reason = ChoiceReason::too_short;
    if (settings_.target && !predict_samples()) return choice_;
    const std::optional<std::size_t> best = choose_other();
    if (best) compare(*best);
    if (observer_.stop_requested()) choice_ = {0, ChoiceReason::interrupted, {}, 0, 0};
    choice_.samples = spent_ / pixels();
    choice_.share = choice_.samples / (choice_.samples + settings_.samples);
    return choice_;
  }

 private:
  double pixels() const { return settings_.image.bounds.area(); }
  ErrorTarget target() const { return settings_.target.value_or(ErrorTarget{}); }
  // In samples of the first candidate.
  double budget() const { return settings_.share * settings_.samples * pixels() - spent_; }
  double pixels_of(std::span<const PixelBounds> windows) const {
    double sum = 0;
    for (const PixelBounds& window : windows) sum += window.area();
    return sum;
  }
  // The average one.
  double window_pixels() const { return pixels() / double(windows_.size()); }

  const AnyIntegrator& integrator(std::size_t candidate) {
    if (!made_[candidate]) {
      made_[candidate] = candidates_[candidate].make();
      spent_ += candidates_[candidate].making;
    }
    return *made_[candidate];
  }

  // The windows [first, first + count), starting again after the last one.
  std::vector<PixelBounds> part_of_windows(std::size_t first, std::size_t count) const {
    std::vector<PixelBounds> some;
    for (std::size_t i = 0; i < count; ++i) some.push_back(windows_[(first + i) % windows_.size()]);
    return some;
  }

  // The pilots of these candidates, the first of which is the first candidate, on these windows.
  std::vector<CandidatePilot> measure(const std::vector<std::pair<std::size_t, int>>& plan,
                                      std::span<const PixelBounds> windows) {
    std::vector<CandidatePilot> pilots;
    for (const auto& [candidate, samples] : plan) {
      (void)integrator(candidate);
      pilots.push_back({candidate, samples, std::vector<WindowPilot>(windows.size())});
    }
    const auto run_unit = [&](std::size_t unit, int) {
      CandidatePilot& pilot = pilots[unit % pilots.size()];
      WindowPilot& window = pilot.windows[unit / pilots.size()];
      for (std::size_t pass = 0; pass < window.passes.size(); ++pass) {
        const RayCounts rays = trace_window(*made_[pilot.candidate], settings_.image, windows[unit / pilots.size()],
                                            next_pass_ + int(pass), pilot.samples_per_pass, window.passes[pass]);
        window.cost += candidates_[pilot.candidate].ray_cost * double(rays.all());
      }
    };
    Scheduler(settings_.threads).run(pilots.size() * windows.size(), run_unit, {.stop = [this] {
                                       return observer_.stop_requested();
                                     }});
    next_pass_ += passes_of_pilot;
    if (observer_.stop_requested()) return {};
    learn_costs(pilots, windows);
    return pilots;
  }

  void learn_costs(const std::vector<CandidatePilot>& pilots, std::span<const PixelBounds> windows) {
    const auto cost = [&](const CandidatePilot& pilot) {
      double sum = 0;
      for (const WindowPilot& window : pilot.windows) sum += window.cost;
      return sum / pilot.samples() / pixels_of(windows);
    };
    const double unit = cost(pilots.front());
    for (const CandidatePilot& pilot : pilots) {
      if (unit > 0) sample_costs_[pilot.candidate] = cost(pilot) / unit;
      spent_ += pilot.samples() * sample_costs_[pilot.candidate] * pixels_of(windows);
    }
  }

  // The work of a pilot on one window.
  double work_of(const std::vector<std::pair<std::size_t, int>>& plan) const {
    double sum = 0;
    for (const auto& [candidate, samples] : plan) sum += samples * sample_costs_[candidate];
    return sum * passes_of_pilot * window_pixels();
  }

  // The number of samples that the requested error takes, by pilots of the first candidate: each longer than the one
  // before, as long as this takes a small part of what they predict. Short ones show too small an error.
  bool predict_samples() {
    constexpr int growth = 4;
    constexpr double part = 0.01;  // of the predicted work, for one more pilot
    const std::size_t count = std::min(min_windows, windows_.size());
    const std::vector<PixelBounds> windows = part_of_windows(0, count);
    Sample all(count);
    std::iota(all.begin(), all.end(), std::size_t(0));
    const double most = settings_.samples, error = settings_.target->error;
    for (int samples = 1;; samples *= growth) {
      const std::vector<CandidatePilot> pilots = measure({{0, samples}}, windows);
      if (pilots.empty()) return false;
      const double predicted =
          samples_for_unit_error(shown_by(pilots, windows).errors[0], all, *settings_.target, windows_.size()) /
          (error * error);
      settings_.samples = std::isfinite(predicted) ? std::clamp(predicted, 1.0, most) : most;
      if (growth * pilots[0].samples() * pixels_of(windows) > part * settings_.samples * pixels()) return true;
    }
  }

  using Plan = std::vector<std::pair<std::size_t, int>>;

  // Of the other candidates, the most efficient one on a few windows; none if the first one is better, or if there is
  // no time for pilots.
  std::optional<std::size_t> choose_other() {
    constexpr double share = 0.35;  // of the budget
    // As many as there is time for, in their order.
    Plan plan{{0, 2}};
    double making = 0;
    for (std::size_t k = 1; k < candidates_.size(); ++k) {
      Plan with = plan;
      with.emplace_back(k, 1);
      const double all_making = making + candidates_[k].making;
      const double shortest = work_of(with) * min_windows + compared_work(k, min_windows);
      if (all_making > share * budget() || all_making + shortest > budget()) continue;
      plan = with, making = all_making;
    }
    // With time for one comparison alone, it is with the first of them.
    const bool has_first = plan.size() > 1 && plan[1].first == 1;
    if (!has_first && candidates_[1].making + compared_work(1, min_windows) <= budget()) return 1;
    if (plan.size() < 2) return std::nullopt;
    const double affordable = std::max(share * budget() - making, 0.0) / work_of(plan);
    const std::size_t count = std::min(std::max(std::size_t(affordable), min_windows), windows_.size());
    const std::vector<PixelBounds> windows = part_of_windows(0, count);
    const std::vector<CandidatePilot> pilots = measure(plan, windows);
    next_window_ = count;
    if (pilots.empty()) return std::nullopt;
    choice_.reason = ChoiceReason::none_better;
    const Shown shown = shown_by(pilots, windows);
    std::optional<std::size_t> best;
    double most = 0;
    for (std::size_t k = 1; k < pilots.size(); ++k) {
      const CandidateRatio ratio = ratio_of(candidates_[pilots[k].candidate].name, shown, k, target(), windows_.size());
      choice_.ratios.push_back(ratio);
      if (ratio.high > 1 && ratio.ratio > most) most = ratio.ratio, best = pilots[k].candidate;
    }
    return best;
  }

  // Passes of the first candidate are longer: they cost less, and it gains most by the even spread of their points.
  static constexpr int first_samples = 4;
  Plan compared(std::size_t other, int samples) const { return {{0, first_samples * samples}, {other, samples}}; }
  double compared_work(std::size_t other, std::size_t windows) const {
    return work_of(compared(other, 1)) * double(windows);
  }

  // Another candidate against the first one, with the rest of the budget.
  void compare(std::size_t other) {
    const auto windows_for = [&](int samples) {
      return std::size_t(std::max(budget(), 0.0) / work_of(compared(other, samples)));
    };
    if (windows_for(1) < std::min(min_windows, windows_.size())) return;
    constexpr int most = 16;
    int samples = 1;
    while (samples < most && windows_for(2 * samples) >= windows_.size()) samples *= 2;
    const std::size_t count = std::min(windows_for(samples), windows_.size());
    const std::vector<PixelBounds> windows = part_of_windows(next_window_, count);
    const std::vector<CandidatePilot> pilots = measure(compared(other, samples), windows);
    if (pilots.empty()) return;
    choice_.reason = ChoiceReason::none_better;
    const CandidateRatio ratio =
        ratio_of(candidates_[other].name, shown_by(pilots, windows), 1, target(), windows_.size());
    std::erase_if(choice_.ratios, [&](const CandidateRatio& r) { return r.name == ratio.name; });
    choice_.ratios.insert(choice_.ratios.begin(), ratio);
    // A change gains little where the ratio is hardly above 1.
    constexpr double min_gain = 1.05;
    if (ratio.low <= 1 || ratio.ratio < min_gain) return;
    choice_.chosen = other;
    choice_.reason = ratio.finds_more_light ? ChoiceReason::more_light : ChoiceReason::better;
  }

  const std::vector<Candidate>& candidates_;
  ChoiceSettings settings_;
  RenderObserver& observer_;
  const std::vector<PixelBounds> windows_;
  std::vector<std::optional<AnyIntegrator>> made_;
  std::vector<double> sample_costs_;  // relative to that of the first candidate
  double spent_ = 0;                  // samples of one pixel with the first candidate
  int next_pass_ = first_choice_pass;
  std::size_t next_window_ = 0;
  IntegratorChoice choice_;
};

}  // namespace

IntegratorChoice choose_by_pilots(const std::vector<Candidate>& candidates, const ChoiceSettings& settings,
                                  RenderObserver& observer) {
  return Pilots(candidates, settings, observer).run();
}

}  // namespace montelux
