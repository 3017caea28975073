#include "integrator/path/path_recorder.h"

#include <array>

#include "integrator/path/loop.h"
#include "integrator/path/tracer.h"

namespace montelux {

std::optional<TracedPath> PathTracer::trace_path(const TilePass& pass) const {
  std::array<PixelSample, 1> out{};
  PathRecorder recorder;
  const auto trace = [&](auto in_media, const auto& guide) {
    trace_paths<float, in_media()>(scene_, lights(), accel_, settings_, pass, out, recorder, guide);
  };
  const auto trace_with = [&](const auto& guide) {
    scene_.has_participating_media() ? trace(std::true_type{}, guide) : trace(std::false_type{}, guide);
  };
  settings_.guide ? trace_with(FieldGuide{*settings_.guide}) : trace_with(NoGuide{});
  TracedPath path = std::move(recorder).take();
  path.radiance = out[0].light();  // also of rays that meet nothing, or that are not finite
  const auto x = std::uint32_t(pass.tile.x0), y = std::uint32_t(pass.tile.y0);
  const PathStart<float> start = start_of_path<float>(scene_, pass, {x, y, pass.only.value_or(0)});
  path.origin = start.o, path.direction = start.d;
  return path;
}

}  // namespace montelux
