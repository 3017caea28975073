// What the catalogue states of photon maps.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry sppm_entry();
IntegratorEntry photonmap_entry();

}  // namespace montelux
