// Biases that several integrators share: what the header of an image states of them, and the sentence for people.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

// Paths end after so many scattering events, if there is a limit.
void note_depth(ChosenIntegrator& chosen, std::optional<int> max_depth);
// Where light at some surfaces is looked for by points of lights alone, as by this setting.
void note_masked(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting);
// Where directions are drawn without regard to the BSDF, as by this setting: none is that of a smooth coat's
// reflection.
void note_smooth_coats(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting);
// Where rays from the lights meet curves that face every ray.
void note_facing_curves(ChosenIntegrator& chosen, const Scene& scene);
// Where photons are gathered within a radius that shrinks.
void note_radius(ChosenIntegrator& chosen, float radius);

}  // namespace montelux
