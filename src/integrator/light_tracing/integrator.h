// Light tracing: paths from the lights (Arvo 1986; Dutre, Lafortune and Willems 1993), of which every vertex is
// connected with the lens. The estimator is that of path tracing's adjoint (Veach 1997, ch. 4 and 8): it finds light
// that mirrors and glass focus on rough surfaces, and nothing that the lens sees in them.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/light_paths/light_media.h"
#include "integrator/light_tracing/settings.h"
#include "scene/scene.h"

namespace montelux {

// Each frame follows one light path for each pixel, from whatever light to whatever pixels, in two stages: paths add to
// a plane of exact sums, tiles read their pixels. So a frame is the same bits for any number of threads. With a grid a
// frame has one light path for each cell, and splats reach only the pixels that represent cells.
class LightTracer final : public CoupledIntegrator {
 public:
  // Fails where camera rays go through the centres of pixels alone, where no light path arrives. Scene and accel must
  // outlive the integrator, and the integrator its series.
  static Result<std::unique_ptr<LightTracer>> make(const Scene& scene, const Accel& accel,
                                                   const LightTracingSettings& settings);

  int frames() const override { return 16; }
  int warm_up() const override { return 0; }
  int stages() const override { return 2; }
  bool has_layers() const override { return true; }
  bool splats() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  LightTracer(const Scene& scene, const Accel& accel, const LightTracingSettings& settings);

  const Scene& scene_;
  const Accel& accel_;
  LightTracingSettings settings_;
  std::optional<AliasTable> by_power_;     // none: there is no light
  std::optional<LightMedia> light_media_;  // none: the scene has no media, or no light
};

}  // namespace montelux
