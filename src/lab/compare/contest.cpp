#include "lab/compare/contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "lab/compare/measure.h"
#include "mc/confidence.h"
#include "mc/random.h"

namespace montelux::lab {

namespace {

using Clock = std::chrono::steady_clock;

// Passes that are told apart by what they serve, so that no two ever share numbers.
constexpr int pilot_pass = 3 << 28, reference_pass = 1 << 28, convergence_pass = 1 << 29;

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
  double cost = 0;            // mse x seconds
  double sample_seconds = 0;  // for one sample of every pixel
};

Pilot take_pilot(const Contestant& contestant, const ContestSettings& settings, const ContestWatch& watch) {
  constexpr int passes = 8;
  RenderSettings s = settings_for(contestant, settings);
  s.plan = {1, passes}, s.first_pass = pilot_pass;
  Stopper stopper(watch);
  const RenderResult r = render(*contestant.integrator, s, stopper);
  return {r.film.error(s.bounds).mse * r.seconds, r.seconds / passes};
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
  return {render(*contestant.integrator, s, stopper), plan};
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

// Squared error of single passes of growing length, for the slopes.
struct ConvergenceRun {
  std::vector<double> samples, mse, seconds;
};

ConvergenceRun run_convergence(const Contestant& contestant, const ContestSettings& settings,
                               const Reference& reference, int most_samples, int repeat, const ContestWatch& watch) {
  ConvergenceRun run;
  RenderSettings s = settings_for(contestant, settings);
  s.seed = mix_bits(settings.render.seed + 0x85ebca6bu * std::uint32_t(repeat + 1));
  Stopper stopper(watch);
  for (int k = 1, level = 0; k <= most_samples && !stopper.stop_requested(); k *= 2, ++level) {
    s.plan = {k, 1}, s.first_pass = convergence_pass + level;
    const RenderResult r = render(*contestant.integrator, s, stopper);
    if (r.interrupted) break;
    run.samples.push_back(k), run.seconds.push_back(r.seconds);
    run.mse.push_back(squared_error(mean_of(r.film), reference));
  }
  return run;
}

void summarize_convergence(const std::vector<ConvergenceRun>& runs, double confidence, MethodResult& method) {
  std::vector<double> by_samples, by_time;
  std::size_t levels = runs.empty() ? 0 : runs.front().samples.size();
  for (const ConvergenceRun& run : runs) levels = std::min(levels, run.samples.size());
  for (std::size_t level = 0; level < levels; ++level) {
    std::vector<double> mse, seconds;
    for (const ConvergenceRun& run : runs) mse.push_back(run.mse[level]), seconds.push_back(run.seconds[level]);
    method.convergence.push_back(
        {runs.front().samples[level], measured(mse, confidence), measured(seconds, confidence)});
  }
  if (levels < 3) return;
  for (const ConvergenceRun& run : runs) {
    by_samples.push_back(log_slope(run.samples, run.mse));
    by_time.push_back(log_slope(run.seconds, run.mse));
  }
  method.slope_by_samples = measured(by_samples, confidence);
  method.slope_by_time = measured(by_time, confidence);
}

std::vector<double> column(const MethodResult& method, double (*value)(const Repeat&)) {
  std::vector<double> values;
  for (const Repeat& r : method.repeats) values.push_back(value(r));
  return values;
}
double efficiency_of(const Repeat& r) { return 1 / (r.mse * r.seconds); }
double relative_efficiency_of(const Repeat& r) { return 1 / (r.relative_mse * r.seconds); }

void summarize(MethodResult& m, double confidence) {
  const auto of = [&](double (*value)(const Repeat&)) { return measured(column(m, value), confidence); };
  m.seconds = of([](const Repeat& r) { return r.seconds; });
  m.rays = of([](const Repeat& r) { return r.rays; });
  m.samples = of([](const Repeat& r) { return r.samples; });
  m.mse = of([](const Repeat& r) { return r.mse; });
  m.relative_mse = of([](const Repeat& r) { return r.relative_mse; });
  m.flip = of([](const Repeat& r) { return r.flip; });
  m.variance = of([](const Repeat& r) { return r.variance; });
  m.coverage = of([](const Repeat& r) { return r.coverage; });
  m.efficiency = of(efficiency_of);
  m.relative_efficiency = of(relative_efficiency_of);
}

// The mean over pixels of the squared bias. The errors of two repeats are independent, so their product has the squared
// bias for its mean, and the reference's variance, which is taken off. The jackknife over repeats gives its error.
Measured squared_bias(const std::vector<std::vector<float>>& repeats, const Reference& reference, double confidence) {
  const double n = double(repeats.size());
  if (n < 3) return measured({}, confidence);
  constexpr double weights[] = {0.2126, 0.7152, 0.0722};
  const std::size_t pixels = reference.mean.pixel_count();
  std::vector<double> own(repeats.size()), with_sum(repeats.size());
  double all = 0, known = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    double truth = 0, deviation = 0, sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      truth += weights[c] * double(reference.mean.values[3 * p + c]);
      deviation += weights[c] * std::sqrt(double(reference.variance.values[3 * p + c]));
    }
    for (const auto& repeat : repeats) sum += double(repeat[p]) - truth;
    for (std::size_t r = 0; r < repeats.size(); ++r) {
      const double off = double(repeats[r][p]) - truth;
      own[r] += off * off / double(pixels), with_sum[r] += off * sum / double(pixels);
    }
    all += sum * sum / double(pixels), known += deviation * deviation / double(pixels);
  }
  double squares = 0;
  for (double x : own) squares += x;
  const double whole = (all - squares) / (n * (n - 1)) - known;
  // Without repeat r: the sum of the others' errors, and their squares.
  std::vector<double> pseudo;
  for (std::size_t r = 0; r < repeats.size(); ++r) {
    const double rest = all - 2 * with_sum[r] + own[r] - (squares - own[r]);
    pseudo.push_back(n * whole - (n - 1) * (rest / ((n - 1) * (n - 2)) - known));
  }
  return measured(pseudo, confidence);
}

