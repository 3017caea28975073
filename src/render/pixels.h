// Renders with pixel integrators.
#pragma once
#include "render/render.h"

namespace montelux {

// Implements render() for pixel integrators. Threads take units of work, each one pass of one tile. Units that are
// still in work some time after a stop do not enter the film, so that tiles may have different passes then.
RenderResult render_pixels(const PixelIntegrator& integrator, const RenderSettings& settings, RenderObserver& observer);

}  // namespace montelux
