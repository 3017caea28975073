#include "lab/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "lab/compare/measure.h"
#include "lab/compare/passes.h"
#include "lab/compare/work.h"
#include "mc/random.h"
#include "render/timed_plan.h"

namespace montelux::lab {

namespace {

RenderResult take_turn(const ComparedMethod& compared_method, const ComparisonSettings& settings, PassPlan plan,
                       int repeat, RenderObserver& observer) {
  RenderSettings s = settings_for(compared_method, settings);
  s.plan = plan;
  s.image.seed = mix_bits(settings.render.image.seed + 0x9e3779b9u * std::uint32_t(repeat + 1));
  if (settings.seconds)
    s.stop = std::make_shared<TimeLimit>(*settings.seconds / settings.repeats, settings.warm_up_counts);
  return render(compared_method.integrator, s, observer);
}

// The passes of a repeat in its share of the time. Every pixel is sampled, however short that is.
PassPlan plan_within(const ComparisonSettings& settings, const ComparedMethod& method, RenderObserver& observer) {
  const TimeLimit limit(*settings.seconds / settings.repeats, settings.warm_up_counts);
  const PassPlan plan = plan_for_time(method.integrator, settings_for(method, settings), limit, observer).plan;
  return {plan.samples_per_pass, plan.passes};
}

// The order of the methods in one round: random, so that no method is always the first.
std::vector<std::size_t> order_of_round(std::size_t methods, std::uint32_t seed, int round) {
  std::vector<std::size_t> order(methods);
  std::iota(order.begin(), order.end(), 0u);
  RandomStream<float> random(seed, std::uint32_t(round));
  for (std::size_t i = methods; i > 1; --i)
    std::swap(order[i - 1], order[std::min(std::size_t(random.next() * float(i)), i - 1)]);
  return order;
}

// The length of the longest single pass; the passes have 1, 2, 4, ... samples up to it.
int longest_pass(double samples) { return int(std::clamp(samples / 2, 4.0, 1024.0)); }

ConvergenceRun run_convergence(const ComparedMethod& compared_method, const ComparisonSettings& settings,
                               const Reference& reference, int max_samples, int repeat, RenderObserver& observer) {
  ConvergenceRun run;
  if (!settings.slopes) return run;
  RenderSettings s = settings_for(compared_method, settings);
  s.image.seed = mix_bits(settings.render.image.seed + 0x85ebca6bu * std::uint32_t(repeat + 1));
  for (int k = 1, level = 0; k <= max_samples && !observer.stop_requested(); k *= 2, ++level) {
    s.plan = {k, 1, convergence_pass + level};
    const RenderResult r = render(compared_method.integrator, s, observer);
    if (r.interrupted) break;
    run.samples.push_back(k), run.seconds.push_back(seconds_that_count(r, settings));
    run.mse.push_back(squared_error(mean_of(r.film), reference));
  }
  return run;
}

int attribution_passes(double samples, const PassPlan& plan) {
  return std::max(2, int(std::min(samples / plan.samples_per_pass / 4, 64.0)));
}

// Attributes the variance of passes like those of a turn to layers. It repeats a quarter of the passes, because the
// layers must not lengthen the measured time of the turns.
std::optional<AttributionRound> run_attribution(const ComparedMethod& compared_method,
                                                const ComparisonSettings& settings, PassPlan plan, int round,
                                                RenderObserver& observer, PixelShares& pixels) {
  RenderSettings s = settings_for(compared_method, settings);
  s.plan = plan;
  s.plan.first_pass = attribution_pass;
  s.image.seed = mix_bits(settings.render.image.seed + 0xc2b2ae35u * std::uint32_t(round + 1));
  s.image.layers = compared_method.layers;
  s.image.layers->spread = true;
  const RenderResult r = render(compared_method.integrator, s, observer);
  if (r.interrupted) return std::nullopt;
  return attribute(r.film, pixels);
}

void add_film(const Film& film, MethodState& method) {
  const PixelBounds& b = film.bounds();
  method.pixels.resize(std::size_t(b.area()));
  std::size_t i = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) method.pixels[i++].merge(film.pixel(x, y));
  method.passes += film.image().passes;
}

std::vector<float> luminance_of(const Film& film) {
  const PixelBuffer mean = mean_of(film);
  std::vector<float> shown;
  for (std::size_t p = 0; p < mean.pixel_count(); ++p)
    shown.push_back(luminance(Rgb{{mean.values[3 * p], mean.values[3 * p + 1], mean.values[3 * p + 2]}}));
  return shown;
}

double samples_a_pixel(const Film& film) {
  double samples = 0;
  const PixelBounds& b = film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) samples += film.samples(x, y);
  return samples / double(b.area());
}

// Samples per pixel of the parts of a repeat, in proportion to their time: the turn, the single passes of increasing
// length, and the attribution, whose layers make a sample more expensive.
struct RepeatParts {
  double turn = 0, slopes = 0, attribution = 0;
  double all() const { return turn + slopes + attribution; }
};
RepeatParts parts_of_repeat(const ComparedMethod& compared_method, const ComparisonSettings& settings, PassPlan plan,
                            double samples) {
  constexpr double price_of_layers = 1.3;
  RepeatParts parts;
  parts.turn = samples;
  if (settings.slopes) parts.slopes = 2.0 * std::bit_floor(unsigned(longest_pass(samples))) - 1;
  if (compared_method.layers)
    parts.attribution = price_of_layers * attribution_passes(samples, plan) * plan.samples_per_pass;
  return parts;
}

