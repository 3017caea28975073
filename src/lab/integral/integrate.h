// Integrals over the unit hypercube by named methods. The estimate of every method is the mean over passes: independent
// randomisations of one construction, whose spread gives an error bar that is valid for any correlation within a pass.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/integral/integrand.h"
#include "lab/integral/methods.h"
#include "lab/integral/state.h"
#include "mc/confidence.h"

namespace montelux::lab {

// How a density is sampled: by its inverse if one is given; otherwise by a table of its inverse distribution
// function (up to three dimensions; the estimate then uses the table's own density, so it stays unbiased), or by
// rejection from the uniform distribution.
enum class DensitySampling : std::uint8_t { automatic, inverse, table, rejection };

// A density to sample from, per unit volume of the unit hypercube. It should integrate to 1 (inspect_density checks
// it).
struct UserDensity {
  BatchFunction density;
  std::optional<BatchMap> inverse{};  // from uniform points of the cube to points with this density
  DensitySampling sampling = DensitySampling::automatic;
  std::optional<double> bound{};  // of the density, for rejection; absent: the largest value found, increased
  double scale = 1;               // the density is scale * density: normalisation
};

// A function close to the integrand, and its integral over the cube.
struct ControlVariate {
  BatchFunction evaluate;
  double integral = 0;
};

struct Problem {
  Integrand integrand;
  std::vector<UserDensity> densities{};     // importance: the first; mis: all
  std::optional<ControlVariate> control{};  // control
  std::optional<BatchFunction> target{};    // ris, metropolis: not normalised, not negative; absent: |integrand|
};

// When to stop: at the first limit that is reached. `samples` limits the evaluations of the integrand, including pilots
// and training: passes have the length that suits the method. Without any limit: 2^20 samples. The target is for
// half the width of the interval at `confidence`, absolute, or relative to the estimate; the stopping rule is valid
// whenever it stops (see docs/integration.md).
struct Budget {
  std::optional<std::uint64_t> samples{};
  std::optional<double> seconds{};
  std::optional<double> target_error{};
  bool target_is_relative = false;
  double confidence = 0.95;
};

struct IntegralProgress {
  double mean = 0, standard_error = 0, fraction = 0, elapsed = 0;  // fraction of the work, in [0, 1]
  std::uint64_t evaluations = 0, passes = 0;
  std::string_view note{};  // why the work may not end as stated; otherwise empty
};

struct Execution {
  std::uint64_t seed = 0;
  int threads = 1;                                          // 0: all of the machine. The bits do not depend on it.
  std::function<bool()> stop{};                             // polled between units of work; may be empty
  std::function<void(const IntegralProgress&)> observer{};  // called from one thread at a time; may be empty
  std::optional<IntegralState> resume{};                    // continues from this state, with its method and seed
};

// nothing_found: every sample of a run to a target error is 0; rounding: the error cannot get below that of rounding.
enum class StopReason : std::uint8_t { samples, seconds, target_error, nothing_found, rounding, stopped };
std::string_view name_of(StopReason reason);

// A warning that a result is less reliable than it seems.
struct IntegralWarning {
  enum class Kind : std::uint8_t {
    non_finite,
    heavy_tail,
    may_not_exist,
    nothing_found,
    outside_map,
    map_fit,
    disagreement,
    control_integral,
    missed_region,
    density,
    inconsistent,
    few_passes,
    target
  };
  Kind kind;
  std::string message;
};

// How heavy the tail of the single terms f / p is.
struct TailDiagnosis {
  double hill_index = 0;         // estimated tail index: the variance is infinite up to 2; infinite if there is no tail
  std::size_t fitted_terms = 0;  // terms used for the index
  double largest_share = 0;      // of the largest term in the sum of squared deviations
  bool heavy = false;            // the error bar is not reliable
  bool may_not_exist = false;    // an index up to 1 cannot be excluded
};

// The part of the integral where the map of an adaptive method has fewer points than the uniform share of its points,
// estimated by both: equal in expectation.
struct OutsideMap {
  double by_uniform = 0, uniform_error = 0, by_map = 0, map_error = 0;
  bool missed = false;  // the uniform points find more, at the level outside_map_level: the value then includes theirs
};
inline constexpr double outside_map_level = 1e-3;
// Below this worth of a sample an adaptive map is doubted. Single peaks, corners and edges leave 0.6 and more; k equal
// peaks on the diagonal of d dimensions leave k^(1-d), since a product of maps has peaks at all k^d crossings.
inline constexpr double doubtful_map_worth = 0.25;

// Two estimates of one integral that differ by more than their errors explain.
struct Disagreement {
  std::string first, second;
  double difference = 0, standard_error = 0;  // the error as if both were independent
};
inline constexpr double disagreement_level = 1e-3;  // of all pairs together
inline constexpr double control_level = 1e-3;       // at which samples contradict the integral of a control variate

struct IntegralResult {
  double mean = 0, standard_error = 0;
  double confidence = 0.95;
  Interval interval{0, 0};                 // contains the integral with probability `confidence`; valid sequentially
  std::uint64_t evaluations = 0;           // of the integrand, including pilots and training
  std::uint64_t training_evaluations = 0;  // those that are not part of the mean
  double variance_of_one_sample = 0;       // of a single term of the mean
  double seconds = 0, efficiency = 0;      // efficiency: 1 / (standard_error^2 * seconds)
  std::uint64_t passes = 0, non_finite = 0;
  double chi2_per_dof = 0, q = 1;  // do the variances within and between passes agree?
  TailDiagnosis tail;
  bool found_nothing = false;             // every term is 0: there is no error and no interval
  std::optional<OutsideMap> outside_map;  // of adaptive methods
  // What a sample through the adaptive map is worth, in samples of a density that follows the magnitude of the
  // integrand: (mean |term|)^2 / mean term^2, in 0..1 (Kong 1992). None without a map.
  std::optional<double> map_worth;
  std::optional<double> acceptance;   // of rejection or of the Markov chain
  std::optional<double> coefficient;  // of the control variate, the mean over passes
  Method method;                      // the method that was used: never automatic
  std::string why;                    // what `auto` measured and why it chose the method; otherwise empty
  StopReason stopped_because = StopReason::samples;
  bool target_reached = false;
  std::vector<IntegralWarning> warnings;
  IntegralState state;
};

// Throws std::invalid_argument if the problem does not have what the method needs (a density, a control variate), the
// dimension is not in 1..64, or the budget is empty or not positive.
IntegralResult integrate(const Problem& problem, const Method& method, const Budget& budget,
                         const Execution& execution = {});

// The result of a state (saved, or merged from several).
IntegralResult result_of(const IntegralState& state, double confidence = 0.95);

// The errors of a density, measured with `samples` uniform points.
struct DensityReport {
  double integral = 0, standard_error = 0;  // of the density as given, times scale
  bool negative = false;
  std::uint64_t non_finite = 0;
  double missed = 0, missed_error = 0;  // the integral of the integrand where the density is 0: the resulting bias
  double acceptance = 1;                // of rejection with the bound; 1 for other kinds of sampling
  bool normalised() const;              // 1 within five standard errors or 1e-3
};
DensityReport inspect_density(const Problem& problem, std::size_t which, std::uint64_t samples = 1u << 16,
                              std::uint64_t seed = 0);

}  // namespace montelux::lab
