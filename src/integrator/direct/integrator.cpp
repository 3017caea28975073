#include "integrator/direct/integrator.h"

#include <algorithm>

#include "integrator/direct/loop.h"

namespace montelux {

template <class Tally>
RayCounts DirectIntegrator::trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  return settings_.lanes == Lanes::one ? trace_direct<float>(scene_, accel_, settings_, pass, out, tally)
                                       : trace_direct<NativeFloats>(scene_, accel_, settings_, pass, out, tally);
}

RayCounts DirectIntegrator::trace(const TilePass& pass, std::span<PixelSample> out) const {
  return trace_with(pass, out, no_tally);
}

RayCounts DirectIntegrator::trace_layers(const TilePass& pass, const LayerPlan& plan, std::span<PixelSample> out,
                                         std::span<ExactRgb> sums) const {
  LayerTally tally(plan, pass.points.samples_per_pass, sums);
  return trace_with(pass, out, tally);
}

}  // namespace montelux
