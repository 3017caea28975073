// The paths from whose vertices something is learned before a render.
#pragma once
#include <functional>
#include <span>

#include "accel/accel.h"
#include "integrator/guiding/records.h"
#include "integrator/path/settings.h"

namespace montelux {

// Some of them, spread over the picture.
struct TrainingRound {
  std::uint32_t number;  // 1, 2, ...
  double paths;
  double before = 0;  // paths of the rounds before
};

using TakeRecord = std::function<void(const GuideRecord&)>;

// Settings of paths that teach, with a guide that knows nothing.
PathSettings for_training(const PathSettings& settings);

// Calls take for every record of the paths of a round, in the order of the paths.
void trace_round(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings,
                 const TrainingRound& round, const TakeRecord& take);

// Where a few paths come, which are of no round.
std::vector<Vec3f> places_of_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                                   const PathSettings& settings);

// Calls learn(round) for rounds that each have twice as many paths as the one before. One round ends at each of the
// totals, and the last one at the greatest of them.
void for_each_round(std::span<const double> totals, const std::function<void(const TrainingRound&)>& learn);

}  // namespace montelux
