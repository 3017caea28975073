#include "medium/homogeneous.h"

#include <algorithm>
#include <array>

#include "parameter/fields.h"

namespace montelux {

namespace {

constexpr double unlimited = 1e30;

// Measured media in units of 1/mm (Jensen, Marschner, Levoy and Hanrahan 2001, fig. 5: the reduced scattering
// coefficient, for use with g = 0).
struct MeasuredMedium {
  std::string_view name;
  Rgb scattering, absorption;
};
constexpr std::array<MeasuredMedium, 12> measured{{
    {"Apple", {2.29f, 2.39f, 1.97f}, {0.0030f, 0.0034f, 0.046f}},
    {"Chicken1", {0.15f, 0.21f, 0.38f}, {0.015f, 0.077f, 0.19f}},
    {"Chicken2", {0.19f, 0.25f, 0.32f}, {0.018f, 0.088f, 0.20f}},
    {"Cream", {7.38f, 5.47f, 3.15f}, {0.0002f, 0.0028f, 0.0163f}},
    {"Ketchup", {0.18f, 0.07f, 0.03f}, {0.061f, 0.97f, 1.45f}},
    {"Marble", {2.19f, 2.62f, 3.00f}, {0.0021f, 0.0041f, 0.0071f}},
    {"Potato", {0.68f, 0.70f, 0.55f}, {0.0024f, 0.0090f, 0.12f}},
    {"Skimmilk", {0.70f, 1.22f, 1.90f}, {0.0014f, 0.0025f, 0.0142f}},
    {"Skin1", {0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f}},
    {"Skin2", {1.09f, 1.59f, 1.79f}, {0.013f, 0.070f, 0.145f}},
    {"Spectralon", {11.6f, 20.4f, 14.9f}, {0.0f, 0.0f, 0.0f}},
    {"Wholemilk", {2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f}},
}};

}  // namespace

Fields<HomogeneousMediumDesc> HomogeneousMediumDesc::rows() {
  using S = HomogeneousMediumDesc;
  NamedValues<std::string> presets;
  for (const MeasuredMedium& medium : measured) presets.emplace_back(medium.name, medium.name);
  NamedValues<PhaseKind> phases;
  for (std::size_t i = 0; i < phase_names.size(); ++i) phases.emplace_back(phase_names[i], PhaseKind(i));
  Fields<S> fields;
  fields.choice<std::string>("preset", &S::preset, "measured coefficients, per millimetre", presets)
      .only_if([](const S& medium) { return !medium.absorption || !medium.scattering; });
  fields.optional("sigma_a", &S::absorption, "absorption per unit of length; default the preset's", 0, unlimited);
  fields.optional("sigma_s", &S::scattering, "scattering per unit of length; default the preset's", 0, unlimited);
  fields.number("scale", &S::scale, "factor of both", 0, unlimited);
  fields.choice<PhaseKind>("phase", &S::phase, "phase function: how a point of the medium scatters (Montelux alone)",
                           phases);
  fields.number("g", &S::mean_cosine, "mean cosine of the phase function of Henyey and Greenstein", -0.999, 0.999)
      .only_if([](const S& medium) { return medium.phase == PhaseKind::henyey_greenstein; });
  fields.spectrum("Le", &S::emission, "emitted radiance, times sigma_a per unit of length", 0, unlimited);
  fields.number("Lescale", &S::emission_scale, "factor of Le", 0, unlimited).only_if([](const S& medium) {
    return !(medium.emission == gray_value(0));
  });
  return fields;
}

Medium HomogeneousMediumDesc::build(const MediumInputs& inputs) const {
  const auto known = std::ranges::find(measured, preset, &MeasuredMedium::name);
  const MeasuredMedium& basis = known == measured.end() ? measured.back() : *known;
  Medium medium;
  medium.absorption = (absorption ? inputs.coefficient(*absorption) : basis.absorption) * scale;
  medium.scattering = (scattering ? inputs.coefficient(*scattering) : basis.scattering) * scale;
  medium.emission = inputs.emission(emission) * emission_scale;
  medium.mean_cosine = mean_cosine, medium.phase = phase;
  return medium;
}

}  // namespace montelux
