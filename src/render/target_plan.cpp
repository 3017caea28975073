#include "render/target_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace montelux {

namespace {

// Passes that the render itself never takes.
constexpr int first_pilot_pass = 1 << 30;

// Shows that the render has begun, without figures of the picture.
class PilotObserver final : public RenderObserver {
 public:
  explicit PilotObserver(RenderObserver& other) : other_(other) {}
  void progress(const Progress& of_pilot) override {
    if (of_pilot.finished) return;
    Progress p;
    p.elapsed = of_pilot.elapsed, p.samples = of_pilot.samples;
    other_.progress(p);
  }
  bool stop_requested() override { return other_.stop_requested(); }

 private:
  RenderObserver& other_;
};

// How many of the plan's passes every tile has, and the number that any has.
struct PassesDone {
  int all = std::numeric_limits<int>::max(), any = 0;
};
PassesDone passes_of(const Film& film, const PassPlan& plan) {
  PassesDone done;
  for (const auto& [index, tile] : film.tiles()) {
    const auto is_of_plan = [&](const FilmPass& p) { return plan.contains(p.pass); };
    const int own = int(std::ranges::count_if(tile.passes, is_of_plan));
    done.all = std::min(done.all, own), done.any = std::max(done.any, own);
  }
  if (film.tiles().empty()) done.all = 0;
  return done;
}

int predicted_samples(double samples, double work, int max_samples) {
  const double all = samples * work;
  return std::isfinite(all) ? int(std::clamp(all, 1.0, double(max_samples))) : max_samples;
}

void clear_for_pilot(RenderSettings& settings) {
  settings.image.layers.reset(), settings.image.halves = settings.target && settings.target->needs_halves();
  settings.work = nullptr, settings.stop = nullptr, settings.begun = nullptr, settings.target.reset();
  settings.keeping = {}, settings.sequence = {}, settings.unbiased = nullptr;
}

}  // namespace

WorkRound TargetPlan::next_round(const Film& film, const PassPlan& passes, const std::function<bool()>& stops) const {
  const PassesDone done = passes_of(film, passes);
  if (done.all >= passes.passes) return {};
  const bool is_whole = done.all == done.any;
  if (is_whole && looks_.is_look(done.all) && judge_.is_reached(film, stops)) return {};
  // A round that was interrupted is completed first.
  const int end = std::min(looks_.after(is_whole ? done.all : done.any - 1), passes.passes);
  const std::size_t tiles = film.tiles().size();
  const int first = passes.first_pass + done.all;
  const auto unit = [tiles, first](std::size_t i) { return WorkUnit{i % tiles, first + int(i / tiles)}; };
  return {tiles * std::size_t(end - done.all), unit};
}

std::uint64_t TargetPlan::expected_units(const Film& film, const PassPlan& passes) const {
  return std::uint64_t(film.tiles().size()) * std::uint64_t(passes.passes);
}

Pilot pilot_of(const AnyIntegrator& integrator, RenderSettings settings, int samples_per_pass, int passes,
               RenderObserver& observer) {
  clear_for_pilot(settings);
  settings.plan = {samples_per_pass, passes, first_pilot_pass};
  PilotObserver silent(observer);
  RenderResult result = render(integrator, settings, silent);
  return {std::move(result.film), std::move(result.rays_of_tiles)};
}

PlanOfPilot plan_for_target(const AnyIntegrator& integrator, RenderSettings settings, const TargetJudge& judge,
                            int max_samples, RenderObserver& observer) {
  // At least so many times the samples of a pilot are predicted when it is replaced. What is left without noise is less
  // easily foreseen.
  const int share = judge.target().measure == TargetMeasure::denoised ? 8 : 16;
  constexpr int growth = 4;
  clear_for_pilot(settings);
  PilotObserver silent(observer);
  const PointSetKind sampler = settings.image.sampler;
  const int longest = integrator.coupled() ? integrator.coupled()->frames() : 1024;
  settings.plan = {1, 2, first_pilot_pass};
  int predicted = max_samples;
  RenderResult pilot{Film({}), {}, 0, false};
  for (;;) {
    pilot = render(integrator, settings, silent);
    const double samples = settings.plan.samples();
    predicted = predicted_samples(samples, judge.judge(pilot.film, true).work, max_samples);
    settings.plan.first_pass += settings.plan.passes;
    const int k = settings.plan.samples_per_pass * growth;
    if (pilot.interrupted || 2.0 * k * share > predicted || k > longest) break;
    settings.plan.samples_per_pass = k;
  }
  PassPlan plan = plan_passes(integrator, predicted, sampler);
  // The error of the mean is known by the spread of the passes alone.
  constexpr int passes_for_mean = 24;
  while (judge.target().measure == TargetMeasure::mean && plan.samples_per_pass > 1 &&
         predicted / plan.samples_per_pass < passes_for_mean)
    plan.samples_per_pass /= 2;
  plan.passes = std::max((max_samples + plan.samples_per_pass - 1) / plan.samples_per_pass, 1);
  return {plan, {std::move(pilot.film), std::move(pilot.rays_of_tiles)}};
}

PlanOfPilot plan_in_two_stages(const AnyIntegrator& integrator, RenderSettings settings, const TargetJudge& judge,
                               int max_samples, RenderObserver& observer) {
  // Twice the error takes a quarter of the samples.
  const TargetJudge of_pilot = judge.with_error(2 * judge.target().error);
  settings.plan = plan_for_target(integrator, settings, of_pilot, std::max(max_samples / 4, 1), observer).plan;
  clear_for_pilot(settings);
  // After the passes of the first pilots.
  settings.plan.first_pass = first_pilot_pass + (1 << 8);
  settings.work = std::make_shared<TargetPlan>(of_pilot);
  PilotObserver silent(observer);
  RenderResult pilot = render(integrator, settings, silent);
  const double samples = double(settings.plan.samples_per_pass) * std::max(pilot.film.image().passes, 1);
  // A little more than expected, so that most images reach it.
  return {plan_passes(integrator, predicted_samples(samples, 1.1 * judge.judge(pilot.film, true).work, max_samples),
                      settings.image.sampler),
          {std::move(pilot.film), std::move(pilot.rays_of_tiles)}};
}

}  // namespace montelux
