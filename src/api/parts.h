// The components of a LoadedScene. Internal to the facade.
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
  LoadOptions load;  // the options of loading
};

}  // namespace montelux
