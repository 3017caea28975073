// Settings of the bidirectional integrators.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "integrator/photons/settings.h"
#include "parameter/choice.h"

namespace montelux {

// How the strategies share the light that several of them find.
enum class BidirectionalMis { balance, power };

// Both subpaths.
struct BidirectionalPaths {
  std::optional<int> max_depth;  // of scattering events between the light and the camera
  int roulette_depth = 2;        // scattering events of a subpath before roulette
  BidirectionalMis mis = BidirectionalMis::power;
  bool connect = true;  // vertices with each other, with lights and with the lens; else they are merged alone
  Lanes lanes = Lanes::native;
};

// With vertices of the two subpaths that are merged where they lie within a radius.
struct VcmSettings {
  BidirectionalPaths paths;
  int photons = 0;         // subpaths from the lights in each frame; 0: one for each pixel, and at least min_photons
  float radius = 0;        // of the first frame; 0: by the pixels' footprints
  float alpha = 2.0f / 3;  // how much of the photons stays as the radius shrinks
  PhotonKernel kernel = PhotonKernel::epanechnikov;
  int frames = 1024;  // of a series, at most
};

EntitySpec bdpt_spec();
BidirectionalPaths bdpt_settings(const ParameterList& list, std::optional<int> max_depth);
EntitySpec vcm_spec();
VcmSettings vcm_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
