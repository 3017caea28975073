#include "material/table.h"

#include "material/rows.h"

namespace montelux {

Fields<MixDesc> MixDesc::rows() {
  Fields<MixDesc> fields;
  fields.list<std::string>("materials", ParameterType::string, &MixDesc::materials, "the names of two materials");
  fields.input<NumberInput>("amount", &MixDesc::amount, "share of the second material", 0, 1);
  return fields;
}

Fields<InterfaceDesc> InterfaceDesc::rows() { return {}; }

namespace {

using enum ParameterType;
using S = MaterialDesc;

// Every material has these, mixtures and interfaces excepted.
void common(Fields<S>& fields) {
  fields
      .optional_input<NumberInput>("displacement", &S::displacement, "bump height in scene units; default none",
                                   -no_upper_bound, no_upper_bound)
      .later();
  fields.words("normalmap", &S::normal_file, "file of an image of tangent-space normals; default none");
  fields.part(&S::normals,
              rows_of_normals("normaltexture",
                              "tangent-space normals as a texture of spectra, instead of normalmap; default none "
                              "(Montelux alone)",
                              "normalscale", "factors of x and y of the mapped normal (Montelux alone)"));
}

template <class Stated>
Model<S> model(std::string_view name, bool scatters = true) {
  Fields<S> fields;
  fields.part<Stated>([](S& material) -> Stated& { return std::get<Stated>(material.model); }, Stated::rows());
  if (scatters) common(fields);
  S material;
  material.model = Stated{};
  return {name, Stated::meaning, std::move(material), std::move(fields)};
}

// The models of the list.
template <class... Bsdf>
std::vector<Model<S>> models_of(std::tuple<Bsdf...>*) {
  return {model<typename Bsdf::Stated>(Bsdf::name)...};
}

// ---- materials that are not supported yet ---------------------------------------------------------------------------

const std::vector<ParameterType> number_map{number, texture}, spectrum_map{spectrum, texture};

Model<S> later(std::string_view name, std::string_view meaning, const std::vector<ParameterSpec>& rows) {
  Fields<S> fields;
  for (const ParameterSpec& row : rows) fields.other(row);
  common(fields);
  return {name, meaning, {}, std::move(fields), true, "diffuse"};
}

Model<S> hair() {
  return later("hair", "a fibre (Chiang et al. 2016)",
               {{"sigma_a", spectrum_map, "absorption; default from the others", 0, no_upper_bound},
                {"reflectance", spectrum_map, "albedo, instead of the absorption", 0, 1},
                {"color", spectrum_map, "albedo, the older name", 0, 1},
                {"eumelanin", number_map, "concentration of eumelanin; default 1.3", 0, no_upper_bound},
                {"pheomelanin", number_map, "concentration of pheomelanin; default 0", 0, no_upper_bound},
                {"eta", number_map, "index of refraction; default 1.55", min_index_of_refraction, no_upper_bound},
                {"beta_m", number_map, "longitudinal roughness; default 0.3", 0, 1},
                {"beta_n", number_map, "azimuthal roughness; default 0.3", 0, 1},
                {"alpha", number_map, "tilt of the scales in degrees; default 2", -90, 90}});
}

Model<S> subsurface() {
  return later("subsurface", "a dielectric over a scattering medium",
               {{"name", {string}, "a measured material"},
                {"sigma_a", spectrum_map, "absorption per millimetre; default 0.0011 0.0024 0.014", 0, no_upper_bound},
                {"sigma_s", spectrum_map, "scattering per millimetre; default 2.55 3.21 3.77", 0, no_upper_bound},
                {"mfp", spectrum_map, "mean free path, with reflectance", 0, no_upper_bound},
                {"reflectance", spectrum_map, "albedo, with mfp", 0, 1},
                {"scale", {number}, "factor of the coefficients; default 1", 0, no_upper_bound},
                {"g", {number}, "asymmetry; default 0", -1, 1},
                {"eta", {number}, "index of refraction; default 1.33", min_index_of_refraction, no_upper_bound},
                {"roughness", number_map, "roughness of both directions; default 0", 0, no_upper_bound},
                {"uroughness", number_map, "roughness along u; default that of both", 0, no_upper_bound},
                {"vroughness", number_map, "roughness along v; default that of both", 0, no_upper_bound},
                {"remaproughness", {boolean}, "roughness is perceptual: alpha is its square root; default true"}});
}

}  // namespace

const Models<MaterialDesc>& material_models() {
  static const Models<S> models([] {
    std::vector<Model<S>> all = models_of(static_cast<BsdfModels<float>*>(nullptr));
    all.push_back(model<MixDesc>(MixDesc::name, false));
    all.push_back(model<InterfaceDesc>(InterfaceDesc::name, false));
    all.push_back(hair()), all.push_back(subsurface());
    return all;
  }());
  return models;
}

std::string_view name_of(const MaterialModel& model) {
  const auto name = []<class Stated>(const Stated&) {
    if constexpr (std::is_same_v<Stated, MixDesc> || std::is_same_v<Stated, InterfaceDesc>)
      return Stated::name;
    else
      return BsdfOf<kind_stated_by<Stated>, float>::name;
  };
  return std::visit(name, model);
}

}  // namespace montelux