// The film of all repeats against the reference: is the mean another?
void summarize_film(const Film& film, const Reference& reference, MethodResult& m) {
  m.mean = mean_of(film);
  m.standard_error = variance_of(film);
  m.bias_squared = squared_bias(m.luminance, reference, 0.95);
  for (float& v : m.standard_error.values) v = std::sqrt(v);
  PixelBuffer reference_error = reference.variance;
  for (float& v : reference_error.values) v = std::sqrt(v);
  m.bias = welch_test({m.mean, m.standard_error, double(film.image().passes - 1)},
                      {reference.mean, reference_error, reference.degrees_of_freedom}, 0.01);
  m.non_finite = film.non_finite();
}

PairVerdict judge(const ContestResult& result, std::size_t a, std::size_t b, double confidence) {
  const MethodResult &first = result.methods[a], &second = result.methods[b];
  PairVerdict v;
  v.first = a, v.second = b;
  v.ratio = measured_ratio(column(first, efficiency_of), column(second, efficiency_of), confidence);
  v.relative_ratio =
      measured_ratio(column(first, relative_efficiency_of), column(second, relative_efficiency_of), confidence);
  v.decided = v.ratio.count >= 2 && (v.ratio.low > 1 || v.ratio.high < 1);
  if (!v.decided && v.ratio.count >= 2) {
    // The half width shrinks with the root of the number of repeats, and must come below the distance from one.
    const double half = 0.5 * std::log(v.ratio.high / v.ratio.low), distance = std::abs(std::log(v.ratio.mean));
    v.times_longer = distance > 0 ? (half / distance) * (half / distance) : std::numeric_limits<double>::infinity();
  }
  return v;
}

}  // namespace

bool differs_from_reference(const MethodResult& m) {
  const Measured& b = m.bias_squared;
  const bool by_pixel = b.count >= 3 && b.mean > student_t_quantile(0.9995, b.count - 1.0) * b.standard_error;
  return m.bias.image.differs || by_pixel;
}

double expected_smallest_mse(const std::vector<Contestant>& contestants, const ContestSettings& settings,
                             const ContestWatch& watch) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Contestant& contestant : contestants) {
    const Pilot pilot = take_pilot(contestant, settings, watch);
    const double seconds =
        settings.seconds ? *settings.seconds / settings.repeats : pilot.sample_seconds * settings.samples;
    if (pilot.cost > 0) smallest = std::min(smallest, pilot.cost / seconds);
  }
  return smallest;
}

