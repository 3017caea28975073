// What the catalogue states of Metropolis light transport.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry metropolis_entry();

}  // namespace montelux
