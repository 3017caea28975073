#include "integrator/distribution/entry.h"

#include "integrator/distribution/integrator.h"
#include "integrator/notes.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_distribution(const IntegratorRequest& r) {
  auto settings = distribution_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  ChosenIntegrator chosen =
      chosen_integrator("distribution", std::make_unique<DistributionIntegrator>(r.scene, r.accel, *settings));
  note_depth(chosen, r.max_depth);
  return chosen;
}

}  // namespace

IntegratorEntry distribution_entry() {
  return {distribution_spec(), make_distribution, LightSearch::any_length, Content::light,
          bits_of({Ability::layers, Ability::absorption})};
}

}  // namespace montelux
