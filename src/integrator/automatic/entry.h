// What the catalogue states of the choice among the others.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry automatic_entry();

}  // namespace montelux
