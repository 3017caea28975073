// The map of VEGAS: a monotone function of each coordinate that sends uniform points to where the integrand is large
// (Lepage 1978, 2021). Here it is continuously differentiable, so that a smooth integrand stays smooth enough for
// quasi-Monte Carlo points.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace montelux {

// x_d = g_d(y_d) with g_d a monotone cubic through nodes at equal distances of y (Fritsch and Carlson 1980, with
// harmonic means of the slopes), and the density of x is 1 over the Jacobian.
class AdaptiveMap {
 public:
  // The identity, with each axis divided into `bins` >= 2 parts.
  AdaptiveMap(std::size_t dimension, std::size_t bins);

  std::size_t dimension() const { return dimension_; }
  std::size_t bins() const { return bins_; }
  // Coordinate-major points y in (0, 1) become x in place; each jacobian[i] is multiplied by |dx/dy| at point i.
  void apply(std::span<double> points, std::span<double> jacobian) const;
  // The density of x at points of the cube (coordinate-major), that is 1 over the Jacobian at their preimages.
  void density(std::span<const double> points, std::span<double> density) const;
  // The nodes of one axis, bins + 1 numbers from 0 to 1.
  std::span<const double> nodes(std::size_t d) const { return {nodes_.data() + d * (bins_ + 1), bins_ + 1}; }

  // Moves the nodes so that each axis spreads the sums evenly: sums[d * bins + b] is that of the squared terms
  // f(x) J in bin b of y_d. The axes get `new_bins` parts.
  void refine(std::span<const double> sums, std::size_t new_bins);

 private:
  void fit();
  std::size_t dimension_, bins_;
  std::vector<double> nodes_;
  std::vector<double> coefficients_;  // four per bin, by axis, then power, then bin
  std::vector<std::uint16_t> guide_;  // for each axis: the bin in which each of its equal cells begins
};

}  // namespace montelux
