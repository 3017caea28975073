// Every integrator by name: what it takes, and how it is made.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "accel/accel.h"
#include "integrator/integrator.h"
#include "parameter/choice.h"
#include "scene/scene.h"

namespace montelux {

// For parsers, --help and documentation.
std::span<const EntitySpec> integrator_catalogue();

// What a scene file states for all integrators; a setting of the same name wins.
struct IntegratorDefaults {
  std::optional<int> max_depth;
  std::optional<float> max_component;
  int width = 0, height = 0;  // of the picture
};

struct ChosenIntegrator {
  std::string name;                             // of the catalogue
  std::unique_ptr<PixelIntegrator> integrator;  // scene and accel must outlive it; null: it is coupled
  std::vector<std::string> biases;              // "maxdepth=5", ...: what makes its mean differ from the scene's light
  std::vector<std::string> notes;               // the same for people, in sentences
  std::unique_ptr<CoupledIntegrator> coupled;   // of an integrator whose pixels learn from each other
  AnyIntegrator any() const { return coupled ? AnyIntegrator(*coupled) : AnyIntegrator(*integrator); }
};

// Adds to the biases and notes what the render's point set brings: nothing, but for fixed patterns.
void note_sampler(ChosenIntegrator& chosen, PointSetKind kind);

// Whether name and settings are in the catalogue, for a message before the scene is read.
Status check_integrator(const ChoiceText& choice);

// Fails where the name or a setting is not in the catalogue, or does not fit the scene.
Result<ChosenIntegrator> choose_integrator(const ChoiceText& choice, const IntegratorDefaults& defaults,
                                           const Scene& scene, const Accel& accel);

}  // namespace montelux
