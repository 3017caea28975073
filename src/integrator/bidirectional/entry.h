// What the catalogue states of bidirectional paths and their mergings.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry bdpt_entry();
IntegratorEntry vcm_entry();

}  // namespace montelux
