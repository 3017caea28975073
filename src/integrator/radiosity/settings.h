// Settings of the radiosity integrator.
#pragma once
#include "math/result.h"
#include "parameter/choice.h"

namespace montelux {

struct RadiositySettings {
  float element_size = 0.05f;  // longest edge of an element, over the diagonal of the scene
  int rays = 16;               // of each side of an element in each frame
  int frames = 16;             // of a series: a pass
  int warm_up = 12;            // frames before those: light that has been reflected more often than that is missing
  bool gather = false;         // look up radiosity one bounce later than the picture
};

EntitySpec radiosity_spec();
RadiositySettings radiosity_settings(const ParameterList& list);

}  // namespace montelux
