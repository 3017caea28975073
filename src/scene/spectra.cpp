#include "scene/spectra.h"

#include "color/colorspace.h"
#include "color/illuminant.h"
#include "color/named_spectra.h"

namespace montelux {

namespace {

ColorSpace space_of(const RgbValue& value) { return color_space(value.color_space).value_or(*color_space("srgb")); }

}  // namespace

std::optional<SampledSpectrum> sampled(const SpectrumValue& value) {
  if (const auto* named = std::get_if<NamedSpectrum>(&value)) return named_spectrum(named->name);
  if (const auto* body = std::get_if<Blackbody>(&value)) return blackbody(body->kelvin);
  if (const auto* samples = std::get_if<SampledValue>(&value))
    return SampledSpectrum{{samples->wavelengths.begin(), samples->wavelengths.end()},
                           {samples->values.begin(), samples->values.end()}};
  return std::nullopt;
}

Rgb reflectance_rgb(const SpectrumValue& value) {
  if (const auto* rgb = std::get_if<RgbValue>(&value)) return reflectance_to_srgb(space_of(*rgb)) * rgb->rgb;
  auto spectrum = sampled(value);
  return spectrum ? to_rgb_reflectance(*spectrum) : Rgb{};
}

Rgb emission_rgb(const SpectrumValue& value) {
  if (const auto* rgb = std::get_if<RgbValue>(&value)) return emission_to_srgb(space_of(*rgb)) * rgb->rgb;
  auto spectrum = sampled(value);
  return spectrum ? to_rgb_emission(scaled(*spectrum, photometric_scale(*spectrum))) : Rgb{};
}

ConductorRgb metal_rgb(const SpectrumValue& eta, const SpectrumValue& k) {
  auto eta_spectrum = sampled(eta), k_spectrum = sampled(k);
  if (eta_spectrum && k_spectrum) return conductor_rgb(*eta_spectrum, *k_spectrum);
  return {unbounded_rgb(eta), unbounded_rgb(k)};
}

float index_of_refraction(const SpectrumValue& value) {
  if (auto spectrum = sampled(value)) return float(spectrum->held_at(589.3));
  return average(unbounded_rgb(value));
}

Rgb unbounded_rgb(const SpectrumValue& value) {
  if (const auto* rgb = std::get_if<RgbValue>(&value)) return rgb->rgb;
  auto spectrum = sampled(value);
  return spectrum ? to_rgb_unbounded(*spectrum) : Rgb{};
}

}  // namespace montelux
