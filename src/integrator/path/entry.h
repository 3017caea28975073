// What the catalogue states of path tracing.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry path_entry();
IntegratorEntry naive_entry();

}  // namespace montelux
