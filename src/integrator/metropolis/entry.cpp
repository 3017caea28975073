#include "integrator/metropolis/entry.h"

#include "integrator/metropolis/integrator.h"
#include "integrator/notes.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_metropolis(const IntegratorRequest& r) {
  MetropolisSettings settings = metropolis_settings(r.list, r.max_depth);
  settings.width = r.defaults.width, settings.height = r.defaults.height;
  ChosenIntegrator chosen =
      chosen_integrator("metropolis", std::make_unique<MetropolisIntegrator>(r.scene, r.accel, settings));
  note_depth(chosen, r.max_depth);
  if (settings.strategies == MetropolisStrategies::bdpt) note_facing_curves(chosen, r.scene);
  return chosen;
}

bool from_both_ends(const ParameterList& list) {
  return metropolis_settings(list, {}).strategies == MetropolisStrategies::bdpt;
}
LightSearch metropolis_search(const ParameterList& list) {
  return from_both_ends(list) ? LightSearch::both_ends : LightSearch::any_length;
}
std::uint32_t metropolis_abilities(const ParameterList& list) {
  return from_both_ends(list) ? std::uint32_t(Ability::strategies) : 0;
}

}  // namespace

IntegratorEntry metropolis_entry() {
  return {metropolis_spec(),
          make_metropolis,
          LightSearch::any_length,
          Content::light,
          bits_of({Ability::shared_samples, Ability::media, Ability::layers}),
          metropolis_search,
          metropolis_abilities};
}

}  // namespace montelux
