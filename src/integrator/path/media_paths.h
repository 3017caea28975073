// The path loop of scenes with participating media, compiled by itself.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/path/settings.h"
#include "scene/scene.h"

namespace montelux {

// As trace_paths(), on the lanes that the settings choose, through the scene's media. For the tallies of the path
// tracer.
template <class Tally>
RayCounts trace_paths_in_media(const Scene& scene, const LightSet& lights, const Accel& rays,
                               const PathSettings& settings, const TilePass& pass, std::span<PixelSample> out,
                               Tally& tally);

}  // namespace montelux
