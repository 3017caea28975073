// How far pixels share their noise with those around them.
#pragma once
#include <vector>

#include "denoise/denoise.h"

namespace montelux {

// The correlation of the noise of two pixels by their distance, one law for the whole image. Integrators that share
// samples between pixels make it; elsewhere it is zero.
class NoiseCorrelation {
 public:
  // By the difference of the halves, which shows noise alone, up to the reach of the filter and as far as it is
  // significant.
  explicit NoiseCorrelation(const NoisyImage& image);
  bool is_zero() const { return of_rings_.size() <= 1; }
  // Of a pixel and another one, by their distance along both axes; 1 for the pixel itself.
  float at(int x, int y) const;

 private:
  std::vector<float> of_rings_;  // by the distance in pixels, rounded
};

}  // namespace montelux
