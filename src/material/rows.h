// Rows of parameters that several materials have.
#pragma once
#include "material/parts.h"
#include "parameter/fields.h"

namespace montelux {

constexpr double no_upper_bound = 1e30;
constexpr double min_index_of_refraction = 1e-3;

// A reflectance or another factor from 0 to 1.
template <class M>
void albedo(Fields<M>& fields, std::string_view name, typename Fields<M>::template Place<SpectrumInput> place,
            std::string meaning) {
  fields.template input<SpectrumInput>(name, place, std::move(meaning), 0, 1);
}
template <class M>
void index(Fields<M>& fields, typename Fields<M>::template Place<IndexInput> place,
           std::string meaning = "index of refraction", std::string_view name = "eta",
           double low = min_index_of_refraction) {
  fields.template input<IndexInput>(name, place, std::move(meaning), low, no_upper_bound);
}
template <class M>
void remap(Fields<M>& fields, typename Fields<M>::template Place<bool> maps_roughness) {
  fields.flag("remaproughness", maps_roughness, "roughness is perceptual: alpha is its square root");
}

struct FacetNames {
  std::string_view both = "roughness", u = "uroughness", v = "vroughness";
};
Fields<FacetsDesc> rows_of_facets(const FacetNames& names = {});
Fields<MetalDesc> rows_of_metal(std::string_view eta = "eta", std::string_view k = "k");
Fields<LayerDesc> rows_of_layer();
Fields<NormalMapDesc> rows_of_normals(std::string_view texture, std::string texture_meaning, std::string_view scale,
                                      std::string scale_meaning);

}  // namespace montelux
