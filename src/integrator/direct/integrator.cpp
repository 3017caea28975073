#include "integrator/direct/integrator.h"

#include <algorithm>

#include "integrator/direct/loop.h"

namespace montelux {

RayCounts DirectIntegrator::trace(const TilePass& pass, std::span<PixelSample> out) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  return settings_.lanes == Lanes::one ? trace_direct<float>(scene_, accel_, settings_, pass, out)
                                       : trace_direct<NativeFloats>(scene_, accel_, settings_, pass, out);
}

}  // namespace montelux
