// What the opaque types of the library hold. Inside the library only.
#pragma once
#include "api/render.h"
#include "montelux/scene.h"

namespace montelux::api {

struct PreparedScene::Parts {
  LoadedScene scene;
  std::vector<Message> messages;
};

struct Picture::Parts {
  Rendering rendering;
};

}  // namespace montelux::api
