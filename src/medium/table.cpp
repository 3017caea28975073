#include "medium/table.h"

#include "medium/build.h"

namespace montelux {

namespace {

using S = HomogeneousMediumDesc;

constexpr double unlimited = 1e30;

Model<S> homogeneous() {
  NamedValues<std::string> presets;
  for (const MeasuredMedium& medium : measured_media()) presets.emplace_back(medium.name, medium.name);
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
  return {name_of(S{}), "the same everywhere", {}, std::move(fields)};
}

Model<S> later(std::string_view name, std::string_view meaning) { return {name, meaning, {}, {}, true}; }

}  // namespace

const Models<HomogeneousMediumDesc>& medium_models() {
  static const Models<S> models({homogeneous(), later("uniformgrid", "densities on a grid"),
                                 later("rgbgrid", "coefficients on a grid"), later("cloud", "procedural cloud"),
                                 later("nanovdb", "densities of a NanoVDB file")});
  return models;
}

}  // namespace montelux
