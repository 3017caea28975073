// Colours as a scene states them -> linear sRGB, by what they are used for.
#pragma once
#include "color/sampled_spectrum.h"
#include "parameter/value.h"

namespace montelux {

// Of a surface, in [0, 1] where the statement is.
Rgb reflectance_rgb(const SpectrumValue& value);
// Emitted light. RGB as stated; any other spectrum with luminance one, its scale being stated apart.
Rgb emission_rgb(const SpectrumValue& value);
// Of a quantity without an upper bound.
Rgb unbounded_rgb(const SpectrumValue& value);
// eta and k of a metal; both spectra where both are spectra, so that the colour of the metal is right.
ConductorRgb metal_rgb(const SpectrumValue& eta, const SpectrumValue& k);
// One index of refraction for all wavelengths: that at the sodium D line (589.3 nm).
float index_of_refraction(const SpectrumValue& value);
// The spectrum where one is stated, by samples, name or temperature; no value for RGB.
std::optional<SampledSpectrum> sampled(const SpectrumValue& value);

}  // namespace montelux
