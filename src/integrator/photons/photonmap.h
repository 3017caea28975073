// Photon mapping in two passes (Jensen 1996, "Global Illumination Using Photon Maps"): photons are stored in a global
// map and in a map of caustics, and the picture is made by paths from the eye with a final gathering.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/photons/lights.h"
#include "integrator/photons/settings.h"
#include "scene/scene.h"

namespace montelux {

// The light paths of the global map: where it is looked up beyond the surfaces in view, direct light is among its
// photons.
PhotonPaths global_paths(const PhotonMapSettings& settings, int pixels);

// A series traces maps of its own in its first frame, and gathers in all of them; where surfaces move each frame has
// its own maps.
class PhotonMapIntegrator final : public CoupledIntegrator {
 public:
  // Scene and accel must outlive the integrator, and the integrator its series. Its radii are set.
  PhotonMapIntegrator(const Scene& scene, const Accel& accel, const PhotonMapSettings& settings);

  int frames() const override { return settings_.frames; }
  int warm_up() const override { return 0; }
  int stages() const override;
  bool has_layers() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  const PhotonMapSettings settings_;
  PhotonLights lights_;
};

}  // namespace montelux
