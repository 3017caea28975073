#include "integrator/direct/integrator.h"

#include <algorithm>

#include "integrator/direct/loop.h"

namespace montelux {

template <class Tally>
RayCounts DirectIntegrator::trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const {
  return settings_.lanes == Lanes::one ? trace_direct<float>(scene_, accel_, settings_, pass, out, tally)
                                       : trace_direct<NativeFloats>(scene_, accel_, settings_, pass, out, tally);
}

template class LayeredIntegrator<DirectIntegrator>;

}  // namespace montelux
