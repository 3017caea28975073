#include "material/rows.h"

namespace montelux {

Fields<FacetsDesc> rows_of_facets(const FacetNames& names) {
  using P = FacetsDesc;
  Fields<P> fields;
  fields.input<NumberInput>(names.both, &P::roughness, "roughness of both directions", 0, no_upper_bound)
      .only_if([](const P& facets) { return !(facets.roughness_u && facets.roughness_v); });
  fields.optional_input<NumberInput>(names.u, &P::roughness_u, "roughness along u; default that of both", 0,
                                     no_upper_bound);
  fields.optional_input<NumberInput>(names.v, &P::roughness_v, "roughness along v; default that of both", 0,
                                     no_upper_bound);
  return fields;
}

Fields<MetalDesc> rows_of_metal(std::string_view eta, std::string_view k) {
  using P = MetalDesc;
  Fields<P> fields;
  fields.input<SpectrumInput>(eta, &P::eta, "index of refraction", 0, no_upper_bound);
  fields.input<SpectrumInput>(k, &P::k, "absorption coefficient", 0, no_upper_bound);
  fields.optional_input<SpectrumInput>("reflectance", &P::reflectance,
                                       "reflectance at normal incidence, instead of eta and k", 0, 1);
  return fields;
}

Fields<LayerDesc> rows_of_layer() {
  using P = LayerDesc;
  Fields<P> fields;
  fields.input<NumberInput>("thickness", &P::thickness, "thickness of the coat in scene units", 0, no_upper_bound);
  fields.input<NumberInput>("g", &P::g, "asymmetry of scattering inside the coat", -1, 1);
  albedo(fields, "albedo", &P::albedo, "single-scattering albedo inside the coat");
  fields.integer("maxdepth", &P::max_depth, "maximum number of bounces between the layers", 0, 100000);
  fields.integer("nsamples", &P::samples, "random walks per evaluation", 1, 100000);
  return fields;
}

Fields<NormalMapDesc> rows_of_normals(std::string_view texture, std::string texture_meaning, std::string_view scale,
                                      std::string scale_meaning) {
  using P = NormalMapDesc;
  Fields<P> fields;
  fields.optional_input<SpectrumInput>(texture, &P::texture, std::move(texture_meaning), -no_upper_bound,
                                       no_upper_bound);
  fields.list<2>(scale, &P::scale, std::move(scale_meaning), -no_upper_bound, no_upper_bound);
  return fields;
}

}  // namespace montelux
