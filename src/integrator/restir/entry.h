// What the catalogue states of reservoirs and their reuse.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry restir_di_entry();
IntegratorEntry restir_gi_entry();
IntegratorEntry restir_pt_entry();

}  // namespace montelux
