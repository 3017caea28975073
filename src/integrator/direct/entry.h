// What the catalogue states of direct light.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry direct_entry();

}  // namespace montelux