// The results of one repeat of one method.
struct Gathered {
  RenderResult turn;
  Repeat repeat;
  ConvergenceRun convergence;
  std::optional<AttributionRound> attribution;
};

void add_repeat(Gathered gathered, MethodState& method) {
  const Film& film = gathered.turn.film;
  if (gathered.attribution) method.attribution.push_back(*std::move(gathered.attribution));
  method.repeats.push_back(gathered.repeat);
  method.convergence.push_back(std::move(gathered.convergence));
  method.luminance.push_back(luminance_of(film));
  add_film(film, method);
  method.non_finite += film.non_finite();
}

// One complete repeat of one method; false if it was stopped, and then it does not count.
bool run_repeat(const ComparedMethod& compared_method, const ComparisonSettings& settings, const Reference& reference,
                int round, const PieceProgress& piece, MethodState& method) {
  // With a time budget, the number of samples of a turn is unknown before the first one.
  const double before = method.repeats.empty() ? settings.samples : method.repeats.back().samples;
  const RepeatParts share = parts_of_repeat(compared_method, settings, method.plan, before);
  const double turn_ends = share.turn / share.all(), slopes_end = turn_ends + share.slopes / share.all();
  PartOfPiece turn(piece, 0, turn_ends), slopes(piece, turn_ends, slopes_end), layers(piece, slopes_end, 1);

  Gathered g{take_turn(compared_method, settings, method.plan, round, turn), {}, {}, {}};
  if (g.turn.interrupted) return false;
  g.repeat = measure(g.turn.film, reference);
  g.repeat.samples = samples_a_pixel(g.turn.film);
  g.repeat.seconds = seconds_that_count(g.turn, settings);
  g.repeat.all_seconds = g.turn.seconds, g.repeat.warm_up = g.turn.warm_up;
  g.repeat.rays = double(g.turn.rays.all());
  g.convergence = run_convergence(compared_method, settings, reference, longest_pass(g.repeat.samples), round, slopes);
  if (piece.watch().stopped()) return false;
  if (compared_method.layers) {
    const PassPlan plan{method.plan.samples_per_pass, attribution_passes(g.repeat.samples, method.plan)};
    g.attribution = run_attribution(compared_method, settings, plan, round, layers, method.pixel_shares);
    if (!g.attribution) return false;
  }
  add_repeat(std::move(g), method);
  return true;
}

}  // namespace

RenderSettings settings_for(const ComparedMethod& compared_method, const ComparisonSettings& settings) {
  RenderSettings s = settings.render;
  s.image.sampler = compared_method.sampler;
  return s;
}

double seconds_that_count(const RenderResult& r, const ComparisonSettings& settings) {
  return settings.warm_up_counts ? r.seconds : r.shown_seconds();
}

double expected_repeat_seconds(const ComparedMethod& compared_method, const ComparisonSettings& settings, PassPlan plan,
                               double sample_seconds) {
  double samples = plan.samples();
  if (settings.seconds) samples = std::max(*settings.seconds / settings.repeats / sample_seconds, 1.0);
  return parts_of_repeat(compared_method, settings, plan, samples).all() * sample_seconds;
}

ComparisonState begin_comparison(const std::vector<ComparedMethod>& compared_methods, Reference reference,
                                 const ComparisonSettings& settings) {
  ComparisonState state;
  state.reference = std::move(reference);
  RenderObserver silent;
  for (const ComparedMethod& c : compared_methods) {
    MethodState method;
    method.plan =
        settings.seconds ? plan_within(settings, c, silent) : plan_passes(c.integrator, settings.samples, c.sampler);
    state.methods.push_back(std::move(method));
  }
  return state;
}

bool run_rounds(const std::vector<ComparedMethod>& compared_methods, const ComparisonSettings& settings, int rounds,
                const ComparisonWatch& watch, ComparisonState& state) {
  // An interrupted round is completed first.
  int first = std::numeric_limits<int>::max();
  for (const MethodState& m : state.methods) first = std::min(first, int(m.repeats.size()));
  for (int round = first; round < first + rounds; ++round)
    for (std::size_t i : order_of_round(compared_methods.size(), settings.render.image.seed, round)) {
      MethodState& method = state.methods[i];
      if (int(method.repeats.size()) > round) continue;
      if (watch.stopped()) return false;
      const PieceProgress piece(
          watch, {fmt::format("repeat {} of {}, {}", round + 1, first + rounds, compared_methods[i].shown_name()),
                  method.repeat_seconds});
      if (!run_repeat(compared_methods[i], settings, state.reference, round, piece, method)) return false;
    }
  return true;
}

ComparisonResult run_comparison(const std::vector<ComparedMethod>& compared_methods, Reference reference,
                                const ComparisonSettings& settings, const ComparisonWatch& watch) {
  ComparisonState state = begin_comparison(compared_methods, std::move(reference), settings);
  const bool whole = run_rounds(compared_methods, settings, settings.repeats, watch, state);
  ComparisonResult result = result_of(compared_methods, state, settings);
  result.interrupted = !whole;
  return result;
}

}  // namespace montelux::lab