Reference make_reference(const std::vector<Contestant>& contestants, const std::vector<std::size_t>& may_serve,
                         const ContestSettings& settings, double goal, const ContestWatch& watch) {
  const auto start = Clock::now();
  const Contestant* best = &contestants[may_serve.front()];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i : may_serve)
    if (const Pilot pilot = take_pilot(contestants[i], settings, watch); pilot.cost < least)
      least = pilot.cost, best = &contestants[i];

  RenderSettings s = settings_for(*best, settings);
  s.seed = mix_bits(settings.render.seed ^ 0x5bd1e995u);
  constexpr int samples_per_pass = 16, most_passes = 1 << 16;
  Film film(s.bounds);
  int passes = 0;
  Stopper stopper(watch);
  for (int more = 16; !stopper.stop_requested(); more = passes) {
    s.plan = {samples_per_pass, more}, s.first_pass = reference_pass + passes;
    film.merge(render(*best->integrator, s, stopper).film);
    passes += more;
    const double variance = film.error(s.bounds).mse;
    if (watch.progress)
      watch.progress(std::min(goal / variance, 1.0), std::chrono::duration<double>(Clock::now() - start).count(),
                     fmt::format("reference by {}", best->label));
    if (!(variance > goal) || passes >= most_passes) break;
  }
  return {mean_of(film), variance_of(film), double(passes - 1),
          fmt::format("{}, {} samples a pixel", best->text, passes * samples_per_pass)};
}

ContestResult run_contest(const std::vector<Contestant>& contestants, Reference reference,
                          const ContestSettings& settings, const ContestWatch& watch) {
  const auto start = Clock::now();
  ContestResult result;
  result.reference = std::move(reference);
  std::vector<PassPlan> plans;
  std::vector<Film> films;
  for (const Contestant& c : contestants) {
    MethodResult method;
    method.contestant = c;
    result.methods.push_back(std::move(method));
    films.emplace_back(settings.render.bounds);
    plans.push_back(settings.seconds
                        ? plan_for_time(*c.integrator, settings_for(c, settings), *settings.seconds / settings.repeats)
                        : plan_passes(settings.samples, c.sampler));
  }
  std::vector<std::vector<ConvergenceRun>> convergence(contestants.size());
  std::vector<std::vector<double>> squares(contestants.size());
  const std::size_t turns = contestants.size() * std::size_t(settings.repeats);
  std::size_t done = 0;
  for (int round = 0; round < settings.repeats && !result.interrupted; ++round)
    for (std::size_t i : order_of_round(contestants.size(), settings.render.seed, round)) {
      if (watch.stop && watch.stop()) result.interrupted = true;
      if (result.interrupted) break;
      if (watch.progress)
        watch.progress(double(done) / double(turns), std::chrono::duration<double>(Clock::now() - start).count(),
                       fmt::format("round {}, {}", round + 1, contestants[i].label));
      const Turn turn = take_turn(contestants[i], settings, plans[i], round, watch);
      if (turn.result.interrupted) {
        result.interrupted = true;
        break;
      }
      const Film& film = turn.result.film;
      Repeat repeat = measure(film, result.reference);
      double samples = 0;
      const PixelBounds& b = film.bounds();
      for (int y = b.y0; y < b.y1; ++y)
        for (int x = b.x0; x < b.x1; ++x) samples += film.samples(x, y);
      repeat.samples = samples / double(b.area());
      repeat.seconds = turn.result.seconds, repeat.rays = double(turn.result.rays.all());
      result.methods[i].repeats.push_back(repeat);

      const PixelBuffer mean = mean_of(film);
      std::vector<float>& shown = result.methods[i].luminance.emplace_back();
      for (std::size_t p = 0; p < mean.pixel_count(); ++p)
        shown.push_back(luminance(Rgb{{mean.values[3 * p], mean.values[3 * p + 1], mean.values[3 * p + 2]}}));
      const auto longest = int(std::clamp(repeat.samples / 2, 4.0, 1024.0));
      convergence[i].push_back(run_convergence(contestants[i], settings, result.reference, longest, round, watch));
      films[i].merge(film);
      ++done;
    }

  double smallest_mse = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    MethodResult& method = result.methods[i];
    if (method.repeats.empty()) continue;
    summarize(method, settings.confidence);
    summarize_convergence(convergence[i], settings.confidence, method);
    summarize_film(films[i], result.reference, method);
    if (method.mse.mean > 0) smallest_mse = std::min(smallest_mse, method.mse.mean);
  }
  result.reference_share = mean_value(result.reference.variance) / smallest_mse;
  for (std::size_t a = 0; a < contestants.size(); ++a)
    for (std::size_t b = a + 1; b < contestants.size(); ++b)
      result.verdicts.push_back(judge(result, a, b, settings.confidence));
  return result;
}

}  // namespace montelux::lab
