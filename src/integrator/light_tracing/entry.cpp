#include "integrator/light_tracing/entry.h"

#include "integrator/light_tracing/integrator.h"
#include "integrator/notes.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_light(const IntegratorRequest& r) {
  auto integrator = LightTracer::make(r.scene, r.accel, light_tracing_settings(r.list, r.max_depth));
  if (!integrator) return integrator.failure();
  ChosenIntegrator chosen = chosen_integrator("light", *std::move(integrator));
  note_depth(chosen, r.max_depth);
  if (r.scene.lights.has_masked()) {
    chosen.biases.push_back("no masked emitters");
    chosen.missing.push_back("light of emitters with an alpha mask");
    chosen.notes.push_back("no path starts at emitters with an alpha mask: the picture is biased by their light");
  }
  if (!r.scene.camera.sees_directions() && r.scene.lights.infinite_count() > 0) {
    chosen.biases.push_back("no sky behind the scene");
    chosen.missing.push_back("the sky that the camera sees directly");
    chosen.notes.push_back(
        "an orthographic camera sees the sky in a few directions, which no path from the sky takes: the picture is "
        "black where no surface is");
  }
  if (r.scene.media.emits()) {
    chosen.biases.push_back("no emission of media");
    chosen.missing.push_back("light that media emit");
    chosen.notes.push_back("no path starts in a medium that emits: the picture is biased by its light");
  }
  note_facing_curves(chosen, r.scene);
  return chosen;
}

}  // namespace

IntegratorEntry light_tracing_entry() {
  return {light_tracing_spec(), make_light, LightSearch::from_lights, Content::light,
          bits_of({Ability::shared_samples, Ability::media, Ability::layers, Ability::strategies})};
}

}  // namespace montelux
