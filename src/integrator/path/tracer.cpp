#include "integrator/path/tracer.h"

#include <algorithm>

#include "integrator/path/loop.h"

namespace montelux {

PathTracer::PathTracer(const Scene& scene, const Accel& accel, const PathSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  if (settings.light_selection && *settings.light_selection != scene.lights.settings().selection)
    own_lights_ = scene.lights.with(LightSettings{*settings.light_selection});
}

template <class Tally>
RayCounts PathTracer::trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  const LightSet& lights = own_lights_ ? *own_lights_ : scene_.lights;
  return settings_.lanes == Lanes::one ? trace_paths<float>(scene_, lights, accel_, settings_, pass, out, tally)
                                       : trace_paths<NativeFloats>(scene_, lights, accel_, settings_, pass, out, tally);
}

RayCounts PathTracer::trace(const TilePass& pass, std::span<PixelSample> out) const {
  return trace_with(pass, out, no_tally);
}

RayCounts PathTracer::trace_layers(const TilePass& pass, const LayerPlan& plan, std::span<PixelSample> out,
                                   std::span<ExactRgb> sums) const {
  LayerTally tally(plan, pass.points.samples_per_pass, sums);
  return trace_with(pass, out, tally);
}

}  // namespace montelux
