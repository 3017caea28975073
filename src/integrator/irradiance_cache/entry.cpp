#include "integrator/irradiance_cache/entry.h"

#include <fmt/format.h>

#include "integrator/footprint.h"
#include "integrator/irradiance_cache/integrator.h"
#include "integrator/notes.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_irradiance_cache(const IntegratorRequest& r) {
  auto settings = irradiance_cache_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  if (r.scene.geometry.moves())
    return Failure{"irradiance-cache is only for scenes without motion; \"path\" supports all"};
  // The least radius by the footprint of the pixels, which radius_by_footprint states for three of them.
  if (settings->min_spacing == 0)
    settings->min_spacing = radius_by_footprint(r.scene, r.accel, r.width(), r.height()) * (2.0f / 3);
  if (settings->max_spacing == 0) {
    const float diagonal = r.scene.bounds.is_empty() ? 1.0f : length(r.scene.bounds.high - r.scene.bounds.low);
    settings->max_spacing = std::max(0.05f * diagonal, settings->min_spacing);
  }
  ChosenIntegrator chosen =
      chosen_integrator("irradiance-cache", std::make_unique<IrradianceCacheIntegrator>(r.scene, r.accel, *settings));
  chosen.biases.push_back(fmt::format("accuracy={:.4g}", settings->accuracy));
  chosen.notes.push_back(
      fmt::format("indirect light at diffuse surfaces is interpolated within {:.4g} of its distance from other "
                  "surfaces: the picture is biased where it changes faster (--set accuracy=... bounds it)",
                  settings->accuracy));
  note_depth(chosen, r.max_depth);
  return chosen;
}

}  // namespace

IntegratorEntry irradiance_cache_entry() {
  return {irradiance_cache_spec(), make_irradiance_cache, LightSearch::any_length, Content::light,
          bits_of({Ability::shared_samples, Ability::layers, Ability::media})};
}

}  // namespace montelux
