// From stated media to their coefficients.
#pragma once
#include <functional>
#include <span>
#include <string_view>

#include "medium/description.h"
#include "medium/medium.h"

namespace montelux {

// How the scene turns stated spectra into colours.
struct MediumInputs {
  std::function<Rgb(const SpectrumValue&)> coefficient;  // of a quantity without an upper bound
  std::function<Rgb(const SpectrumValue&)> emission;     // of emitted light
};

// An unknown preset counts as the default one.
Medium build_medium(const HomogeneousMediumDesc& stated, const MediumInputs& inputs);

// Measured media by name, in units of 1/mm (Jensen, Marschner, Levoy and Hanrahan 2001, fig. 5: the reduced scattering
// coefficient, for use with g = 0).
struct MeasuredMedium {
  std::string_view name;
  Rgb scattering, absorption;
};
std::span<const MeasuredMedium> measured_media();

}  // namespace montelux
