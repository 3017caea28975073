// What the catalogue states of the quick views.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

std::vector<IntegratorEntry> look_entries();

}  // namespace montelux
