// Path tracing as the lecture notes of COS 526 write it (Funkhouser): at each surface either the emitted light is
// taken, with probability p_emit, or the reflected; and the reflected light is the sum of two recursive calls, one
// toward a light and one anywhere else. The notes halve both terms and divide the second by 1 - p_light; right is to
// divide each by the density of its own direction, since the two cover disjoint parts of the hemisphere:
//   toward the light  1 / (its solid angle),   elsewhere  1 / (2 pi - the light's solid angle above the horizon).
#pragma once
#include <vector>

#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/tracepath/settings.h"
#include "scene/scene.h"

namespace montelux {

class TracePathIntegrator final : public PixelIntegrator {
 public:
  // Scene and accel must outlive the integrator.
  TracePathIntegrator(const Scene& scene, const Accel& accel, const TracePathSettings& settings);
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  TracePathSettings settings_;
  std::vector<LightId> polygons_;  // the lights that can be aimed at
};

}  // namespace montelux
