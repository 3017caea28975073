// The state of an estimate as a plain value: saved, resumed, merged.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lab/integral/methods.h"
#include "mc/moments.h"
#include "mc/tail.h"

namespace montelux::lab {

// The samples of one pass, and the passes of one run.
inline constexpr std::uint64_t max_samples_of_pass = std::uint64_t(1) << 26;
inline constexpr std::uint32_t max_passes = 1u << 31;

// For methods with a map: the part of the integral where the map has few points, estimated by uniform points and by
// mapped points, each times the number of samples; and the same for the integrand's magnitude. The expectations of each
// pair are equal.
struct OutsideSums {
  double uniform = 0, map = 0, uniform_magnitude = 0, map_magnitude = 0;
  void merge(const OutsideSums& other) {
    uniform += other.uniform, map += other.map;
    uniform_magnitude += other.uniform_magnitude, map_magnitude += other.map_magnitude;
  }
};

// One pass: an independent randomisation, and the sums over its samples so far.
struct PassRecord {
  std::uint64_t seed = 0;   // of its run
  std::uint32_t index = 0;  // its number in the run
  std::uint64_t samples = 0;
  double sum = 0, m2 = 0;  // of the terms; of their squared deviations from their mean
  // The pass's own estimate of the variance of its mean, times its squared number of samples; 0 if it has none.
  double own_variance = 0;
  // Sums of the control variate minus its integral, of its square, and of its product with the term.
  double control_sum = 0, control_squares = 0, control_products = 0;
  OutsideSums outside{};
  double magnitude = 0;  // sum of the absolute values of the terms; 0 for methods without a map
  double mean() const { return samples == 0 ? 0 : sum / double(samples); }
};

// The growth of the integrand (lab/integral/singularity.h).
struct TailProbe {
  bool known = false;
  double exponent = 0;            // f ~ h^-exponent at a distance h from where it is infinite; 0: it is bounded
  double index = 0;               // of the tail of its values at uniform points; infinite where it is bounded
  std::size_t terms = 0;          // used for the index
  std::uint64_t evaluations = 0;  // used
};

struct IntegralState {
  Method method;  // the method used; never automatic
  std::size_t dimension = 1;
  std::uint64_t seed = 0;              // of the run that is resumed
  std::uint64_t training_samples = 0;  // the plan of the training, so that a resumed run trains equally
  std::uint64_t training_evaluations = 0;
  std::uint64_t evaluations = 0, non_finite = 0;  // including training
  double seconds = 0;
  int looks = 0;                             // tests of the stopping rule
  std::uint64_t proposed = 0, accepted = 0;  // of rejection or of the Markov chain
  std::vector<PassRecord> passes;
  LargestTerms largest{LargestTerms::of_run};
  TailProbe probe{};
};

std::string to_json(const IntegralState& state);
// Throws std::invalid_argument with a description of the error in the text.
IntegralState state_from_json(std::string_view text);
// Equivalent to a single run with all passes. Throws std::invalid_argument if method or dimension differ, or if
// two states share passes (equal seeds).
IntegralState merge(const std::vector<IntegralState>& states);

}  // namespace montelux::lab
