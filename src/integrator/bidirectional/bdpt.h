// Bidirectional path tracing (Lafortune and Willems 1993; Veach and Guibas 1994; Veach 1997, ch. 10): every vertex of a
// path from the eye is connected with every vertex of one from the lights, and all strategies that find a path share it
// by multiple importance sampling.
#pragma once
#include "accel/accel.h"
#include "integrator/bidirectional/settings.h"
#include "integrator/integrator.h"
#include "integrator/light_paths/light_media.h"
#include "scene/scene.h"

namespace montelux {

// Each frame follows a pair of subpaths for each pixel in two stages: paths add what the lens sees of light vertices to
// a plane of exact sums, then tiles read their pixels. So a frame is the same bits for any number of threads.
class BdptIntegrator final : public CoupledIntegrator {
 public:
  // Scene and accel must outlive the integrator, and the integrator its series.
  BdptIntegrator(const Scene& scene, const Accel& accel, const BidirectionalPaths& paths);

  int frames() const override { return 16; }
  int warm_up() const override { return 0; }
  int stages() const override { return 2; }
  bool has_layers() const override { return true; }
  bool splats() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  BidirectionalPaths paths_;
  std::optional<AliasTable> by_power_;     // none: there is no light
  std::optional<LightSet> compensated_;    // as BidirectionalFrame has it
  std::optional<LightMedia> light_media_;  // none: the scene has no media, or no light
};

}  // namespace montelux
