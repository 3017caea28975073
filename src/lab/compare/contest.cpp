#include "lab/compare/contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lab/compare/measure.h"
#include "mc/confidence.h"
#include "mc/random.h"

namespace montelux::lab {

namespace {

// Passes that are told apart by what they serve, so that no two ever share numbers.
constexpr int pilot_pass = 3 << 28, reference_pass = 1 << 28, convergence_pass = 1 << 29, attribution_pass = 5 << 28;

// Passes on the wish to stop into a render.
class Stopper final : public RenderObserver {
 public:
  explicit Stopper(const ContestWatch& watch) : watch_(watch) {}
  bool stop_requested() override { return watch_.stop && watch_.stop(); }

 private:
  const ContestWatch& watch_;
};

RenderSettings settings_for(const Contestant& contestant, const ContestSettings& settings) {
  RenderSettings s = settings.render;
  s.sampler = contestant.sampler;
  s.seconds.reset();
  return s;
}

// What a short render says of a method.
struct Pilot {
  double mse = 0, samples = 0;
  double seconds = 0, all_seconds = 0;  // that count, and all
};

double seconds_that_count(const RenderResult& r, const ContestSettings& settings) {
  return settings.render.warm_up_counts ? r.seconds : r.shown_seconds();
}

Pilot take_pilot(const Contestant& contestant, const ContestSettings& settings, const ContestWatch& watch) {
  constexpr int passes = 8;
  RenderSettings s = settings_for(contestant, settings);
  s.plan = {1, passes}, s.first_pass = pilot_pass;
  Stopper stopper(watch);
  const RenderResult r = render(contestant.integrator, s, stopper);
  return {r.film.mse(), passes, seconds_that_count(r, settings), r.seconds};
}

// One turn of one method.
struct Turn {
  RenderResult result;
  PassPlan plan;
};

Turn take_turn(const Contestant& contestant, const ContestSettings& settings, PassPlan plan, int repeat,
               const ContestWatch& watch) {
  RenderSettings s = settings_for(contestant, settings);
  s.plan = plan;
  s.seed = mix_bits(settings.render.seed + 0x9e3779b9u * std::uint32_t(repeat + 1));
  if (settings.seconds) s.seconds = *settings.seconds / settings.repeats;
  Stopper stopper(watch);
  return {render(contestant.integrator, s, stopper), plan};
}

// The order of the methods in one round: drawn afresh, so that none is always the first.
std::vector<std::size_t> order_of_round(std::size_t methods, std::uint32_t seed, int round) {
  std::vector<std::size_t> order(methods);
  std::iota(order.begin(), order.end(), 0u);
  RandomStream<float> random(seed, std::uint32_t(round));
  for (std::size_t i = methods; i > 1; --i)
    std::swap(order[i - 1], order[std::min(std::size_t(random.next() * float(i)), i - 1)]);
  return order;
}

ConvergenceRun run_convergence(const Contestant& contestant, const ContestSettings& settings,
                               const Reference& reference, int most_samples, int repeat, const ContestWatch& watch) {
  ConvergenceRun run;
  if (!settings.slopes) return run;
  RenderSettings s = settings_for(contestant, settings);
  s.seed = mix_bits(settings.render.seed + 0x85ebca6bu * std::uint32_t(repeat + 1));
  Stopper stopper(watch);
  for (int k = 1, level = 0; k <= most_samples && !stopper.stop_requested(); k *= 2, ++level) {
    s.plan = {k, 1}, s.first_pass = convergence_pass + level;
    const RenderResult r = render(contestant.integrator, s, stopper);
    if (r.interrupted) break;
    run.samples.push_back(k), run.seconds.push_back(seconds_that_count(r, settings));
    run.mse.push_back(squared_error(mean_of(r.film), reference));
  }
  return run;
}

// Which layers the variance of passes like those of a turn comes from. A quarter of its passes tell that: the layers
// are gathered apart from the turns, whose time they must not lengthen.
std::optional<AttributionRound> run_attribution(const Contestant& contestant, const ContestSettings& settings,
                                                PassPlan plan, const Repeat& repeat, int round,
                                                const ContestWatch& watch, PixelShares& pixels) {
  RenderSettings s = settings_for(contestant, settings);
  const int passes = int(std::min(repeat.samples / plan.samples_per_pass / 4, 64.0));
  s.plan = {plan.samples_per_pass, std::max(2, passes)};
  s.first_pass = attribution_pass;
  s.seed = mix_bits(settings.render.seed + 0xc2b2ae35u * std::uint32_t(round + 1));
  s.layers = contestant.layers;
  s.layers->spread = true;
  Stopper stopper(watch);
  const RenderResult r = render(contestant.integrator, s, stopper);
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

// One repeat of one method with all that belongs to it; false where it was stopped, and then nothing of it counts.
bool run_repeat(const Contestant& contestant, const ContestSettings& settings, const Reference& reference, int round,
                const ContestWatch& watch, MethodState& method) {
  const Turn turn = take_turn(contestant, settings, method.plan, round, watch);
  if (turn.result.interrupted) return false;
  const Film& film = turn.result.film;
  Repeat repeat = measure(film, reference);
  repeat.samples = samples_a_pixel(film);
  repeat.seconds = seconds_that_count(turn.result, settings);
  repeat.all_seconds = turn.result.seconds, repeat.warm_up = turn.result.warm_up;
  repeat.rays = double(turn.result.rays.all());
  const auto longest = int(std::clamp(repeat.samples / 2, 4.0, 1024.0));
  const ConvergenceRun convergence = run_convergence(contestant, settings, reference, longest, round, watch);
  if (watch.stop && watch.stop()) return false;
  if (contestant.layers) {
    const auto attribution =
        run_attribution(contestant, settings, method.plan, repeat, round, watch, method.pixel_shares);
    if (!attribution) return false;
    method.attribution.push_back(*attribution);
  }
  method.repeats.push_back(repeat);
  method.convergence.push_back(convergence);
  method.luminance.push_back(luminance_of(film));
  add_film(film, method);
  method.non_finite += film.non_finite();
  return true;
}

}  // namespace

double expected_smallest_mse(const std::vector<Contestant>& contestants, const ContestSettings& settings,
                             const ContestWatch& watch) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Contestant& contestant : contestants) {
    const Pilot pilot = take_pilot(contestant, settings, watch);
    const double seconds =
        settings.seconds ? *settings.seconds / settings.repeats : pilot.seconds / pilot.samples * settings.samples;
    if (const double cost = pilot.mse * pilot.seconds; cost > 0) smallest = std::min(smallest, cost / seconds);
  }
  return smallest;
}

