// The integrand: functions on the unit hypercube that evaluate many points at once.
#pragma once
#include <cstddef>
#include <functional>
#include <span>

namespace montelux::lab {

// Points of [0, 1)^dimension, coordinate-major: coordinate d of point i is coordinates[d * count + i].
struct PointBatch {
  std::span<const double> coordinates;
  std::size_t dimension = 0, count = 0;

  // Coordinate d of every point.
  std::span<const double> operator[](std::size_t d) const { return coordinates.subspan(d * count, count); }
};

// Sets values[i] to the function at point i. A pure function: it is called from several threads at once.
using BatchFunction = std::function<void(PointBatch points, std::span<double> values)>;
// Sets image[d * count + i] to coordinate d of the image of point i; a pure function like BatchFunction.
using BatchMap = std::function<void(PointBatch points, std::span<double> image)>;

// A function on [0, 1]^dimension, including the Jacobian of its original domain. 1 <= dimension <= 64.
struct Integrand {
  std::size_t dimension = 1;
  BatchFunction evaluate;
};

// The batch form of a function of one point: f(const double* x) with x[0] ... x[dimension - 1].
template <class Function>
BatchFunction pointwise(Function f) {
  return [f](PointBatch points, std::span<double> values) {
    double x[64];
    for (std::size_t i = 0; i < points.count; ++i) {
      for (std::size_t d = 0; d < points.dimension; ++d) x[d] = points.coordinates[d * points.count + i];
      values[i] = f(static_cast<const double*>(x));
    }
  };
}

}  // namespace montelux::lab
