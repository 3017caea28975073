#include "integrator/bidirectional/entry.h"

#include "integrator/bidirectional/bdpt.h"
#include "integrator/bidirectional/vcm.h"
#include "integrator/footprint.h"
#include "integrator/notes.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_bdpt(const IntegratorRequest& r) {
  ChosenIntegrator chosen =
      chosen_integrator("bdpt", std::make_unique<BdptIntegrator>(r.scene, r.accel, bdpt_settings(r.list, r.max_depth)));
  note_depth(chosen, r.max_depth);
  note_facing_curves(chosen, r.scene);
  return chosen;
}

Result<ChosenIntegrator> make_vcm(const IntegratorRequest& r) {
  VcmSettings settings = vcm_settings(r.list, r.max_depth);
  if (!settings.paths.connect && r.scene.has_participating_media())
    return Failure{
        "the scene has participating media, where vcm does not merge vertices: there it needs connections "
        "(--set connect=on)"};
  if (settings.radius == 0) settings.radius = radius_by_footprint(r.scene, r.accel, r.width(), r.height());
  ChosenIntegrator chosen = chosen_integrator("vcm", std::make_unique<VcmIntegrator>(r.scene, r.accel, settings));
  note_radius(chosen, settings.radius);
  note_depth(chosen, r.max_depth);
  if (!settings.paths.connect && r.scene.lights.has_masked()) {
    chosen.biases.push_back("no photons of masked emitters");
    chosen.missing.push_back("light of emitters with an alpha mask");
    chosen.notes.push_back("no photon starts at emitters with an alpha mask: the picture is biased by their light");
  }
  note_facing_curves(chosen, r.scene);
  return chosen;
}

constexpr std::uint32_t connecting =
    bits_of({Ability::shared_samples, Ability::media, Ability::layers, Ability::strategies});

}  // namespace

IntegratorEntry bdpt_entry() { return {bdpt_spec(), make_bdpt, LightSearch::both_ends, Content::light, connecting}; }
IntegratorEntry vcm_entry() {
  return {vcm_spec(), make_vcm, LightSearch::photons, Content::light, connecting | bits_of({Ability::mergings})};
}

}  // namespace montelux
