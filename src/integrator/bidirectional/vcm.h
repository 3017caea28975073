// Vertex connection and merging (Georgiev et al. 2012; Hachisuka, Pantaleoni and Jensen 2012): bidirectional path
// tracing, whose subpaths are also merged where their vertices lie within a radius. The radii are those of Knaus and
// Zwicker (2011), as for `sppm`.
#pragma once
#include "accel/accel.h"
#include "integrator/bidirectional/settings.h"
#include "integrator/integrator.h"
#include "integrator/light_paths/light_media.h"
#include "scene/scene.h"

namespace montelux {

// Each frame follows subpaths from the lights, stores their vertices as photons and splats them; then follows a subpath
// from each pixel, which is connected with the pixel's own subpath from the lights and merged with all of them. The
// pixel's own one is followed again instead of being kept: the vertices of a whole picture would need gigabytes.
class VcmIntegrator final : public CoupledIntegrator {
 public:
  // Scene and accel must outlive the integrator, and the integrator its series. Its radius is set.
  VcmIntegrator(const Scene& scene, const Accel& accel, const VcmSettings& settings);

  int frames() const override { return settings_.frames; }
  int warm_up() const override { return 0; }
  int stages() const override;
  bool has_layers() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  VcmSettings settings_;
  std::optional<AliasTable> by_power_;     // none: there is no light
  std::optional<LightSet> compensated_;    // as BidirectionalFrame has it
  std::optional<LightMedia> light_media_;  // none: the scene has no media, or no light
};

}  // namespace montelux
