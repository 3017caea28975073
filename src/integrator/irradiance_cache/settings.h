// Settings of the irradiance cache.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "parameter/choice.h"

namespace montelux {

struct IrradianceCacheSettings {
  float accuracy = 0.4f;         // Ward's a: the largest estimated error of a record where it counts
  int samples = 128;             // directions of a record, about
  float min_spacing = 0;         // least radius within which a record counts, world units; 0: by the pixels
  float max_spacing = 0;         // largest one; 0: by the scene's size
  bool gradients = true;         // records are extrapolated by their gradients
  bool clamping = true;          // neighbours bound each other's distances
  int records = 1 << 18;         // at most
  float pairs = 0.001f;          // share of the samples that are compared with unbiased ones
  int frames = 16;               // of a series, at most
  int roulette_depth = 2;        // scattering events before roulette
  std::optional<int> max_depth;  // of scattering events; none: roulette alone ends paths
  Lanes lanes = Lanes::native;
};

EntitySpec irradiance_cache_spec();
Result<IrradianceCacheSettings> irradiance_cache_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
