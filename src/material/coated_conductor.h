// Metal under a clear coat: car paint, tinted foil.
#pragma once
#include "material/conductor.h"
#include "material/layered.h"

namespace montelux {

struct CoatedConductorSlots : LayeredSlots {
  static constexpr int conductor_alpha_x = base + ConductorSlots::alpha_x,
                       conductor_alpha_y = base + ConductorSlots::alpha_y, conductor_eta = base + ConductorSlots::eta,
                       conductor_k = base + ConductorSlots::k;
};

template <class F>
class CoatedConductor : public Layered<F, Conductor<F>> {
 public:
  static constexpr std::string_view name = "coatedconductor";
  using Layered<F, Conductor<F>>::Layered;
};

}  // namespace montelux
