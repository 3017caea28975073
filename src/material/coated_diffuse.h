// Lambert's law under a clear coat: plastic, varnished wood.
#pragma once
#include "material/diffuse.h"
#include "material/layered.h"

namespace montelux {

struct CoatedDiffuseSlots : LayeredSlots {
  static constexpr int reflectance = base + DiffuseSlots::reflectance;
};

template <class F>
class CoatedDiffuse : public Layered<F, Diffuse<F>> {
 public:
  static constexpr std::string_view name = "coateddiffuse";
  using Layered<F, Diffuse<F>>::Layered;
};

}  // namespace montelux
