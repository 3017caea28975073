#include "integrator/tracepath/entry.h"

#include "integrator/notes.h"
#include "integrator/tracepath/integrator.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_tracepath(const IntegratorRequest& r) {
  TracePathSettings settings = tracepath_settings(r.list);
  settings.max_depth = r.max_depth;
  ChosenIntegrator chosen =
      chosen_integrator("tracepath", std::make_unique<TracePathIntegrator>(r.scene, r.accel, settings));
  // It aims at flat lamps, and elsewhere evenly.
  for (std::uint32_t i = 0; i < r.scene.lights.count(); ++i)
    if (r.scene.lights.polygon(LightId(i))) {
      note_smooth_coats(chosen, r.scene, "tracepath");
      break;
    }
  note_depth(chosen, r.max_depth);
  return chosen;
}

}  // namespace

IntegratorEntry tracepath_entry() {
  return {tracepath_spec(), make_tracepath, LightSearch::any_length, Content::light, bits_of({Ability::absorption})};
}

}  // namespace montelux
