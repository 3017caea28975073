// An integral as a person states it, in texts, and as a problem that the methods solve. Everything that is wrong with
// the texts is found in one go.
#pragma once
#include "lab/domain/domain.h"
#include "lab/integral/integrate.h"

namespace montelux::lab {

// The texts. Densities are "2*x" or "2*x, inverse=sqrt(u), sampling=table, bound=2"; in more dimensions
// inverse=(..., ...) with u1, u2, ...
struct IntegralStatement {
  std::string integrand;
  std::vector<std::string> over;
  std::vector<std::string> densities{};
  std::optional<std::string> control{}, control_integral{}, target{};
  bool normalize_densities = false;
  bool allow_missed = false;  // densities may be 0 where the integrand is not: the estimate is biased
};

// What was found of a density.
struct DensityFacts {
  std::string text;
  double integral = 0, standard_error = 0;  // over the domain, as given
  std::optional<double> scaled_by;          // where it was normalised
};

struct StatedProblem {
  std::shared_ptr<const Domain> domain;
  Problem problem;
  std::vector<DensityFacts> densities;
};

// `mistakes` are messages: a sentence each, if applicable with the text and a caret below. `notes` say what the
// result suffers from.
struct StatementReading {
  std::optional<StatedProblem> stated;
  std::vector<std::string> mistakes, notes;
};

// The methods decide what is checked: that there is a density for importance and mis, and that what they sample covers
// the integrand.
StatementReading read_statement(const IntegralStatement& statement, const std::vector<Method>& methods);

}  // namespace montelux::lab
