// Every integrator by name: what it takes, and how it is made.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "image/display.h"
#include "integrator/integrator.h"
#include "integrator/path_classes.h"
#include "parameter/choice.h"
#include "scene/scene.h"

namespace montelux {

// For parsers, --help and documentation.
std::span<const EntitySpec> integrator_catalogue();

// What only some integrators can do.
enum class Ability : std::uint32_t {
  media = 1,   // cross participating media
  layers = 2,  // PixelIntegrator::trace_layers, FrameSeries::run_layers
  paths = 4,   // PixelIntegrator::trace_path
  // What its pixels do rather than can: they share samples within a pass, so that their errors are correlated.
  shared_samples = 8,
  strategies = 16,  // its layers may be those of bidirectional strategies
  mergings = 32,    // which may merge vertices
};
// Those that can with any settings.
std::vector<std::string_view> integrators_with(Ability ability);

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
  std::unique_ptr<CoupledIntegrator> coupled;   // of an integrator whose pixels share samples
  LightSearch search = LightSearch::any_length;
  int chain_length = 0;                // of LightSearch::with_chains: specular events of a connection at most
  Content content = Content::light;    // what its pictures hold, and so how they are displayed
  std::vector<std::string> missing{};  // sorts of light in the scene that it cannot find; notes say why
  std::uint32_t abilities = 0;         // those of its row in the catalogue, and of its settings
  bool can(Ability ability) const { return (abilities & std::uint32_t(ability)) != 0; }
  AnyIntegrator any() const { return coupled ? AnyIntegrator(*coupled) : AnyIntegrator(*integrator); }
};

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
int chain_length(std::string_view text);

// Whether name and settings are in the catalogue, for a message before the scene is read.
Status check_integrator(const ChoiceText& choice);

// Fails where the name or a setting is not in the catalogue, or does not fit the scene.
Result<ChosenIntegrator> choose_integrator(const ChoiceText& choice, const IntegratorDefaults& defaults,
                                           const Scene& scene, const Accel& accel);

}  // namespace montelux
