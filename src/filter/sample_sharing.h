// Samples that pixels share: each counts for every pixel whose filter contains its place.
#pragma once
#include <vector>

#include "filter/filter.h"

namespace montelux {

// All pixels take their sample number i of a pass at the same offset x from their centres. With the filter f, a sample
// counts with the weight f(x - j) / p(x) for the pixel j beside its own, where p is the density of x. As p is in
// proportion to the sum of f(x - j) over all j, the weights of the samples i that count for a pixel sum to 1: what is
// even has no noise. The mean over x is the filtered value of the pixel, as it is where pixels draw their own offsets
// in proportion to f; but it has less of the noise that is independent from sample to sample.
class SampleSharing {
 public:
  explicit SampleSharing(const Filter& filter);

  // How many pixels away a sample may count, along x and y. 0: only in its own, as all that a box of one pixel weighs.
  int reach_x() const { return x_.reach; }
  int reach_y() const { return y_.reach; }

  // The offset of a sample, in pixels, and its weights in the pixels beside its own, from -reach to reach: that of
  // pixel j is x[j.x + reach_x] * y[j.y + reach_y].
  struct Weights {
    Vec2f offset;
    std::vector<float> x, y;
  };
  // u in [0, 1)^2.
  Weights at(Vec2f u) const;

  // The variance of the mean of N samples of a pixel, for noise that is independent from sample to sample, over that
  // with a box of one pixel; and where each pixel draws samples of its own in proportion to |f|.
  double noise() const;
  double noise_of_own_samples() const;

 private:
  struct Axis {
    int reach = 0;
    std::vector<double> quantiles;  // of the offset, at equal steps of u
    double scale = 1;               // one over the integral of the filter along this axis
    double magnitude = 1;           // the integral of its magnitude, relative to that
  };
  Axis axis(bool along_x, float radius) const;
  float along(bool x, float offset) const { return filter_.evaluate(x ? Vec2f{offset, 0} : Vec2f{0, offset}); }
  float draw(const Axis& axis, bool is_x, float u, std::vector<float>& weights) const;

  Filter filter_;
  Axis x_, y_;
};

}  // namespace montelux
