#include "render/render.h"

#include "render/chains.h"
#include "render/pixels.h"

namespace montelux {

RenderResult render(const AnyIntegrator& integrator, const RenderSettings& settings, RenderObserver& observer) {
  if (integrator.coupled()) return render_chains(*integrator.coupled(), settings, observer);
  if (settings.plan.synchronous) return render_chains(PassesAsChains(*integrator.pixel()), settings, observer);
  return render_pixels(*integrator.pixel(), settings, observer);
}

}  // namespace montelux
