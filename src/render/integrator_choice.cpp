#include "render/integrator_choice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "render/shared_samples.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

// Passes that the render itself and its other pilots never take.
constexpr int first_choice_pass = (1 << 30) + (1 << 20);
// Fewer windows have no usable interval.
constexpr std::size_t min_windows = 10;
// Of a coarse image: a caustic should cover some windows, and the windows of a pilot some hundreds.
constexpr int min_cells = 2048, max_cells = 32768, coarse_window = 4;

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
    const std::vector<std::size_t> others = survivors();
    compare_coarse_images(others);
    if (!others.empty()) compare_longer(others);
    decide();
    if (observer_.stop_requested()) choice_ = {0, ChoiceReason::interrupted, {}, 0, 0};
    choice_.samples = spent_ / pixels();
    choice_.share = choice_.samples / (choice_.samples + settings_.samples);
    return choice_;
  }

 private:
  // Candidates with their samples in each pass.
  using Plan = std::vector<std::pair<std::size_t, int>>;

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

  // Of pixels, or of cells of the grid, whose means are compared.
  int compared_side(const std::optional<PixelGrid>& grid = {}) const {
    if (!settings_.is_filtered) return 1;
    const int stride = grid ? grid->stride : 1;
    return (filtered_side + stride - 1) / stride;
  }
  std::vector<PixelBounds> compared_windows(std::span<const PixelBounds> windows) const {
    std::vector<PixelBounds> compared;
    for (const PixelBounds& window : windows) compared.push_back(cells_of(window, compared_side()));
    return compared;
  }

  // Makes those of the plan that no pilot has needed before, side by side: most of the work is on one thread each.
  void make(const Plan& plan) {
    std::vector<std::size_t> missing;
    for (const auto& [candidate, samples] : plan)
      if (!made_[candidate]) missing.push_back(candidate), spent_ += candidates_[candidate].making;
    Scheduler(settings_.threads).run(missing.size(), [&](std::size_t i, int) {
      made_[missing[i]] = candidates_[missing[i]].make();
    });
  }

  // The windows [first, first + count), starting again after the last one.
  std::vector<PixelBounds> part_of_windows(std::size_t first, std::size_t count) const {
    std::vector<PixelBounds> some;
    for (std::size_t i = 0; i < count; ++i) some.push_back(windows_[(first + i) % windows_.size()]);
    return some;
  }

  // The pilots of these candidates, the first of which is the first candidate, on these windows, by the means that are
  // compared.
  std::vector<CandidatePilot> measure(const Plan& plan, std::span<const PixelBounds> windows,
                                      const std::optional<PixelGrid>& grid = {}) {
    std::vector<CandidatePilot> pilots;
    make(plan);
    for (const auto& [candidate, samples] : plan)
      pilots.push_back({candidate, samples, std::vector<WindowPilot>(windows.size())});
    const auto run_unit = [&](std::size_t unit, int) {
      CandidatePilot& pilot = pilots[unit % pilots.size()];
      WindowPilot& window = pilot.windows[unit / pilots.size()];
      for (std::size_t pass = 0; pass < window.passes.size(); ++pass) {
        const RayCounts rays = trace_window(*made_[pilot.candidate], settings_.image, windows[unit / pilots.size()],
                                            next_pass_ + int(pass), pilot.samples_per_pass, window.passes[pass], grid);
        window.cost += candidates_[pilot.candidate].ray_cost * double(rays.all());
      }
    };
    Scheduler(settings_.threads).run(pilots.size() * windows.size(), run_unit, {.stop = [this] {
                                       return observer_.stop_requested();
                                     }});
    next_pass_ += passes_of_pilot;
    if (observer_.stop_requested()) return {};
    learn_costs(pilots, windows);
    if (const int side = compared_side(grid); side > 1)
      for (CandidatePilot& pilot : pilots)
        for (std::size_t w = 0; w < windows.size(); ++w) average_cells(pilot.windows[w], windows[w], side);
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
  double work_of(const Plan& plan) const {
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
    const std::vector<PixelBounds> compared = compared_windows(windows);
    const std::vector<double> once(count, 1.0);
    const double max_samples = settings_.samples, error = settings_.target->error;
    // A filter blurs, too, and what it leaves must be known: four scenes took 3.5 to 14 times as many samples as the
    // noise of means over filtered_side x filtered_side pixels.
    const double of_filter = settings_.is_filtered ? 4 : 1;
    for (int samples = 1;; samples *= growth) {
      const std::vector<CandidatePilot> pilots = measure({{0, samples}}, windows);
      if (pilots.empty()) return false;
      const double of_unit =
          samples_for_unit_error(pairs_of(pilots, compared)[0].other, once, *settings_.target, windows_.size());
      const double predicted = of_filter * of_unit / (error * error);
      settings_.samples = std::isfinite(predicted) ? std::clamp(predicted, 1.0, max_samples) : max_samples;
      if (growth * pilots[0].samples() * pixels_of(windows) > part * settings_.samples * pixels()) return true;
    }
  }

  // Passes of the first candidate are longer: they cost less, and it gains most by the even spread of their points.
  static Plan plan_of(const std::vector<std::size_t>& others, int of_first, int of_others) {
    Plan plan{{0, of_first}};
    for (std::size_t k : others) plan.emplace_back(k, of_others);
    return plan;
  }
  static Plan short_plan(const std::vector<std::size_t>& others) { return plan_of(others, 2, 1); }
  static Plan long_plan(const std::vector<std::size_t>& others, int samples = 1) {
    return plan_of(others, 4 * samples, samples);
  }

  // Compares those whose paths splat light with the first candidate, as far as there is time for it: on coarser images,
  // since they are as costly in a window as in the whole image. Work for the others' longer pilots is left.
  void compare_coarse_images(const std::vector<std::size_t>& others) {
    constexpr double share = 0.25;  // of the budget, for each; their cost may be twice what is expected
    const double reserved = others.empty() ? 0 : work_of(long_plan(others)) * double(min_windows);
    for (std::size_t k = 1; k < candidates_.size(); ++k) {
      if (!candidates_[k].splats) continue;
      const double cell_work = work_of(long_plan({k})) / window_pixels();
      const double cells = (share * (budget() - reserved) - candidates_[k].making) / cell_work;
      if (cells < std::min(double(min_cells), pixels())) continue;
      const PixelGrid grid = coarse_image(settings_.image.bounds, std::min(cells, double(max_cells)));
      const PixelBounds whole = grid.cells();
      int samples = 1;
      while (2 * samples * whole.area() <= cells) samples *= 2;
      std::vector<CandidatePilot> pilots = measure(long_plan({k}, samples), std::span(&whole, 1), grid);
      if (pilots.empty()) return;
      std::vector<PixelBounds> windows;
      const PixelBounds compared = cells_of(whole, compared_side(grid));
      for (CandidatePilot& pilot : pilots) {
        windows.clear();
        pilot.windows = split_pilot(pilot.windows.front(), compared, coarse_window, windows);
      }
      pairs_[k] = pairs_of(pilots, windows)[1];
      // Cells share no samples, as the pixels of the image do.
      if (filters_share_samples(settings_.image, *made_[0]))
        for (WindowError& error : pairs_[k].first)
          error.relative *= settings_.image.sharing->noise() / settings_.image.sharing->noise_of_own_samples();
      pairs_[k].is_whole_image = true;
    }
  }

  // Those of the other candidates that may be more efficient, by pilots on a few windows; all that there is time for if
  // that is only enough for one.
  std::vector<std::size_t> survivors() {
    constexpr double share = 0.35;  // of the budget
    std::vector<std::size_t> others;
    double making = 0;
    for (std::size_t k = 1; k < candidates_.size(); ++k) {
      if (candidates_[k].splats) continue;
      std::vector<std::size_t> with = others;
      with.push_back(k);
      const double all_making = making + candidates_[k].making;
      const double windows = double(min_windows);
      const double min_work = (work_of(short_plan(with)) + work_of(long_plan({k}))) * windows;
      if (all_making > share * budget() || all_making + min_work > budget()) continue;
      others = with, making = all_making;
    }
    const bool has_first = !others.empty() && others.front() == 1;
    if (!has_first && !candidates_[1].splats &&
        candidates_[1].making + work_of(long_plan({1})) * double(min_windows) <= budget())
      return {1};
    if (others.empty()) return {};
    const double affordable = std::max(share * budget() - making, 0.0) / work_of(short_plan(others));
    compare(short_plan(others), std::max(std::size_t(affordable), min_windows));
    // The best ones first.
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t k : others)
      if (const CandidateRatio r = ratio(k); r.high > 1) ranked.emplace_back(-r.ratio, k);
    std::ranges::sort(ranked);
    std::vector<std::size_t> best;
    for (const auto& [order, k] : ranked) best.push_back(k);
    return best;
  }

  // Compares them with the first candidate with the rest of the budget. Of those that there is no time for, the last
  // ones are left out.
  void compare_longer(std::vector<std::size_t> others) {
    const auto windows_for = [&](int samples) {
      return std::size_t(std::max(budget(), 0.0) / work_of(long_plan(others, samples)));
    };
    const std::size_t min_count = std::min(min_windows, windows_.size());
    while (!others.empty() && windows_for(1) < min_count) others.pop_back();
    if (others.empty()) return;
    constexpr int max_samples = 16;
    int samples = 1;
    while (samples < max_samples && windows_for(2 * samples) >= windows_.size()) samples *= 2;
    compare(long_plan(others, samples), windows_for(samples));
  }

  // Adds pilots on so many windows, at most all, to those before.
  void compare(const Plan& plan, std::size_t max_windows) {
    const std::size_t count = std::min(max_windows, windows_.size());
    const std::vector<PixelBounds> windows = part_of_windows(next_window_, count);
    next_window_ += count;
    const std::vector<CandidatePilot> pilots = measure(plan, windows);
    if (pilots.empty()) return;
    const std::vector<PilotPair> pairs = pairs_of(pilots, compared_windows(windows));
    for (std::size_t k = 1; k < pilots.size(); ++k) pairs_[pilots[k].candidate].append(pairs[k]);
  }

  CandidateRatio ratio(std::size_t candidate) const {
    const auto pair = pairs_.find(candidate);
    if (pair == pairs_.end()) return {candidates_[candidate].name, 1, 0, 1, false};
    return ratio_of(candidates_[candidate].name, pair->second, target(), windows_.size());
  }

  // The best of those that are better than the first candidate with confidence, if there is one. What finds light that
  // the first candidate's pilot lacks is better than what does not, whose error lacks that light, too.
  void decide() {
    // Pilots favour a candidate that shares samples by up to 2.5 (in a Cornell box): they have seen few of its rare
    // bright pixels, and passes of an image are longer, from which the first candidate gains most. One whose pixels are
    // independent of each other has the same kind of errors as the first, but more to gain by longer passes, too.
    // Means over several pixels have fewer such pixels.
    const double min_if_shared = settings_.is_filtered ? 1.3 : 2.0;
    const auto min_ratio = [&](std::size_t candidate) { return made_[candidate]->coupled() ? min_if_shared : 1.1; };
    if (pairs_.empty()) return;
    choice_.reason = ChoiceReason::none_better;
    std::optional<CandidateRatio> best;
    for (const auto& [candidate, pair] : pairs_) {
      const CandidateRatio r = ratio(candidate);
      choice_.ratios.push_back(r);
      // Few bright samples may determine its error; where they are more numerous than those of the first candidate,
      // which lacks them, it is better all the same.
      const bool is_unsure = r.is_unsure && !(candidates_[candidate].splats && r.finds_more_light);
      if (r.low <= min_ratio(candidate) || is_unsure) continue;
      if (best && std::pair(r.finds_more_light, r.ratio) < std::pair(best->finds_more_light, best->ratio)) continue;
      best = r, choice_.chosen = candidate;
      choice_.reason = r.finds_more_light ? ChoiceReason::more_light : ChoiceReason::better;
    }
    // The chosen one first, or the best one.
    const std::string& name = candidates_[choice_.chosen].name;
    std::ranges::sort(choice_.ratios, [&](const CandidateRatio& a, const CandidateRatio& b) {
      if ((a.name == name) != (b.name == name)) return a.name == name;
      return a.ratio > b.ratio;
    });
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
  std::map<std::size_t, PilotPair> pairs_;  // of the candidates that were measured, by their numbers
  IntegratorChoice choice_;
};

}  // namespace

IntegratorChoice choose_by_pilots(const std::vector<Candidate>& candidates, const ChoiceSettings& settings,
                                  RenderObserver& observer) {
  return Pilots(candidates, settings, observer).run();
}

}  // namespace montelux
