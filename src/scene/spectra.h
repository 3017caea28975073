// Colours as stated by a scene -> linear sRGB, depending on their use.
#pragma once
#include "color/sampled_spectrum.h"
#include "parameter/value.h"

namespace montelux {

// For a surface; in [0, 1] if the statement is.
Rgb reflectance_rgb(const SpectrumValue& value);
// Emitted light. RGB as stated; any other spectrum with luminance one, because its scale is stated separately.
Rgb emission_rgb(const SpectrumValue& value);
// For a quantity without an upper bound.
Rgb unbounded_rgb(const SpectrumValue& value);
// eta and k of a metal; spectral if both are spectra, so that the colour of the metal is right.
ConductorRgb metal_rgb(const SpectrumValue& eta, const SpectrumValue& k);
// One index of refraction for all wavelengths: that at the sodium D line (589.3 nm).
float index_of_refraction(const SpectrumValue& value);
// The spectrum if one is stated, by samples, name or temperature; no value for RGB.
std::optional<SampledSpectrum> sampled(const SpectrumValue& value);

}  // namespace montelux
