// The filters that a scene may state.
#pragma once
#include "filter/description.h"
#include "parameter/models.h"

namespace montelux {

// Every filter by name, with its parameters.
const Models<FilterDesc>& filter_models();

}  // namespace montelux
