#include "integrator/direct/entry.h"

#include <fmt/format.h>

#include "integrator/direct/integrator.h"
#include "integrator/notes.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_direct(const IntegratorRequest& r) {
  const DirectSettings settings = direct_settings(r.list);
  ChosenIntegrator chosen = chosen_integrator("direct", std::make_unique<DirectIntegrator>(r.scene, r.accel, settings));
  chosen.biases.push_back("direct light only");
  using enum DirectStrategy;
  const std::string strategy = fmt::format("strategy={}", direct_strategy_names[std::size_t(settings.strategy)]);
  if (settings.strategy == light_area || settings.strategy == light_solid_angle || settings.strategy == ris)
    note_masked(chosen, r.scene, strategy);
  if (settings.strategy != mis && settings.strategy != bsdf) note_smooth_coats(chosen, r.scene, strategy);
  const bool fixed = settings.pattern == PointSetKind::uniform_grid;
  if (fixed) chosen.biases.push_back("fixed shadow rays");
  if (fixed)
    chosen.notes.push_back(
        "the shadow rays go to the same places in every pass: the picture is biased, and its error bar does not show "
        "out");
  return chosen;
}

}  // namespace

IntegratorEntry direct_entry() {
  return {direct_spec(), make_direct, LightSearch::one_event, Content::light,
          bits_of({Ability::layers, Ability::absorption})};
}

}  // namespace montelux
