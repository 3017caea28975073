// What is wrong with the densities of a statement, measured.
#pragma once
#include "lab/statement/statement.h"

namespace montelux::lab {

struct DensityCheck {
  double integral = 0, standard_error = 0;
  std::uint64_t non_finite = 0;
  std::optional<std::vector<double>> negative_at;  // a point of the cube
};
// The integral by quasi-Monte Carlo points, with the signs and finiteness of what was seen.
DensityCheck check_density(const BatchFunction& density, std::size_t dimension);

// The integral of the integrand where all of the densities are 0; 0 where that is nothing but rounding.
struct MissedIntegral {
  double value = 0, standard_error = 0;
};
MissedIntegral missed_by(const Problem& problem, std::span<const UserDensity> densities);

// Whether samples of a control variate contradict its stated integral, by Student's test at the level `level` over 16
// passes of quasi-Monte Carlo points; differences of rounding do not. With what the samples give.
struct ControlCheck {
  bool contradicts = false;
  double integral = 0, standard_error = 0;
  static constexpr double level = 1e-6;
};
ControlCheck check_control(const ControlVariate& control, std::size_t dimension);

// How far the means of a few bounded functions of a coordinate differ between points of the inverse and points weighted
// by the density, in standard errors: the largest of them. Beyond 8 they are not of one distribution.
double inverse_disagreement(const UserDensity& density, std::size_t dimension);

}  // namespace montelux::lab
