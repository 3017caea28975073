#include "integrator/path/tracer.h"

#include <algorithm>

#include "integrator/path/loop.h"

namespace montelux {

RayCounts PathTracer::trace(const TilePass& pass, std::span<PixelSample> out) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  const RayCounts counts = settings_.lanes == Lanes::one
                               ? trace_paths<float>(scene_, accel_, settings_, pass, out)
                               : trace_paths<NativeFloats>(scene_, accel_, settings_, pass, out);
  if (settings_.max_component) {
    for (PixelSample& sample : out) {
      const float brightest = max_component(sample.radiance);
      if (brightest > *settings_.max_component) sample.radiance *= gray(*settings_.max_component / brightest);
    }
  }
  return counts;
}

}  // namespace montelux
