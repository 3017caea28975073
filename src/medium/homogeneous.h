// A medium that is the same everywhere.
#pragma once
#include <optional>
#include <string>

#include "medium/inputs.h"
#include "parameter/value.h"

namespace montelux {

// Coefficients are per unit of length.
struct HomogeneousMediumDesc {
  std::string preset = "Wholemilk";           // a measured medium, whose coefficients are per millimetre
  std::optional<SpectrumValue> absorption{};  // sigma_a; none: the preset's
  std::optional<SpectrumValue> scattering{};  // sigma_s; none: the preset's
  float scale = 1;                            // factor of both
  PhaseKind phase = PhaseKind::henyey_greenstein;
  float mean_cosine = 0;                   // of the phase function of Henyey and Greenstein
  SpectrumValue emission = gray_value(0);  // radiance, times sigma_a per unit of length
  float emission_scale = 1;                // factor of the emission

  static constexpr std::string_view name = "homogeneous", meaning = "the same everywhere";
  static Fields<HomogeneousMediumDesc> rows();
  // An unknown preset counts as the default one.
  Medium build(const MediumInputs& inputs) const;
};

}  // namespace montelux
