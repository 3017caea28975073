#include "integrator/radiosity/settings.h"

#include "parameter/fields.h"

namespace montelux {

namespace {

Fields<RadiositySettings> radiosity_fields() {
  using S = RadiositySettings;
  Fields<S> fields;
  fields.number("elementsize", &S::element_size, "longest edge of an element, over the scene's diagonal", 1e-5, 10)
      .integer("rays", &S::rays, "of each side of an element in each frame", 1, 65536)
      .integer("frames", &S::frames, "frames per solution, which is one pass", 1, 1024)
      .formerly("chain")
      .integer("warm-up", &S::warm_up, "frames before the first one that is shown", 0, 1024)
      .boolean("gather", &S::gather, "final gather: irradiance of pixels from lights and elements");
  return fields;
}

}  // namespace

EntitySpec radiosity_spec() {
  return {"radiosity",
          "light between diffuse surfaces divided into elements of constant irradiance (Lambertian scenes; biased by "
          "the elements' size)",
          radiosity_fields().specs({})};
}

RadiositySettings radiosity_settings(const ParameterList& list) {
  RadiositySettings s;
  // None of the rows can fail: their values have been checked.
  (void)radiosity_fields().read(list, s);
  return s;
}

}  // namespace montelux
