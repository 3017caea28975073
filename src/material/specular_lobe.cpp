#include "material/specular_lobe.h"

namespace montelux {

bool has_specular_lobe(BsdfKind kind) {
  bool result = false;
  for_each_present_model<float>(std::uint32_t(kind), true,
                                [&]<class Model>(bool) { result = HasSpecularLobe<Model, float>; });
  return result;
}

SpecularLobe<float> specular_lobe(BsdfKind kind, const BsdfSlots<float>& slots, float cos_o, bool reflects) {
  SpecularLobe<float> lobe;
  for_each_present_model<float>(std::uint32_t(kind), true, [&]<class Model>(bool) {
    if constexpr (HasSpecularLobe<Model, float>) lobe = Model(BsdfRows<float>{&slots}).specular_lobe(cos_o, reflects);
  });
  return lobe;
}

bool has_specular_facets(BsdfKind kind) {
  bool result = false;
  for_each_present_model<float>(std::uint32_t(kind), true,
                                [&]<class Model>(bool) { result = HasSpecularFacets<Model, float>; });
  return result;
}

Roughness<float> specular_facets(BsdfKind kind, const BsdfSlots<float>& slots) {
  Roughness<float> roughness{0, 0};
  for_each_present_model<float>(std::uint32_t(kind), true, [&]<class Model>(bool) {
    if constexpr (HasSpecularFacets<Model, float>) roughness = Model(BsdfRows<float>{&slots}).specular_facets();
  });
  return roughness;
}

}  // namespace montelux
