// Sampling of a one-dimensional profile by a table of its inverse distribution function.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "math/functions.h"

namespace montelux {

// The map u -> x that is linear between the quantiles of |f| at i / cells. Its density is known exactly for every
// resolution of the table, 1 / (cells * width of the cell), so that weights by it cause no bias.
class InverseCdf {
 public:
  static constexpr int cells = 1024;

  template <class F>
  struct Draw {
    F x;
    F inverse_density;
  };

  // Profile: symmetric about 0, zero outside [-radius, radius].
  template <class Profile>
  explicit InverseCdf(const Profile& profile);

  template <class F>
  Draw<F> operator()(F u) const {
    F scaled = u * float(cells);
    F cell = clamp(floor(scaled), F(0.0f), F(float(cells - 1)));
    Uint<F> i = to_uint(cell);
    F low = gather(quantiles_.data(), i), high = gather(quantiles_.data() + 1, i);
    F width = high - low;
    return {low + (scaled - cell) * width, width * float(cells)};
  }

  // The integral of the profile itself (not of its magnitude).
  double integral() const { return integral_; }

 private:
  std::array<float, cells + 1> quantiles_{};
  double integral_ = 0;
};

template <class Profile>
InverseCdf::InverseCdf(const Profile& profile) {
  // The distribution function of |f| on a fine grid of midpoints.
  const int steps = 1 << 16;
  const double radius = profile.radius, step = 2 * radius / steps;
  std::vector<double> cdf(steps + 1);
  for (int i = 0; i < steps; ++i) {
    double value = profile(float(-radius + (i + 0.5) * step));
    integral_ += value * step;
    cdf[i + 1] = cdf[i] + std::abs(value) * step;
  }
  // Its quantiles; the first and the last are the ends of the support, so that no point of it is missed.
  int i = 0;
  for (int k = 1; k < cells; ++k) {
    double target = cdf[steps] * k / cells;
    while (i < steps - 1 && cdf[i + 1] < target) ++i;
    double rise = cdf[i + 1] - cdf[i];
    double t = rise > 0 ? (target - cdf[i]) / rise : 0.5;
    quantiles_[k] = float(-radius + (i + t) * step);
  }
  quantiles_[0] = -profile.radius;
  quantiles_[cells] = profile.radius;
}

}  // namespace montelux
