// Quantities that depend on the wavelength, and the corresponding colours.
#pragma once
#include <vector>

#include "color/colorspace.h"

namespace montelux {

inline constexpr double shortest_wavelength = 360.0;
inline constexpr double longest_wavelength = 830.0;
// The integral of the luminous efficiency y over the wavelength in nm (CIE 15:2004, at 1 nm).
inline constexpr double luminous_integral = 106.856895;

// Piecewise linear in the wavelength (nm). wavelengths is strictly increasing; both lists have the same length >= 1.
struct SampledSpectrum {
  std::vector<double> wavelengths;
  std::vector<double> values;

  // Zero outside the samples.
  double at(double wavelength) const;
  // The value of the nearest sample outside the samples; for quantities that do not vanish there.
  double held_at(double wavelength) const;
};

// The same value at every visible wavelength.
SampledSpectrum constant_spectrum(double value);
// f at 360 to 830 nm, every `step` nm.
template <class Function>
SampledSpectrum sample_spectrum(Function f, double step = 5.0) {
  SampledSpectrum s;
  for (double w = shortest_wavelength; w <= longest_wavelength; w += step) {
    s.wavelengths.push_back(w);
    s.values.push_back(f(w));
  }
  return s;
}
SampledSpectrum scaled(const SampledSpectrum& spectrum, double factor);

// The colour-matching functions of the CIE 1931 observer, linear between 5 nm; zero outside 360 to 830 nm.
Xyz color_matching(double wavelength);

// The sum over 1 nm of the spectrum times the colour-matching functions, over luminous_integral.
Xyz to_xyz(const SampledSpectrum& emission);

// Emitted light as linear sRGB: the constant spectrum 1 has luminance 1. Colours outside the sRGB gamut have
// negative components, which are kept because light is additive.
Rgb to_rgb_emission(const SampledSpectrum& emission);
// The luminance Y of to_rgb_emission.
float mean_luminance(const SampledSpectrum& emission);
// The factor that gives an emission luminance one; zero for a black one.
double photometric_scale(const SampledSpectrum& emission);

// The colour of a surface with that reflectance (in [0, 1]) under D65, relative to a perfect white, which is exactly
// (1, 1, 1). Clamped to [0, 1].
Rgb to_rgb_reflectance(const SampledSpectrum& reflectance);

// The same for a surface that is measured at these wavelengths (nm, strictly increasing), as a weight for each value:
// the colour is the sum of weights times values. Neither clamped nor limited to values in [0, 1], so that colours
// outside the sRGB gamut have negative components.
std::vector<Rgb> reflectance_weights(const std::vector<double>& wavelengths);

// Means over the bands of red, green and blue for quantities without an upper bound, such as absorption coefficients or
// indices of refraction: the weight of a wavelength is the positive part of the primary's response under D65, so that a
// constant maps to itself and no component is negative unless the spectrum is. Beyond the samples the end values hold.
Rgb to_rgb_unbounded(const SampledSpectrum& spectrum);

// Complex index of refraction eta + i k at each primary.
struct ConductorRgb {
  Rgb eta, k;
};
// Reflectance at normal incidence of a conductor in air (Fresnel).
double normal_reflectance(double eta, double k);
// The eta and k whose reflectance at normal incidence equals, in each component, that of the metal's spectral
// reflectance under D65 (to_rgb_reflectance). eta is the mean over the band (to_rgb_unbounded); k is solved for.
ConductorRgb conductor_rgb(const SampledSpectrum& eta, const SampledSpectrum& k);

}  // namespace montelux
