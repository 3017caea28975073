// Every integrator by name: what it takes, and how it is made.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "integrator/chosen.h"

namespace montelux {

// For parsers, --help and documentation.
std::span<const EntitySpec> integrator_catalogue();

// Those that can with any settings.
std::vector<std::string_view> integrators_with(Ability ability);

// Adds to the biases and notes what the render's point set contributes: nothing, except for fixed patterns.
void note_sampler(ChosenIntegrator& chosen, PointSetKind kind);

// Adds to what is missing, and to the notes, the light of the scene that the integrator cannot find. Looks for it by
// walks through the scene (missing_light.h), which may take milliseconds.
void note_missing_light(ChosenIntegrator& chosen, const IntegratorDefaults& defaults, const Scene& scene,
                        const Accel& accel);

// How an integrator of the catalogue looks for light; `text`: its name, perhaps with settings.
LightSearch light_search(std::string_view text);
// The same choice, whose settings have their present names where they were stated by earlier ones.
ChoiceText with_present_names(ChoiceText choice);
// Its ChosenIntegrator::chain_length.
int stated_chain_length(std::string_view text);

// Whether name and settings are in the catalogue, for a message before the scene is read.
Status check_integrator(const ChoiceText& choice);

// Fails where the name or a setting is not in the catalogue, or does not fit the scene.
Result<ChosenIntegrator> choose_integrator(const ChoiceText& choice, const IntegratorDefaults& defaults,
                                           const Scene& scene, const Accel& accel);

}  // namespace montelux
