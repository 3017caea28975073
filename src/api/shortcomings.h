// What images of a scene lack in comparison with its file. Internal to the facade.
#pragma once
#include "api/parts.h"
#include "integrator/catalogue.h"

namespace montelux {

// The settings that the file states for all integrators.
IntegratorDefaults integrator_defaults(const PictureSettings& picture);

// Adds the light of the scene that images by this integrator do not show to the missing light and to the notes.
void note_light(ChosenIntegrator& chosen, const LoadedScene::Parts& parts);

// The substitutes for names in the file, except for those that the user overrides.
std::vector<Replacement> replaced_in(const SceneInfo& scene, bool chooses_integrator, bool chooses_sampler);

}  // namespace montelux
