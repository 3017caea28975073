#include "integrator/photons/entry.h"

#include <fmt/format.h>

#include "integrator/footprint.h"
#include "integrator/notes.h"
#include "integrator/photons/photonmap.h"
#include "integrator/photons/pilot.h"
#include "integrator/photons/sppm.h"

namespace montelux {

namespace {

Status check_medium_radius(float radius, const Scene& scene) {
  if (radius > 0 && !scene.has_participating_media())
    return Failure{"medium-radius is for participating media, and the scene has none"};
  return Done{};
}

void note_photons(ChosenIntegrator& chosen, const Scene& scene, float medium_radius) {
  if (scene.has_participating_media()) {
    chosen.biases.push_back(fmt::format("medium-radius={:.4g}", medium_radius));
    chosen.notes.push_back(
        fmt::format("in participating media photons are gathered within {:.4g} at first: the picture is biased where "
                    "light or the medium changes over that distance (see medium-radius)",
                    medium_radius));
  }
  if (scene.media.emits()) {
    chosen.biases.push_back("no photons of media");
    chosen.missing.push_back("indirect light of media that emit");
    chosen.notes.push_back("no photon starts in a medium that emits: the picture is biased by its indirect light");
  }
  if (scene.lights.has_masked()) {
    chosen.biases.push_back("no photons of masked emitters");
    chosen.missing.push_back("indirect light of emitters with an alpha mask");
    chosen.notes.push_back(
        "no photon starts at emitters with an alpha mask: the picture is biased by their indirect light");
  }
  note_facing_curves(chosen, scene);
}

Result<ChosenIntegrator> make_sppm(const IntegratorRequest& r) {
  auto settings = sppm_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  if (Status used = check_medium_radius(settings->medium_radius, r.scene); !used) return used.failure();
  const int width = r.width(), height = r.height();
  if (settings->medium_radius == 0 && r.scene.has_participating_media())
    settings->medium_radius =
        medium_radius_by_photons(PhotonPilot(r.scene, r.accel, sppm_paths(*settings, width * height)));
  if (settings->radius == 0) settings->radius = radius_by_footprint(r.scene, r.accel, width, height);
  ChosenIntegrator chosen = chosen_integrator("sppm", std::make_unique<SppmIntegrator>(r.scene, r.accel, *settings));
  note_radius(chosen, settings->radius);
  note_depth(chosen, r.max_depth);
  note_photons(chosen, r.scene, settings->medium_radius);
  return chosen;
}

Result<ChosenIntegrator> make_photonmap(const IntegratorRequest& r) {
  auto settings = photonmap_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  const int width = r.width(), height = r.height();
  if (Status used = check_medium_radius(settings->medium_radius, r.scene); !used) return used.failure();
  const bool in_media = r.scene.has_participating_media();
  if (settings->radius == 0 || (in_media && settings->medium_radius == 0)) {
    const PhotonPilot pilot(r.scene, r.accel, global_paths(*settings, width * height));
    if (settings->radius == 0) settings->radius = radius_by_photons(pilot, *settings);
    if (in_media && settings->medium_radius == 0) settings->medium_radius = medium_radius_by_photons(pilot, *settings);
  }
  if (settings->caustic_radius == 0) settings->caustic_radius = radius_by_footprint(r.scene, r.accel, width, height);
  ChosenIntegrator chosen =
      chosen_integrator("photonmap", std::make_unique<PhotonMapIntegrator>(r.scene, r.accel, *settings));
  const std::string nearest =
      settings->nearest > 0 ? fmt::format("the {} nearest photons", settings->nearest) : "the photons";
  chosen.biases.push_back(fmt::format("radius={:.4g}", settings->radius));
  if (settings->gather_rays > 0) {
    chosen.biases.push_back(fmt::format("caustic-radius={:.4g}", settings->caustic_radius));
    chosen.notes.push_back(fmt::format(
        "light is estimated by {} within {:.4g} at the ends of gather rays, and within {:.4g} for caustics: the "
        "picture "
        "is biased where light changes over that distance (more photons bias it less, see radius, caustic-radius and "
        "nearest)",
        nearest, settings->radius, settings->caustic_radius));
  } else {
    chosen.notes.push_back(
        fmt::format("light is estimated by {} within {:.4g} of the surfaces in view: the picture is biased where light "
                    "changes over "
                    "that distance (more photons bias it less, see radius and nearest)",
                    nearest, settings->radius));
  }
  note_depth(chosen, r.max_depth);
  note_photons(chosen, r.scene, settings->medium_radius);
  return chosen;
}

constexpr std::uint32_t photon_abilities = bits_of({Ability::shared_samples, Ability::media, Ability::layers});

}  // namespace

IntegratorEntry sppm_entry() {
  return {sppm_spec(), make_sppm, LightSearch::photons, Content::light, photon_abilities};
}
IntegratorEntry photonmap_entry() {
  return {photonmap_spec(), make_photonmap, LightSearch::photons, Content::light, photon_abilities};
}

}  // namespace montelux
