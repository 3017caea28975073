#include "integrator/path/tracer.h"

#include <algorithm>

#include "integrator/path/loop.h"

namespace montelux {

RayCounts PathTracer::trace(const TilePass& pass, std::span<PixelSample> out) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  return settings_.lanes == Lanes::one ? trace_paths<float>(scene_, accel_, settings_, pass, out)
                                       : trace_paths<NativeFloats>(scene_, accel_, settings_, pass, out);
}

}  // namespace montelux
