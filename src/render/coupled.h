// Renders by chains of frames, for integrators whose pixels learn from each other.
#pragma once
#include "render/render.h"

namespace montelux {

// As render(), of which it is a part. Threads share the tiles of a step of the chain and wait for each other between
// steps. A render that is stopped ends between frames, and its last chain counts as a pass of fewer frames: it has the
// right mean, and passes are independent, so their spread stays an honest error bar.
RenderResult render_chains(const CoupledIntegrator& integrator, const RenderSettings& settings,
                           RenderObserver& observer);

}  // namespace montelux
