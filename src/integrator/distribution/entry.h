// What the catalogue states of distribution ray tracing.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry distribution_entry();

}  // namespace montelux
