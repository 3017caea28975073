#include "integrator/radiosity/settings.h"

namespace montelux {

EntitySpec radiosity_spec() {
  using enum ParameterType;
  return {"radiosity",
          "light between diffuse surfaces that are cut into elements of even irradiance (Lambertian scenes; biased by "
          "the elements' size)",
          {{"elementsize", {number}, "longest edge of an element, over the scene's diagonal; default 0.05", 1e-5, 10},
           {"rays", {integer}, "of each side of an element in each frame; default 16", 1, 65536},
           {"chain", {integer}, "frames that one solution is refined over: a pass; default 16", 1, 1024},
           {"warm-up", {integer}, "reflections before the first frame that is shown; default 12", 0, 1024},
           {"gather", {boolean}, "irradiance of pixels from light and elements around them; default off"}}};
}

RadiositySettings radiosity_settings(const ParameterList& list) {
  RadiositySettings s;
  s.element_size = list.number("elementsize", s.element_size);
  s.rays = list.integer("rays", s.rays);
  s.frames = list.integer("chain", s.frames);
  s.warm_up = list.integer("warm-up", s.warm_up);
  s.gather = list.boolean("gather", s.gather);
  return s;
}

}  // namespace montelux
