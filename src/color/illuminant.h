// Light sources that follow a formula: black bodies, phases of daylight and illuminant A.
#pragma once
#include "color/sampled_spectrum.h"

namespace montelux {

// Planck's law: radiance per wavelength, W / (m^2 sr m), of a black body at a temperature in kelvin (2019 SI
// constants).
double planck_radiance(double wavelength_nm, double kelvin);
// A black body relative to its own peak (at any wavelength), 360 to 830 nm.
SampledSpectrum blackbody(double kelvin);

// Relative power of the CIE daylight of a correlated colour temperature of 4000 to 25000 K (CIE 15:2004, 3.1), 300 to
// 830 nm; 100 at 560 nm.
SampledSpectrum daylight(double kelvin);
// CIE standard illuminants, 100 at 560 nm. D50, D60 and D65 are the daylights of 5000, 6000 and 6500 K on the scale of
// the radiation constant c2 = 1.4380e-2 m K that was in use when they were named.
SampledSpectrum standard_a();
SampledSpectrum standard_d50();
SampledSpectrum standard_d60();
SampledSpectrum standard_d65();

}  // namespace montelux
