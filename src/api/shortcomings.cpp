#include "api/shortcomings.h"

#include "api/render.h"
#include "integrator/missing_light.h"

namespace montelux {

IntegratorDefaults integrator_defaults(const PictureSettings& picture) {
  return {picture.max_depth, picture.max_component, picture.width, picture.height};
}

void note_light(ChosenIntegrator& chosen, const LoadedScene::Parts& parts) {
  if (chosen.search != LightSearch::none && parts.scene.lights.count() == 0 && !parts.scene.media.emits())
    chosen.notes.push_back("the scene has no light: the image is black");
  note_missing_light(chosen, integrator_defaults(parts.picture), parts.scene, *parts.accel);
}

std::vector<Replacement> replaced_in(const SceneInfo& scene, bool chooses_integrator, bool chooses_sampler) {
  std::vector<Replacement> replaced = scene.replaced;
  std::erase_if(replaced, [&](const Replacement& r) {
    return (r.family == "integrator" && chooses_integrator) || (r.family == "sampler" && chooses_sampler);
  });
  return replaced;
}

std::vector<std::string> missing_light_of(const LoadedScene& scene) {
  const LoadedScene::Parts& parts = scene.parts();
  const IntegratorDefaults defaults = integrator_defaults(parts.picture);
  std::vector<std::string> names;
  const std::string& stated = parts.picture.integrator;
  for (const MissingLight& light : missing_light(light_search(stated), parts.scene, *parts.accel, defaults.width,
                                                 defaults.height, stated_chain_length(stated)))
    names.push_back(light.name);
  return names;
}

}  // namespace montelux
