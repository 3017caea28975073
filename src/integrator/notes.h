// Biases that several integrators share: what the header of an image states of them, and the sentence for people.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

// Paths end after so many scattering events, if there is a limit.
void note_depth(ChosenIntegrator& chosen, std::optional<int> max_depth);
// Where this setting samples only points of lights, so that masked emitters are not found.
void note_masked(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting);
// Where this setting samples directions independently of the BSDF, and so never the mirror reflection of a smooth
// coat.
void note_smooth_coats(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting);
// Where rays from the lights meet curves that face every ray.
void note_facing_curves(ChosenIntegrator& chosen, const Scene& scene);
// Where photons are gathered within a radius that shrinks.
void note_radius(ChosenIntegrator& chosen, float radius);

}  // namespace montelux
