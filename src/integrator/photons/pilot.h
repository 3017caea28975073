// Radii that hold a number of photons where light is neither bright nor dim, by a pilot of light paths.
#pragma once
#include <vector>

#include "accel/accel.h"
#include "integrator/photons/lights.h"
#include "integrator/photons/photon_map.h"

namespace montelux {

class PhotonPilot {
 public:
  // Follows a few of the light paths of a map. Scene and accel are not kept.
  PhotonPilot(const Scene& scene, const Accel& accel, const PhotonPaths& paths);

  // The radius of the disk that holds so many photons of the whole map at the median photon of the pilot's on surfaces;
  // at most a tenth of the scene's diagonal, which it is where the pilot leaves too few photons.
  float radius(double photons) const { return radius_of(surfaces_, photons, 2, 0.1f); }
  // Likewise of the ball in media, at most this share of the diagonal.
  float medium_radius(double photons, float max_share) const { return radius_of(media_, photons, 3, max_share); }

 private:
  float radius_of(const std::vector<Photon>& photons, double held, int dimensions, float max_share) const;

  float diagonal_;  // of the scene
  double share_;    // of the map's paths that the pilot follows
  std::vector<Photon> surfaces_, media_;
};

// The radii of photonmap's global map that are not stated.
float radius_by_photons(const PhotonPilot& pilot, const PhotonMapSettings& settings);
float medium_radius_by_photons(const PhotonPilot& pilot, const PhotonMapSettings& settings);
// The radius of sppm's first frame in media.
float medium_radius_by_photons(const PhotonPilot& pilot);

}  // namespace montelux
