// What the catalogue states of the irradiance cache.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry irradiance_cache_entry();

}  // namespace montelux
