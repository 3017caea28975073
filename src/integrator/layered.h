// Pixel integrators that report to a tally where their light comes from: with layers and without, by the same code.
#pragma once
#include <algorithm>

#include "integrator/integrator.h"
#include "integrator/tally.h"

namespace montelux {

// Implements PixelIntegrator for an integrator of type `Kind` that has
//   template <class Tally> RayCounts trace_with(const TilePass&, std::span<PixelSample> out, Tally&) const
// which finds the samples of `out` cleared. Its header declares the instance extern, and its source file makes it.
template <class Kind>
class LayeredIntegrator : public PixelIntegrator {
 public:
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const final {
    return trace_into(pass, out, no_tally);
  }
  bool has_layers() const final { return true; }
  RayCounts trace_layers(const TilePass& pass, const LayerPlan& plan, std::span<PixelSample> out,
                         std::span<ExactRgb> sums) const final {
    LayerTally tally(plan, pass.points.samples_per_pass, sums);
    return trace_into(pass, out, tally);
  }

 private:
  template <class Tally>
  RayCounts trace_into(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const {
    std::fill(out.begin(), out.end(), PixelSample{});
    return static_cast<const Kind&>(*this).trace_with(pass, out, tally);
  }
};

}  // namespace montelux
