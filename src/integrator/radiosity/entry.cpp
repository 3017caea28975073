#include "integrator/radiosity/entry.h"

#include <fmt/format.h>

#include "integrator/notes.h"
#include "integrator/radiosity/integrator.h"

namespace montelux {

namespace {

Result<ChosenIntegrator> make_radiosity(const IntegratorRequest& r) {
  const RadiositySettings settings = radiosity_settings(r.list);
  auto integrator = RadiosityIntegrator::make(r.scene, r.accel, settings);
  if (!integrator) return integrator.failure();
  ChosenIntegrator chosen = chosen_integrator("radiosity", *std::move(integrator));
  chosen.biases.push_back(fmt::format("elementsize={:.4g}", settings.element_size));
  chosen.notes.push_back(
      "irradiance is constant on each element: the picture is biased by their size (--set elementsize=... makes them "
      "smaller)");
  return chosen;
}

}  // namespace

IntegratorEntry radiosity_entry() {
  return {radiosity_spec(), make_radiosity, LightSearch::diffuse, Content::light, bits_of({Ability::shared_samples})};
}

}  // namespace montelux
