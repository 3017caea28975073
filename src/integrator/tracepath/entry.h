// What the catalogue states of the path tracer of the textbook.
#pragma once
#include "integrator/chosen.h"

namespace montelux {

IntegratorEntry tracepath_entry();

}  // namespace montelux
