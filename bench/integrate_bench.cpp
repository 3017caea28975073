// Seconds to a relative error on Genz's families, against the GNU Scientific Library: the same C++ integrands, one
// thread. The error is the true one, root mean square over repeats with different seeds; the time is the median.
// Budgets double until the error is below the target; between two budgets both are interpolated on logarithmic axes.
//
// usage: bench_integrate [--repeats N] [--cap SECONDS] [--methods TEXT,...] [--families 0,1,...] [--dimensions 2,5,10]
#include <gsl/gsl_monte_miser.h>
#include <gsl/gsl_monte_plain.h>
#include <gsl/gsl_monte_vegas.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>

#include "genz.h"
#include "lab/integral/integrate.h"

namespace {

using namespace montelux;
using test::Genz;

// Processor time of this thread: what others do on the machine does not count.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Outcome {
  double mean, claimed;
};
using Algorithm = std::function<Outcome(const Genz&, std::uint64_t samples, std::uint32_t seed)>;

double call_genz(double* x, std::size_t, void* genz) { return (*static_cast<const Genz*>(genz))(x); }

// GSL's state for one integral; the generator is the fastest of its good ones.
struct GslCall {
  gsl_rng* rng = gsl_rng_alloc(gsl_rng_taus2);
  std::vector<double> low, high;
  gsl_monte_function function;
  GslCall(const Genz& g, std::uint32_t seed)
      : low(g.dimension(), 0.0), high(g.dimension(), 1.0), function{&call_genz, g.dimension(), const_cast<Genz*>(&g)} {
    gsl_rng_set(rng, seed + 1);
  }
  ~GslCall() { gsl_rng_free(rng); }
};

Outcome gsl_plain(const Genz& g, std::uint64_t samples, std::uint32_t seed) {
  GslCall call(g, seed);
  gsl_monte_plain_state* state = gsl_monte_plain_alloc(g.dimension());
  Outcome o{};
  gsl_monte_plain_integrate(&call.function, call.low.data(), call.high.data(), g.dimension(), samples, call.rng, state,
                            &o.mean, &o.claimed);
  gsl_monte_plain_free(state);
  return o;
}

Outcome gsl_miser(const Genz& g, std::uint64_t samples, std::uint32_t seed) {
  GslCall call(g, seed);
  gsl_monte_miser_state* state = gsl_monte_miser_alloc(g.dimension());
  Outcome o{};
  gsl_monte_miser_integrate(&call.function, call.low.data(), call.high.data(), g.dimension(), samples, call.rng, state,
                            &o.mean, &o.claimed);
  gsl_monte_miser_free(state);
  return o;
}

// With `warm_up`, a sixth of the samples goes into a first call whose result is dropped, as in GSL's manual; without it
// the five default iterations have all.
Outcome gsl_vegas(const Genz& g, std::uint64_t samples, std::uint32_t seed, bool warm_up) {
  GslCall call(g, seed);
  gsl_monte_vegas_state* state = gsl_monte_vegas_alloc(g.dimension());
  Outcome o{};
  const auto integrate = [&](std::uint64_t n) {
    gsl_monte_vegas_integrate(&call.function, call.low.data(), call.high.data(), g.dimension(),
                              std::max<std::uint64_t>(2, n / 5), call.rng, state, &o.mean, &o.claimed);
  };
  if (warm_up) {
    integrate(samples / 6);
    gsl_monte_vegas_params parameters;
    gsl_monte_vegas_params_get(state, &parameters);
    parameters.stage = 1;
    gsl_monte_vegas_params_set(state, &parameters);
    integrate(samples - samples / 6);
  } else {
    integrate(samples);
  }
  gsl_monte_vegas_free(state);
  return o;
}

Algorithm ours(const std::string& text) {
  const lab::Method method = lab::parse_method(text).value();
  return [method](const Genz& g, std::uint64_t samples, std::uint32_t seed) {
    const lab::IntegralResult r =
        lab::integrate({.integrand = g.integrand()}, method, {.samples = samples}, {.seed = seed + 1});
    return Outcome{r.mean, r.standard_error};
  };
}

struct Rung {
  double samples, seconds, error, claimed;
};
struct Limits {
  int repeats = 8;
  double cap = 0.02;  // seconds of one run
  std::uint64_t largest = std::uint64_t(1) << 27;
};

Rung measure(const Algorithm& algorithm, const Genz& g, std::uint64_t samples, const Limits& limits) {
  const double truth = g.integral();
  std::vector<double> seconds;
  double squares = 0, claimed = 0;
  for (int i = 0; i < limits.repeats; ++i) {
    const double start = processor_seconds();
    const Outcome o = algorithm(g, samples, std::uint32_t(i));
    seconds.push_back(processor_seconds() - start);
    squares += (o.mean - truth) * (o.mean - truth), claimed += o.claimed * o.claimed;
  }
  std::nth_element(seconds.begin(), seconds.begin() + limits.repeats / 2, seconds.end());
  return {double(samples), seconds[std::size_t(limits.repeats / 2)],
          std::sqrt(squares / limits.repeats) / std::abs(truth), std::sqrt(claimed / limits.repeats) / std::abs(truth)};
}

