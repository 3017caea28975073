#include "integrator/look/entry.h"

#include "integrator/look/integrator.h"

namespace montelux {

namespace {

template <const char* name>
Result<ChosenIntegrator> make_look(const IntegratorRequest& r) {
  ChosenIntegrator chosen =
      chosen_integrator(name, std::make_unique<LookIntegrator>(r.scene, r.accel, look_settings(name, r.list)));
  chosen.biases.push_back("no picture of light");
  return chosen;
}
constexpr char ao[] = "ao", normal[] = "normal", albedo[] = "albedo", depth[] = "depth", irradiance[] = "irradiance";

// In the order of look_specs().
constexpr Result<ChosenIntegrator> (*looks[])(const IntegratorRequest&) = {
    make_look<ao>, make_look<normal>, make_look<albedo>, make_look<depth>, make_look<irradiance>};
constexpr Content contents[] = {Content::share, Content::encoded, Content::share, Content::distance, Content::light};

}  // namespace

std::vector<IntegratorEntry> look_entries() {
  const std::vector<EntitySpec> specs = look_specs();
  std::vector<IntegratorEntry> entries;
  for (std::size_t i = 0; i < specs.size(); ++i)
    entries.push_back({specs[i], looks[i], LightSearch::none, contents[i], bits_of({Ability::absorption})});
  return entries;
}

}  // namespace montelux
