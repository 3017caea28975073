// Events at perfect mirrors and smooth glass that are given rather than sampled.
#pragma once
#include "material/material.h"

namespace montelux {

// Whether surfaces of the model have such events where they are smooth.
bool has_specular_lobe(BsdfKind kind);
// Of a smooth surface; black for models without such events. `cos_o`: of wo with the shading normal, negative below.
SpecularLobe<float> specular_lobe(BsdfKind kind, const BsdfSlots<float>& slots, float cos_o, bool reflects);

// Whether rough surfaces of the model consist of facets that have such events, and the roughness of these.
bool has_specular_facets(BsdfKind kind);
Roughness<float> specular_facets(BsdfKind kind, const BsdfSlots<float>& slots);

}  // namespace montelux
