// Settings of the integrators by photons.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "parameter/choice.h"

namespace montelux {

// The weight of a photon by its distance from the point that gathers.
enum class PhotonKernel { constant, epanechnikov, cone };
NamedValues<PhotonKernel> photon_kernel_names();

// What paths from the eye do with photons.
struct GatheringRules {
  bool nee = true;               // direct light by points of lights and the BSDF; else by photons, too
  float glossy = 4;              // density per steradian above which a direction is followed instead
  std::optional<int> max_depth;  // scattering events between the light and the camera
  int roulette_depth = 2;        // scattering events of a path before roulette
  int gather_rays = 0;           // of each surface in view; 0: its photons are all the indirect light
};

struct SppmSettings {
  int photons = 0;          // light paths in each frame; 0: one for each pixel, and at least min_photons
  float radius = 0;         // of the first frame; 0: by the pixels' footprints
  float medium_radius = 0;  // the same in participating media; 0: by a pilot
  float alpha = 2.0f / 3;   // how much of the photons stays as the radius shrinks
  PhotonKernel kernel = PhotonKernel::epanechnikov;
  bool nee = true;               // direct light by points of lights and the BSDF; else by photons, too
  float glossy = 4;              // density per steradian above which a direction is followed instead
  int frames = 1024;             // of a series, at most
  std::optional<int> max_depth;  // scattering events between the light and the camera
  int roulette_depth = 2;        // scattering events of a path before roulette
  Lanes lanes = Lanes::native;

  GatheringRules gathering() const { return {nee, glossy, max_depth, roulette_depth}; }
};

struct PhotonMapSettings {
  int photons = 0;           // light paths of the global map; 0: one for each pixel, and at least min_photons
  int caustic_photons = 0;   // of the map of caustics, likewise
  int nearest = 0;           // photons of an estimate, at most; 0: all within the radius
  float radius = 0;          // of the global map, at most; 0: by a pilot
  float caustic_radius = 0;  // of the map of caustics, at most; 0: by the pixels' footprints
  float medium_radius = 0;   // of both maps' photons in participating media, at most; 0: by a pilot
  PhotonKernel kernel = PhotonKernel::epanechnikov;
  int gather_rays = 4;           // of each surface in view; 0: the global map is looked up there
  bool nee = true;               // direct light by points of lights and the BSDF; else by photons, too
  float glossy = 4;              // density per steradian above which a direction is followed instead
  int frames = 16;               // of a series, with the same maps, at most
  std::optional<int> max_depth;  // scattering events between the light and the camera
  int roulette_depth = 2;        // scattering events of a path before roulette
  Lanes lanes = Lanes::native;

  GatheringRules gathering() const { return {nee, glossy, max_depth, roulette_depth, gather_rays}; }
};

// Of small pictures.
inline constexpr int min_photons = 16384;

EntitySpec photonmap_spec();
Result<PhotonMapSettings> photonmap_settings(const ParameterList& list, std::optional<int> max_depth);
EntitySpec sppm_spec();
Result<SppmSettings> sppm_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
