// Participating media as stated by a scene: plain data.
#pragma once
#include <optional>
#include <string>

#include "parameter/value.h"
#include "phase/phase.h"

namespace montelux {

// The same everywhere. Coefficients are per unit of length.
struct HomogeneousMediumDesc {
  std::string preset = "Wholemilk";           // of measured_media(), whose coefficients are per millimetre
  std::optional<SpectrumValue> absorption{};  // sigma_a; none: the preset's
  std::optional<SpectrumValue> scattering{};  // sigma_s; none: the preset's
  float scale = 1;                            // factor of both
  PhaseKind phase = PhaseKind::henyey_greenstein;
  float mean_cosine = 0;                   // of the phase function of Henyey and Greenstein
  SpectrumValue emission = gray_value(0);  // radiance, times sigma_a per unit of length
  float emission_scale = 1;                // factor of the emission
};

struct MediumDesc {
  std::string name;
  std::optional<HomogeneousMediumDesc> model{};  // none: it was left out by a lenient reading, and is empty space
  SourceLocation where{};
};

}  // namespace montelux
