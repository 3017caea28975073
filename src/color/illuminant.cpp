#include "color/illuminant.h"

#include <cmath>

#include "color/tables.h"

namespace montelux {
namespace {

constexpr double planck_constant = 6.62607015e-34;
constexpr double light_speed = 299792458.0;
constexpr double boltzmann_constant = 1.380649e-23;
constexpr double wien_constant = 2.897771955e-3;

// Today's temperature of a daylight that was named when c2 was 1.4380e-2.
double named_temperature(double kelvin) { return kelvin * 1.4388 / 1.4380; }

Chromaticity daylight_chromaticity(double kelvin) {
  double i = 1e3 / kelvin;
  double x = kelvin <= 7000.0 ? 0.244063 + i * (0.09911 + i * (2.9678 - i * 4.6070))
                              : 0.237040 + i * (0.24748 + i * (1.9018 - i * 2.0064));
  return {x, -3.000 * x * x + 2.870 * x - 0.275};
}

double round_to_thousandths(double x) { return std::round(x * 1000.0) / 1000.0; }

}  // namespace

double planck_radiance(double wavelength_nm, double kelvin) {
  double w = wavelength_nm * 1e-9;
  double exponent = planck_constant * light_speed / (w * boltzmann_constant * kelvin);
  return 2.0 * planck_constant * light_speed * light_speed / (std::pow(w, 5) * std::expm1(exponent));
}

SampledSpectrum blackbody(double kelvin) {
  double peak = planck_radiance(wien_constant / kelvin * 1e9, kelvin);
  return sample_spectrum([&](double w) { return planck_radiance(w, kelvin) / peak; });
}

SampledSpectrum daylight(double kelvin) {
  Chromaticity c = daylight_chromaticity(kelvin);
  // The standard rounds both factors to three places.
  double divisor = 0.0241 + 0.2562 * c.x - 0.7341 * c.y;
  double m1 = round_to_thousandths((-1.3515 - 1.7703 * c.x + 5.9114 * c.y) / divisor);
  double m2 = round_to_thousandths((0.0300 - 31.4424 * c.x + 30.0717 * c.y) / divisor);
  SampledSpectrum s;
  for (const std::array<double, 4>& row : daylight_table()) {
    s.wavelengths.push_back(row[0]);
    s.values.push_back(row[1] + m1 * row[2] + m2 * row[3]);
  }
  return s;
}

SampledSpectrum standard_a() {
  // CIE 15:2004, 3.1: a black body of 2848 K on a scale with c2 = 1.435e7 nm K.
  auto law = [](double w) { return std::pow(560.0 / w, 5) / std::expm1(1.435e7 / (2848.0 * w)); };
  return sample_spectrum([&](double w) { return 100.0 * law(w) / law(560.0); });
}
SampledSpectrum standard_d50() { return daylight(named_temperature(5000.0)); }
SampledSpectrum standard_d60() { return daylight(named_temperature(6000.0)); }
SampledSpectrum standard_d65() { return daylight(named_temperature(6500.0)); }

}  // namespace montelux
