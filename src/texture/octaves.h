// Octaves of noise, as several textures state them.
#pragma once
#include "parameter/fields.h"

namespace montelux {

struct OctavesDesc {
  int octaves = 8;
  float roughness = 0.5f;  // factor from one octave to the next

  static Fields<OctavesDesc> rows() {
    Fields<OctavesDesc> fields;
    fields.integer("octaves", &OctavesDesc::octaves, "octaves of noise", 1, 64);
    fields.number("roughness", &OctavesDesc::roughness, "falloff of the octaves", 0, 1e30);
    return fields;
  }
};

}  // namespace montelux
