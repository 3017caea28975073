// One event at a perfect mirror or at smooth glass that is given rather than sampled: for paths whose events are chosen
// before their directions are known.
#pragma once
#include "material/material.h"

namespace montelux {

// Either direction into which a smooth surface sends light.
struct SpecularLobe {
  // The factor of the light (TransportMode::radiance): reflectance or transmittance, tint, and the squared ratio of the
  // indices. Black where there is no such event.
  Spectrum<float> weight;
  float relative_eta = 1;  // of refraction: index on the side of wi over that on the side of wo; 1: straight on
};

// Of a smooth conductor, dielectric, tinted or thin dielectric; black for other models. `cos_o`: of wo with the shading
// normal, negative below.
SpecularLobe specular_lobe(BsdfKind kind, const BsdfSlots<float>& slots, float cos_o, bool reflects);

}  // namespace montelux