Reference make_reference(const std::vector<Contestant>& contestants, const std::vector<std::size_t>& may_serve,
                         const ContestSettings& settings, double goal, const ContestWatch& watch) {
  const Stopwatch since_start(settings.render.clock);
  const Contestant* best = &contestants[may_serve.front()];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i : may_serve) {
    const Pilot pilot = take_pilot(contestants[i], settings, watch);
    if (const double cost = pilot.mse * pilot.all_seconds; cost < least) least = cost, best = &contestants[i];
  }

  RenderSettings s = settings_for(*best, settings);
  s.seed = mix_bits(settings.render.seed ^ 0x5bd1e995u);
  constexpr int samples_per_pass = 16, most_passes = 1 << 16;
  Film film(s.bounds);
  int passes = 0;
  Stopper stopper(watch);
  for (int more = 16; !stopper.stop_requested(); more = passes) {
    s.plan = {samples_per_pass, more}, s.first_pass = reference_pass + passes;
    film.merge(render(best->integrator, s, stopper).film);
    passes += more;
    const double variance = film.mse();
    if (watch.progress)
      watch.progress(std::min(goal / variance, 1.0), since_start.seconds(),
                     fmt::format("reference by {}", best->label));
    if (!(variance > goal) || passes >= most_passes) break;
  }
  const ImageEstimate image = film.image();
  std::array<double, 3> variance_of_image{};
  for (std::size_t c = 0; c < 3; ++c) variance_of_image[c] = image.standard_error[c] * image.standard_error[c];
  return {mean_of(film), variance_of(film), double(passes - 1), variance_of_image,
          fmt::format("{}, {} samples a pixel", best->text, passes * samples_per_pass)};
}

ContestState begin_contest(const std::vector<Contestant>& contestants, Reference reference,
                           const ContestSettings& settings) {
  ContestState state;
  state.reference = std::move(reference);
  RenderObserver silent;
  for (const Contestant& c : contestants) {
    MethodState method;
    method.plan =
        settings.seconds
            ? plan_for_time(c.integrator, settings_for(c, settings), *settings.seconds / settings.repeats, silent).plan
            : plan_passes(c.integrator, settings.samples, c.sampler);
    state.methods.push_back(std::move(method));
  }
  return state;
}

bool run_rounds(const std::vector<Contestant>& contestants, const ContestSettings& settings, int rounds,
                const ContestWatch& watch, ContestState& state) {
  const Stopwatch since_start(settings.render.clock);
  // A round that was cut short is ended first.
  int first = std::numeric_limits<int>::max();
  for (const MethodState& m : state.methods) first = std::min(first, int(m.repeats.size()));
  const double turns = double(contestants.size()) * rounds;
  double done = 0;
  for (int round = first; round < first + rounds; ++round)
    for (std::size_t i : order_of_round(contestants.size(), settings.render.seed, round)) {
      if (int(state.methods[i].repeats.size()) > round) continue;
      if (watch.stop && watch.stop()) return false;
      if (watch.progress)
        watch.progress(done / turns, since_start.seconds(),
                       fmt::format("round {}, {}", round + 1, contestants[i].label));
      if (!run_repeat(contestants[i], settings, state.reference, round, watch, state.methods[i])) return false;
      ++done;
    }
  return true;
}

ContestResult run_contest(const std::vector<Contestant>& contestants, Reference reference,
                          const ContestSettings& settings, const ContestWatch& watch) {
  ContestState state = begin_contest(contestants, std::move(reference), settings);
  const bool whole = run_rounds(contestants, settings, settings.repeats, watch, state);
  ContestResult result = result_of(contestants, state, settings);
  result.interrupted = !whole;
  return result;
}

}  // namespace montelux::lab
