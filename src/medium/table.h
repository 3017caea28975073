// What a scene may state about participating media.
#pragma once
#include <string_view>

#include "medium/description.h"
#include "parameter/models.h"

namespace montelux {

const Models<MediumModel>& medium_models();
std::string_view name_of(const MediumModel& model);

}  // namespace montelux
