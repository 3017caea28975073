// Diagnoses of unreliable results.
#pragma once
#include <span>

#include "lab/integral/integrate.h"

namespace montelux::lab {

// The tail of the terms: `m2` is their sum of squared deviations from `mean`.
TailDiagnosis diagnose_tail(const IntegralState& state, double m2, double mean, double samples);

// Whether a method's terms have the tail of the integrand itself, so that a probe of the integrand is informative.
bool needs_probe(const Method& method);

// Absent for methods without a map, and with fewer than two passes.
std::optional<OutsideMap> outside_map_of(const IntegralState& state);

// All warnings of a result.
std::vector<IntegralWarning> warnings_of(const IntegralResult& result);

// An estimate to be compared with others.
struct NamedEstimate {
  std::string name;
  double mean = 0, standard_error = 0, degrees = 0;  // of the t distribution
};
NamedEstimate estimate_named(std::string name, const IntegralState& state);

// The pairs whose intervals do not overlap. Each interval has the error rate level / (2 pairs), so that by Bonferroni's
// inequality estimates of one integral disagree with probability at most `level`, whatever their correlation.
std::vector<Disagreement> disagreements_of(std::span<const NamedEstimate> estimates, double level = disagreement_level);
std::string to_text(const Disagreement& disagreement);

}  // namespace montelux::lab
