// What pictures of a scene lack of what its file names. Inside the facade only.
#pragma once
#include "api/parts.h"
#include "integrator/catalogue.h"

namespace montelux {

// What the file states for all integrators.
IntegratorDefaults integrator_defaults(const PictureSettings& picture);

// Adds to what is missing, and to the notes, the light of the scene that pictures of this integrator do not show.
void note_light(ChosenIntegrator& chosen, const LoadedScene::Parts& parts);

// What serves for names of the file, but for those that a choice of the user takes the place of.
std::vector<Replacement> replaced_in(const SceneInfo& scene, bool chooses_integrator, bool chooses_sampler);

}  // namespace montelux
