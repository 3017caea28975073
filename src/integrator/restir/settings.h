// Settings of the integrators that reuse samples by reservoirs.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "mc/reuse.h"

namespace montelux {

struct RestirSettings {
  // Initial candidates of each pixel: lights chosen by the hierarchy, by power, and the direction of the BSDF.
  int candidates = 8, power_candidates = 0;
  bool bsdf_candidate = true;
  // Spatial reuse: in each of `rounds` rounds so many pixels at most `radius` pixels away.
  int neighbours = 5, rounds = 1;
  float radius = 30;
  // Neighbours whose surface looks another way, or lies at another depth, are passed over.
  bool similar = true;
  // The pixel's own reservoir of the frame before, of at most m_cap times the confidence of a new one.
  bool temporal = true;
  float m_cap = 20;
  // In a sequence, chains go on from each picture to the next.
  bool carry = true;
  ReuseWeights weights = ReuseWeights::pairwise;
  // Targets know what is in the way: more shadow rays, better samples.
  bool visibility_reuse = false;
  int chain = 16, warm_up = 0;  // frames of a chain; those before them that only teach
  PathSettings path;            // of the light that is not reused
};

EntitySpec restir_di_spec();
// max_depth is that of the request, since a scene may state it too.
Result<RestirSettings> restir_di_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
