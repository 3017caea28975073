#include "integrator/chosen.h"

namespace montelux {

ChosenIntegrator chosen_integrator(std::string_view name, std::unique_ptr<PixelIntegrator> integrator) {
  return {std::string(name), std::move(integrator), {}, {}, {}};
}
ChosenIntegrator chosen_integrator(std::string_view name, std::unique_ptr<CoupledIntegrator> coupled) {
  return {std::string(name), {}, {}, {}, std::move(coupled)};
}

}  // namespace montelux
