// Integrands that mislead: narrow peaks far apart, infinite variance, no integral at all.
#pragma once
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lab/integral/integrate.h"

namespace montelux::test {

struct KnownIntegral {
  std::string name;
  lab::Integrand integrand;
  double truth = 0;
};

// exp(-|x - c|^2 / (2 sigma^2)) with all coordinates of c alike.
inline double gaussian(const double* x, std::size_t dimension, double centre, double sigma) {
  double s = 0;
  for (std::size_t d = 0; d < dimension; ++d) s += (x[d] - centre) * (x[d] - centre);
  return std::exp(-s / (2 * sigma * sigma));
}
inline double gaussian_integral(std::size_t dimension, double centre, double sigma) {
  const double scale = sigma * std::numbers::sqrt2;
  const double side =
      sigma * std::sqrt(std::numbers::pi / 2) * (std::erf((1 - centre) / scale) + std::erf(centre / scale));
  return std::pow(side, double(dimension));
}

// A separable map that has found one of the two has next to no points near the other.
inline KnownIntegral two_gaussians(double sigma, std::size_t dimension = 4) {
  const auto f = [=](const double* x) {
    return gaussian(x, dimension, 0.23, sigma) + gaussian(x, dimension, 0.74, sigma);
  };
  return {"two Gaussians",
          {dimension, lab::pointwise(f)},
          gaussian_integral(dimension, 0.23, sigma) + gaussian_integral(dimension, 0.74, sigma)};
}

// Integrals that exist, of integrands whose squares have none: tail indices 2, 1.5, 2 and 1.25.
inline std::vector<KnownIntegral> infinite_variance() {
  constexpr double pi = std::numbers::pi;
  return {{"1/sqrt|x-y|",
           {2, lab::pointwise([](const double* x) { return 1 / std::sqrt(std::abs(x[0] - x[1])); })},
           8.0 / 3},
          // Watson (1939): Gamma(1/4)^4 / (4 pi^3).
          {"Watson",
           {3, lab::pointwise([](const double* x) {
              return 1 / (1 - std::cos(pi * x[0]) * std::cos(pi * x[1]) * std::cos(pi * x[2]));
            })},
           std::pow(std::tgamma(0.25), 4) / (4 * pi * pi * pi)},
          {"x^-0.5", {1, lab::pointwise([](const double* x) { return std::pow(x[0], -0.5); })}, 2},
          {"x^-0.8", {1, lab::pointwise([](const double* x) { return std::pow(x[0], -0.8); })}, 5}};
}

inline std::vector<KnownIntegral> divergent() {
  return {{"1/x", {1, lab::pointwise([](const double* x) { return 1 / x[0]; })}},
          {"1/|x-y|", {2, lab::pointwise([](const double* x) { return 1 / std::abs(x[0] - x[1]); })}},
          {"1/(x^2+y^2)", {2, lab::pointwise([](const double* x) { return 1 / (x[0] * x[0] + x[1] * x[1]); })}},
          {"x^-1.5", {1, lab::pointwise([](const double* x) { return std::pow(x[0], -1.5); })}}};
}

// Bounded, or with a variance: nothing to doubt.
inline std::vector<KnownIntegral> well_behaved() {
  const auto one = [](const double* x) {
    return std::sin(9 * x[0]) * std::sin(9 * x[0]) + std::cos(9 * x[0]) * std::cos(9 * x[0]);
  };
  return {{"3", {2, lab::pointwise([](const double*) { return 3.0; })}, 3},
          {"6e-16", {1, lab::pointwise([](const double*) { return 6e-16; })}, 6e-16},
          {"sin^2 + cos^2", {1, lab::pointwise(one)}, 1},
          {"x^-0.2", {1, lab::pointwise([](const double* x) { return std::pow(x[0], -0.2); })}, 1.25},
          {"-log x", {1, lab::pointwise([](const double* x) { return -std::log(x[0]); })}, 1},
          {"4 x^3", {1, lab::pointwise([](const double* x) { return 4 * x[0] * x[0] * x[0]; })}, 1},
          {"|x-y|^-0.25",
           {2, lab::pointwise([](const double* x) { return std::pow(std::abs(x[0] - x[1]), -0.25); })},
           2 / (0.75 * 1.75)},
          {"quarter disk",
           {2, lab::pointwise([](const double* x) { return x[0] * x[0] + x[1] * x[1] < 1 ? 1.0 : 0.0; })},
           std::numbers::pi / 4},
          {"(x-1/2) e^y", {2, lab::pointwise([](const double* x) { return (x[0] - 0.5) * std::exp(x[1]); })}, 0},
          {"Gaussian",
           {4, lab::pointwise([](const double* x) { return gaussian(x, 4, 0.4, 0.05); })},
           gaussian_integral(4, 0.4, 0.05)}};
}

inline bool warns(const lab::IntegralResult& r, lab::IntegralWarning::Kind kind) {
  for (const lab::IntegralWarning& w : r.warnings)
    if (w.kind == kind) return true;
  return false;
}

}  // namespace montelux::test
