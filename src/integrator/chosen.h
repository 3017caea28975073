// An integrator that was chosen for a scene, with what a user must know of its images.
#pragma once
#include <algorithm>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "accel/accel.h"
#include "image/display.h"
#include "integrator/chance_light.h"
#include "integrator/integrator.h"
#include "integrator/path_classes.h"
#include "parameter/choice.h"
#include "scene/scene.h"

namespace montelux {

// What only some integrators can do.
enum class Ability : std::uint32_t {
  media = 1,   // cross participating media
  layers = 2,  // PixelIntegrator::trace_layers, FrameSeries::run_layers
  paths = 4,   // PixelIntegrator::trace_path
  // What its pixels do rather than can: they share samples within a pass, so that their errors are correlated.
  shared_samples = 8,
  strategies = 16,  // its layers may be those of bidirectional strategies
  mergings = 32,    // which may merge vertices
  absorption =
      64,  // where the scene's media do not participate (Scene::has_participating_media), heed what they absorb
};
constexpr std::uint32_t bits_of(std::initializer_list<Ability> abilities) {
  std::uint32_t bits = 0;
  for (const Ability ability : abilities) bits |= std::uint32_t(ability);
  return bits;
}

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
  int chain_length = 0;  // of LightSearch::with_chains: specular events of a connection at most
  ChanceLights chance_lights = ChanceLights::specular;
  Rgb max_chance_radiance{};           // of these lights: no sample that meets one by chance is brighter
  Content content = Content::light;    // what its pictures hold, and so how they are displayed
  std::vector<std::string> missing{};  // sorts of light in the scene that it cannot find; notes say why
  std::uint32_t abilities = 0;         // those of its row in the catalogue, and of its settings
  bool can(Ability ability) const { return (abilities & std::uint32_t(ability)) != 0; }
  AnyIntegrator any() const { return coupled ? AnyIntegrator(*coupled) : AnyIntegrator(*integrator); }
};

// Without biases, notes and abilities, which follow.
ChosenIntegrator chosen_integrator(std::string_view name, std::unique_ptr<PixelIntegrator> integrator);
ChosenIntegrator chosen_integrator(std::string_view name, std::unique_ptr<CoupledIntegrator> coupled);

// What the entry of an integrator in the catalogue is made from: its settings, read, and the scene.
struct IntegratorRequest {
  const ParameterList& list;
  std::optional<int> max_depth;  // by a setting or by the scene
  const IntegratorDefaults& defaults;
  const Scene& scene;
  const Accel& accel;

  // The size of the picture, at least 1 x 1.
  int width() const { return std::max(defaults.width, 1); }
  int height() const { return std::max(defaults.height, 1); }
};

// What the catalogue states of an integrator. Each folder of integrators gives those of its own.
struct IntegratorEntry {
  EntitySpec spec;
  Result<ChosenIntegrator> (*make)(const IntegratorRequest&);
  LightSearch search = LightSearch::any_length;
  Content content = Content::light;
  std::uint32_t abilities = 0;
  LightSearch (*search_by)(const ParameterList&) = nullptr;         // instead of `search`, where settings decide
  std::uint32_t (*more_abilities)(const ParameterList&) = nullptr;  // where settings add some

  LightSearch search_of(const ParameterList& list) const { return search_by ? search_by(list) : search; }
  std::uint32_t abilities_of(const ParameterList& list) const {
    return abilities | (more_abilities ? more_abilities(list) : 0);
  }
  bool can(Ability ability) const { return (abilities & std::uint32_t(ability)) != 0; }
};

}  // namespace montelux
