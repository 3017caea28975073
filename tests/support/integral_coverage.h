// How often the intervals of integrals with known values hold the truth.
#pragma once
#include <cmath>
#include <string>
#include <string_view>

#include "genz.h"
#include "lab/integral/integrate.h"

namespace montelux::test {

// A problem with everything that any method needs: the control variate is the plane through the function's values at
// the centre and near it, the densities are triangles about 1/4 and 3/4 of every axis mixed with the uniform density.
inline lab::Problem genz_problem(const Genz& g) {
  lab::Problem problem{.integrand = g.integrand()};
  const std::size_t n = g.dimension();
  std::vector<double> slope(n), x(n, 0.5);
  for (std::size_t d = 0; d < n; ++d) {
    x[d] = 0.75;
    slope[d] = 2 * g(x.data());
    x[d] = 0.25;
    slope[d] -= 2 * g(x.data());
    x[d] = 0.5;
  }
  problem.control = lab::ControlVariate{lab::pointwise([slope, n](const double* y) {
                                          double s = 0;
                                          for (std::size_t d = 0; d < n; ++d) s += slope[d] * (y[d] - 0.5);
                                          return s;
                                        }),
                                        0.0};
  for (double centre : {0.25, 0.75}) {
    // In each axis half uniform, half the density that falls linearly from its corner.
    const bool low = centre < 0.5;
    lab::UserDensity density{lab::pointwise([n, low](const double* y) {
      double p = 1;
      for (std::size_t d = 0; d < n; ++d) p *= 0.5 + (low ? 1 - y[d] : y[d]);
      return p;
    })};
    density.inverse = [low](lab::PointBatch u, std::span<double> image) {
      for (std::size_t i = 0; i < image.size(); ++i) {
        // The root of x (3 - x) / 2 = u, and its mirror image.
        const double v = low ? u.coordinates[i] : 1 - u.coordinates[i];
        const double root = 1.5 - std::sqrt(2.25 - 2 * v);
        image[i] = low ? root : 1 - root;
      }
    };
    problem.densities.push_back(std::move(density));
  }
  return problem;
}

struct Coverage {
  int inside = 0, runs = 0;
  double share() const { return double(inside) / double(runs); }
};

// Of 95 % intervals over seeds first, first + 1, ...
inline Coverage coverage_of(const lab::Problem& problem, double truth, std::string_view method, std::uint64_t samples,
                            int runs, std::uint64_t first = 1) {
  const lab::Method parsed = lab::parse_method(method).value();
  Coverage c;
  for (int i = 0; i < runs; ++i) {
    const auto r = lab::integrate(problem, parsed, {.samples = samples}, {.seed = first + std::uint64_t(i)});
    c.inside += r.interval.low <= truth && truth <= r.interval.high;
    ++c.runs;
  }
  return c;
}

inline constexpr std::array<std::string_view, 18> covered_methods{"uniform",
                                                                  "stratified",
                                                                  "stratified:strata=latin",
                                                                  "antithetic",
                                                                  "control",
                                                                  "importance",
                                                                  "mis",
                                                                  "qmc",
                                                                  "qmc:points=halton",
                                                                  "qmc:points=lattice",
                                                                  "qmc:points=pmj02",
                                                                  "qmc:points=lattice,baker=true",
                                                                  "qmc:adapt=true",
                                                                  "vegas",
                                                                  "miser",
                                                                  "ris",
                                                                  "metropolis",
                                                                  "auto"};

}  // namespace montelux::test