std::vector<Rung> climb(const Algorithm& algorithm, const Genz& g, double target, const Limits& limits) {
  std::vector<Rung> rungs;
  for (std::uint64_t n = 256; n <= limits.largest; n *= 2) {
    rungs.push_back(measure(algorithm, g, n, limits));
    if (rungs.back().error < target && rungs.size() > 1 && rungs[rungs.size() - 2].error < target) break;
    if (rungs.back().seconds > limits.cap) break;
  }
  return rungs;
}

struct Time {
  double seconds;
  bool extrapolated;
};

// The first budget from which on the error stays below the target.
Time time_to(double target, const std::vector<Rung>& rungs) {
  std::size_t k = rungs.size();
  while (k > 0 && rungs[k - 1].error < target) --k;
  if (k == 0) return {rungs.front().seconds, false};
  const Rung& above = rungs[k - 1];
  if (k == rungs.size()) return {above.seconds * std::pow(above.error / target, 2), true};
  const Rung& below = rungs[k];
  const double part = std::log(above.error / target) / std::log(above.error / below.error);
  return {above.seconds * std::pow(below.seconds / above.seconds, part), false};
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace

int main(int argc, char** argv) {
  Limits limits;
  std::vector<std::string> methods{"auto"}, families{"0", "1", "2", "3", "4", "5"}, dimensions{"2", "5", "10"};
  bool gsl = true, verbose = false;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
    if (name == "--repeats") limits.repeats = std::atoi(value.c_str()), ++i;
    if (name == "--cap") limits.cap = std::atof(value.c_str()), ++i;
    if (name == "--methods") methods = split(value, ';'), ++i;
    if (name == "--families") families = split(value, ','), ++i;
    if (name == "--dimensions") dimensions = split(value, ','), ++i;
    if (name == "--no-gsl") gsl = false;
    if (name == "--verbose") verbose = true;
  }
  std::vector<std::pair<std::string, Algorithm>> algorithms;
  if (gsl) {
    algorithms.emplace_back("gsl plain", gsl_plain);
    algorithms.emplace_back("gsl miser", gsl_miser);
    algorithms.emplace_back("gsl vegas",
                            [](const Genz& g, std::uint64_t n, std::uint32_t s) { return gsl_vegas(g, n, s, false); });
    algorithms.emplace_back("gsl vegas warm",
                            [](const Genz& g, std::uint64_t n, std::uint32_t s) { return gsl_vegas(g, n, s, true); });
  }
  for (const std::string& text : methods)
    if (!text.empty()) algorithms.emplace_back(text, ours(text));

  std::printf("| family | d | error |");
  for (const auto& [name, _] : algorithms) std::printf(" %s |", name.c_str());
  std::printf("\n| --- | --- | --- |");
  for (std::size_t i = 0; i < algorithms.size(); ++i) std::printf(" --- |");
  std::printf("\n");
  constexpr std::array<double, 2> targets{1e-3, 1e-4};
  std::vector<double> log_sums(algorithms.size()), worst(algorithms.size());
  double cells = 0;
  for (const std::string& family : families)
    for (const std::string& dimension : dimensions) {
      const Genz g =
          Genz::make(test::GenzFamily(std::atoi(family.c_str())), std::size_t(std::atoi(dimension.c_str())), 1);
      std::vector<std::vector<Rung>> rungs;
      for (const auto& [name, algorithm] : algorithms) {
        rungs.push_back(climb(algorithm, g, targets.back(), limits));
        if (verbose)
          for (const Rung& r : rungs.back())
            std::fprintf(stderr, "%s d=%s %s n=%.0f t=%.3g us error=%.3g claimed=%.3g\n",
                         test::name_of(g.family).data(), dimension.c_str(), name.c_str(), r.samples, 1e6 * r.seconds,
                         r.error, r.claimed);
      }
      for (double target : targets) {
        std::printf("| %s | %s | %g |", test::name_of(g.family).data(), dimension.c_str(), target);
        std::vector<Time> times;
        double reference = 1e300;
        for (std::size_t i = 0; i < algorithms.size(); ++i) {
          times.push_back(time_to(target, rungs[i]));
          if (algorithms[i].first.starts_with("gsl vegas")) reference = std::min(reference, times.back().seconds);
        }
        for (std::size_t i = 0; i < algorithms.size(); ++i) {
          std::printf(" %s%.3g ms (%.2f) |", times[i].extrapolated ? "> " : "", 1e3 * times[i].seconds,
                      times[i].seconds / reference);
          log_sums[i] += std::log(times[i].seconds / reference);
          worst[i] = std::max(worst[i], times[i].seconds / reference);
        }
        cells += 1;
        std::printf("\n");
        std::fflush(stdout);
      }
    }
  std::printf("\nratio to the better of GSL's vegas: geometric mean, worst\n");
  for (std::size_t i = 0; i < algorithms.size(); ++i)
    std::printf("%-28s %.3f %.3f\n", algorithms[i].first.c_str(), std::exp(log_sums[i] / cells), worst[i]);
}
