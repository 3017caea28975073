#include "integrator/path/path_recorder.h"

#include <array>

#include "integrator/path/loop.h"
#include "integrator/path/tracer.h"

namespace montelux {

std::optional<TracedPath> PathTracer::trace_path(const TilePass& pass) const {
  const LightSet& lights = own_lights_ ? *own_lights_ : scene_.lights;
  std::array<PixelSample, 1> out{};
  PathRecorder recorder;
  if (scene_.media.empty())
    trace_paths<float>(scene_, lights, accel_, settings_, pass, out, recorder);
  else
    trace_paths<float, true>(scene_, lights, accel_, settings_, pass, out, recorder);
  TracedPath path = std::move(recorder).take();
  path.radiance = out[0].radiance;  // also of rays that meet nothing, or that are not finite
  const auto x = std::uint32_t(pass.tile.x0), y = std::uint32_t(pass.tile.y0);
  const PathStart<float> start = start_of_path<float>(scene_, pass, {x, y, pass.only.value_or(0)});
  path.origin = start.o, path.direction = start.d;
  return path;
}

}  // namespace montelux
