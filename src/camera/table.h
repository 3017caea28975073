// The cameras that a scene may state.
#pragma once
#include "camera/description.h"
#include "parameter/models.h"

namespace montelux {

// Every camera by name, with its parameters.
const Models<CameraDesc>& camera_models();

}  // namespace montelux
