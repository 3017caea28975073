// From a scene in code to the description that all readers of scenes make. Inside the library only.
#pragma once
#include "io/read_result.h"
#include "montelux/content.h"

namespace montelux::api {

// The description, or no description and all errors.
ReadResult describe(const Scene::Content& content);

}  // namespace montelux::api
