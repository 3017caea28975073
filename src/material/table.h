// The materials that a scene may state.
#pragma once
#include <string_view>

#include "material/description.h"
#include "parameter/models.h"

namespace montelux {

// Every material by name, with its parameters.
const Models<MaterialDesc>& material_models();

// The name that states the model.
std::string_view name_of(const MaterialModel& model);

}  // namespace montelux
