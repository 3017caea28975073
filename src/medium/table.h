// What a scene may state about participating media.
#pragma once
#include <string_view>

#include "medium/description.h"
#include "parameter/models.h"

namespace montelux {

const Models<HomogeneousMediumDesc>& medium_models();
inline std::string_view name_of(const HomogeneousMediumDesc&) { return "homogeneous"; }

}  // namespace montelux
