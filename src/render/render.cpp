#include "render/render.h"

#include "render/pixels.h"
#include "render/series.h"

namespace montelux {

RenderResult render(const AnyIntegrator& integrator, const RenderSettings& settings, RenderObserver& observer) {
  if (integrator.coupled()) return render_series(*integrator.coupled(), settings, observer);
  if (settings.plan.synchronous) return render_series(PassesAsSeries(*integrator.pixel()), settings, observer);
  return render_pixels(*integrator.pixel(), settings, observer);
}

}  // namespace montelux
