// Settings of the direct-light integrator.
#pragma once
#include <optional>
#include <span>

#include "integrator/path/settings.h"
#include "math/result.h"
#include "mc/mis.h"
#include "mc/point_set.h"
#include "parameter/choice.h"

namespace montelux {

// How the light at the first surface is estimated: by points of lights, uniform in their area or in the solid angle
// under which they are seen; by directions of the hemisphere, uniform, by the cosine or by the BSDF; by both with
// multiple importance sampling; or by resampling of candidates on lights.
enum class DirectStrategy { light_area, light_solid_angle, uniform, cosine, bsdf, mis, ris };
inline constexpr std::array<std::string_view, 7> direct_strategy_names{
    "light-area", "light-solid-angle", "uniform", "cosine", "bsdf", "mis", "ris"};

struct DirectSettings {
  DirectStrategy strategy = DirectStrategy::mis;
  int shadow_rays = 1;                  // of each camera ray; mis: of each of its two techniques
  std::optional<PointSetKind> pattern;  // of the shadow rays; none: the render's point set, if there is one ray
  bool fixed = false;                   // every shadow ray goes to the same place: biased
  int candidates = 32;                  // ris: lights' points looked at for each shadow ray
  MisHeuristic heuristic = MisHeuristic::power;
  Lanes lanes = Lanes::native;
};

EntitySpec direct_spec();
DirectSettings direct_settings(const ParameterList& list);

// The comparisons of Hanrahan's lecture (CS348B, "Monte Carlo I: direct lighting"), by name.
struct DirectPreset {
  std::string_view name, meaning;
  int eye_rays;
  std::string_view integrator;  // as --integrator takes it
};
std::span<const DirectPreset> direct_presets();

}  // namespace montelux
