// Path guiding: the passes before the render that teach it, and the path loop that uses what they teach.
#pragma once
#include "accel/accel.h"
#include "integrator/guiding/field.h"
#include "integrator/integrator.h"
#include "integrator/path/settings.h"
#include "scene/scene.h"

namespace montelux {

// Traces settings.guiding_paths paths in rounds, each of twice as many as the one before, with the field that the
// rounds before have taught. A pure function of scene, lights and settings. None of these paths is shown.
GuideField train_guide(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings);

// As trace_paths(), with settings.guide, on the lanes that the settings choose, with or without participating media.
// For the tallies of the path tracer.
template <class Tally>
RayCounts trace_guided_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                             const PathSettings& settings, const TilePass& pass, std::span<PixelSample> out,
                             Tally& tally);

}  // namespace montelux
