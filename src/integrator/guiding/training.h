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

// A field of the directions from which the brightest light from infinity reaches the vertices of paths, by shadow rays
// from the vertices of settings.sky_paths paths, in rounds as above. Null if there is no such light. A pure function
// likewise.
std::shared_ptr<const SkyField> learn_sky(const Scene& scene, const LightSet& lights, const Accel& rays,
                                          const PathSettings& settings);

// A field of how much of what clusters of lights can send arrives at the vertices of paths, by shadow rays from those
// of settings.light_paths paths, in rounds as above. Null if the hierarchy of `lights` has fewer than two. A pure
// function likewise.
std::shared_ptr<const ClusterField> learn_clusters(const Scene& scene, const LightSet& lights, const Accel& rays,
                                                   const PathSettings& settings);

// As trace_paths(), with settings.guide, on the lanes that the settings choose, with or without participating media.
// For the tallies of the path tracer.
template <class Tally>
RayCounts trace_guided_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                             const PathSettings& settings, const TilePass& pass, std::span<PixelSample> out,
                             Tally& tally);

}  // namespace montelux
