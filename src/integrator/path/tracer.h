// Path tracing with next-event estimation: at each vertex one direction toward a light and one by the BSDF, combined by
// multiple importance sampling; Russian roulette ends the path (Kajiya 1986; Veach 1997, ch. 9 and 10).
#pragma once
#include "accel/accel.h"
#include "integrator/layered.h"
#include "integrator/path/settings.h"
#include "integrator/path/survival.h"
#include "scene/scene.h"

namespace montelux {

class PathTracer final : public LayeredIntegrator<PathTracer> {
 public:
  // Scene and accel must outlive the tracer.
  PathTracer(const Scene& scene, const Accel& accel, const PathSettings& settings);
  std::optional<TracedPath> trace_path(const TilePass& pass) const override;

 private:
  friend LayeredIntegrator<PathTracer>;
  // The pilot of PathRoulette::efficiency: some pixels of every block of the picture.
  SurvivalMap run_pilot() const;
  template <class Tally>
  RayCounts trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const;
  const LightSet& lights() const { return own_lights_ ? *own_lights_ : scene_.lights; }
  const Scene& scene_;
  const Accel& accel_;
  PathSettings settings_;
  std::optional<LightSet> own_lights_;  // where they are chosen in another way than the scene's
};
extern template class LayeredIntegrator<PathTracer>;

}  // namespace montelux
