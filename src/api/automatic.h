// --integrator auto: which integrator renders an image. Internal to the facade.
#pragma once
#include "api/render_plan.h"

namespace montelux {

// The integrator of a render whose text is "auto", before its length is known: path, or that of the film that is
// continued. Fails where an option does not fit the choice.
Status plan_automatic(const ChoiceText& choice, const LoadedScene::Parts& parts, const RenderOptions& options,
                      RenderPlan& plan);

// Makes the choice, and replaces the integrator of the plan and its passes. Does nothing where it is made already, or
// where the integrator is stated.
Status choose_automatically(const LoadedScene::Parts& parts, RenderPlan& plan, RenderObserver& observer);

}  // namespace montelux
