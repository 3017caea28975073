// What the catalogue states of light tracing.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry light_tracing_entry();

}  // namespace montelux
