// What is learned before a render, for path guiding and next-event estimation, and the path loop that path guiding
// takes.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/path/settings.h"
#include "light/direction_field.h"
#include "scene/scene.h"

namespace montelux {

// Traces settings.guiding_paths paths in rounds, each of twice as many as the one before, with the field that the
// rounds before have taught. A pure function of scene, lights and settings. None of these paths is shown.
GuideField train_guide(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings);

struct LearnedLights {
  std::shared_ptr<const ClusterField> clusters;  // how much of what lights can send arrives
  std::shared_ptr<const SkyField> sky;           // the directions from which the brightest light from infinity arrives
};

// What shadow rays find from the vertices of settings.light_paths paths where settings.learned_selection is on, and of
// settings.sky_paths paths where settings.sky_learning is, in rounds as above. `clusters` is null if there are not
// two lights, or more than 16 without a place; `sky`, if there is no such light. A pure function likewise.
LearnedLights learn_lights(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings);

// As trace_paths(), with settings.guide, on the lanes that the settings choose, with or without participating media.
// For the tallies of the path tracer.
template <class Tally>
RayCounts trace_guided_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                             const PathSettings& settings, const TilePass& pass, std::span<PixelSample> out,
                             Tally& tally);

}  // namespace montelux
