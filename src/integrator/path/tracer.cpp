#include "integrator/path/tracer.h"

#include <algorithm>

#include "integrator/path/loop.h"

namespace montelux {

PathTracer::PathTracer(const Scene& scene, const Accel& accel, const PathSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  if (settings.light_selection && *settings.light_selection != scene.lights.settings().selection)
    own_lights_ = scene.lights.with(LightSettings{*settings.light_selection});
}

RayCounts PathTracer::trace(const TilePass& pass, std::span<PixelSample> out) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  const LightSet& lights = own_lights_ ? *own_lights_ : scene_.lights;
  return settings_.lanes == Lanes::one ? trace_paths<float>(scene_, lights, accel_, settings_, pass, out)
                                       : trace_paths<NativeFloats>(scene_, lights, accel_, settings_, pass, out);
}

}  // namespace montelux
