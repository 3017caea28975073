// Recursive stratification: MISER (Press and Farrar 1990, "Recursive Stratified Sampling for Multidimensional Monte
// Carlo Integration").
#pragma once
#include <functional>
#include <span>

#include "mc/cube_points.h"

namespace montelux {

// Sets values[i] to the function at point i; coordinate d of it is points[d * values.size() + i].
using CubeFunction = std::function<void(std::span<const double> points, std::span<double> values)>;

// An estimate of an integral from one realisation, and the estimated variance of the estimate.
struct RegionEstimate {
  double mean = 0, variance = 0;
  std::uint64_t samples = 0, non_finite = 0;
};

struct MiserSettings {
  double explored = 0.1;               // share of a region's samples that decides where to split it
  std::uint64_t min_explored = 16;     // samples per dimension
  std::uint64_t min_to_cut = 32 * 16;  // a region with fewer samples per dimension is not split
  double exponent = 2;                 // rate of decline of the error that the shares of the halves assume
};

// The integral of f over the unit cube with `samples` >= 2 samples. Unbiased: samples that explore do not count.
RegionEstimate miser(const CubeFunction& f, std::size_t dimension, std::uint64_t samples, CubeKey key,
                     const MiserSettings& settings = {});

}  // namespace montelux
