// What a LoadedScene is made of. Inside the facade only.
#pragma once
#include "accel/accel.h"
#include "api/scene.h"
#include "scene/picture.h"
#include "scene/scene.h"

namespace montelux {

struct LoadedScene::Parts {
  Scene scene;
  PictureSettings picture;
  std::unique_ptr<Accel> accel;
  SceneInfo info;
  LoadOptions load;  // what it was loaded with
};

}  // namespace montelux
