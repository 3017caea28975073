// Stochastic progressive photon mapping (Hachisuka and Jensen 2009), with the radii of Knaus and Zwicker (2011,
// "Progressive Photon Mapping: A Probabilistic Approach"), which are known beforehand: nothing is remembered but the
// photons of one frame.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/photons/lights.h"
#include "integrator/photons/settings.h"
#include "scene/scene.h"

namespace montelux {

// The light paths of a frame.
PhotonPaths sppm_paths(const SppmSettings& settings, int pixels);

// The radius of a frame: r_1 = radius, r_{i+1}^d = r_i^d (i + alpha) / (i + 1), where d = 2 for the disks of surfaces
// and 3 for the balls of media (Knaus and Zwicker 2011, sec. 4). For alpha between 0 and 1 the mean over n frames loses
// both its bias, as n^(2 (alpha - 1) / d), and its variance, as n^-alpha.
double sppm_radius(double radius, double alpha, int frame, int dimensions = 2);

// Each frame follows light paths, stores their photons, and gathers them by a path from each pixel.
class SppmIntegrator final : public CoupledIntegrator {
 public:
  // Scene and accel must outlive the integrator, and the integrator its series. Its radius is set.
  SppmIntegrator(const Scene& scene, const Accel& accel, const SppmSettings& settings);

  int frames() const override { return settings_.frames; }
  int warm_up() const override { return 0; }
  int stages() const override;
  bool has_layers() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  SppmSettings settings_;
  PhotonLights lights_;
};

}  // namespace montelux
