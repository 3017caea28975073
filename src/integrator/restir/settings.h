// Settings of the integrators that reuse samples by reservoirs.
#pragma once
#include <optional>

#include "integrator/path/settings.h"
#include "mc/reuse.h"

namespace montelux {

// How the light that reaches a pixel's vertex by more than one event is shared.
struct PathReuse {
  bool on = false;
  // Events that another pixel may scatter again before its path is joined to what was found.
  int max_replayed = 0;
  // Paths are joined to surfaces; no: to points of lights alone.
  bool joins = true;
  // Squared distance that the lobes of a joint must cover, over that of the pixel's vertex from the camera.
  float footprint = 1e-3f;
};

struct RestirSettings {
  // Initial candidates of each pixel: lights chosen by the hierarchy, by power, and the direction of the BSDF.
  int candidates = 4, power_candidates = 0;
  bool bsdf_candidate = true;
  // Spatial reuse, in each of `rounds` rounds. In groups: a pixel and so many neighbours, of one block of 2 radius
  // pixels, try all of their samples at all of these pixels. Else so many pixels for each pixel, at most `radius`
  // pixels away.
  bool groups = true;
  int neighbours = 15, rounds = 1;
  float radius = 2;
  // In groups: pixels of one object are grouped first. Else: neighbours whose surface has a different normal or depth
  // are skipped.
  bool similar = true;
  // The pixel's own reservoir of the frame before, of at most m_cap times the confidence of a new one; for a picture's
  // first frame, that of the picture before.
  bool temporal = true;
  float m_cap = 20;
  // In a sequence, series continue from each picture to the next.
  bool carry = true;
  ReuseWeights weights = ReuseWeights::pairwise;
  // Targets of direct light include visibility: more shadow rays, better samples.
  bool visibility_reuse = true;
  int frames = 16, warm_up = 0;  // frames of a series; preceding ones that only fill reservoirs
  // Direct light at the first rough surface is shared; no: it is each pixel's own.
  bool direct = true;
  PathReuse indirect;
  PathSettings path;  // of the light that is not reused

  // A sample takes longer than one of `path`: more rays for lamps pay off.
  RestirSettings() { path.lamp_rays = 8; }
};

EntitySpec restir_di_spec();
EntitySpec restir_gi_spec();
EntitySpec restir_pt_spec();
// max_depth is that of the request, since a scene may state it too. `name` is that of one of these entities.
Result<RestirSettings> restir_settings(std::string_view name, const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
