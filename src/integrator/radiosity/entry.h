// What the catalogue states of radiosity.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry radiosity_entry();

}  // namespace montelux
