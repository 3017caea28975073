#include "material/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using S = MaterialDesc;
template <class T>
using Place = Fields<S>::Place<T>;

constexpr double unlimited = 1e30;
constexpr double min_index = 1e-3;  // of refraction

// A model, a part of one, and a member of either.
template <class M>
Place<M> place_of() {
  return [](S& material) -> M& { return std::get<M>(material.model); };
}
template <class P, class T>
Place<T> in(const Place<P>& part, T P::*member) {
  return [part, member](S& material) -> T& { return part(material).*member; };
}
template <class M, class T>
Place<T> of(T M::*member) {
  return in(place_of<M>(), member);
}

// ---- what several materials have ------------------------------------------------------------------------------------

void normal_scale(Fields<S>& fields, std::string_view name, const Place<NormalMapDesc>& map, std::string meaning) {
  fields.list<2>(name, in(map, &NormalMapDesc::scale), std::move(meaning), -unlimited, unlimited);
}

// Every material has these, mixtures and interfaces excepted.
void common(Fields<S>& fields) {
  fields
      .optional_input<NumberInput>("displacement", &S::displacement, "bump height in scene units; default none",
                                   -unlimited, unlimited)
      .later();
  fields.words("normalmap", &S::normal_file, "file of an image of tangent-space normals; default none");
  const Place<NormalMapDesc> normals = &S::normals;
  fields.optional_input<SpectrumInput>(
      "normaltexture", in(normals, &NormalMapDesc::texture),
      "tangent-space normals as a texture of spectra, instead of normalmap; default none (Montelux alone)", -unlimited,
      unlimited);
  normal_scale(fields, "normalscale", normals, "factors of x and y of the mapped normal (Montelux alone)");
}

struct FacetNames {
  std::string_view both = "roughness", u = "uroughness", v = "vroughness";
};

void roughness(Fields<S>& fields, const Place<FacetsDesc>& facets, const FacetNames& names = {}) {
  const auto each_has_its_own = [facets](const S& material) {
    S copy = material;
    const FacetsDesc& f = facets(copy);
    return f.roughness_u && f.roughness_v;
  };
  fields
      .input<NumberInput>(names.both, in(facets, &FacetsDesc::roughness), "roughness of both directions", 0, unlimited)
      .only_if([each_has_its_own](const S& material) { return !each_has_its_own(material); });
  fields.optional_input<NumberInput>(names.u, in(facets, &FacetsDesc::roughness_u),
                                     "roughness along u; default that of both", 0, unlimited);
  fields.optional_input<NumberInput>(names.v, in(facets, &FacetsDesc::roughness_v),
                                     "roughness along v; default that of both", 0, unlimited);
}

void remap(Fields<S>& fields, const Place<bool>& maps_roughness) {
  fields.flag("remaproughness", maps_roughness, "roughness is perceptual: alpha is its square root");
}

void index(Fields<S>& fields, const Place<IndexInput>& eta, std::string meaning = "index of refraction",
           std::string_view name = "eta", double low = min_index) {
  fields.input<IndexInput>(name, eta, std::move(meaning), low, unlimited);
}

void albedo(Fields<S>& fields, std::string_view name, const Place<SpectrumInput>& place, std::string meaning) {
  fields.input<SpectrumInput>(name, place, std::move(meaning), 0, 1);
}

void layer(Fields<S>& fields, const Place<LayerDesc>& layer) {
  fields.input<NumberInput>("thickness", in(layer, &LayerDesc::thickness), "thickness of the coat in scene units", 0,
                            unlimited);
  fields.input<NumberInput>("g", in(layer, &LayerDesc::g), "asymmetry of scattering inside the coat", -1, 1);
  albedo(fields, "albedo", in(layer, &LayerDesc::albedo), "single-scattering albedo inside the coat");
  fields.integer("maxdepth", in(layer, &LayerDesc::max_depth), "maximum number of bounces between the layers", 0,
                 100000);
  fields.integer("nsamples", in(layer, &LayerDesc::samples), "random walks per evaluation", 1, 100000);
}

void metal(Fields<S>& fields, const Place<MetalDesc>& metal, std::string_view eta = "eta", std::string_view k = "k") {
  fields.input<SpectrumInput>(eta, in(metal, &MetalDesc::eta), "index of refraction", 0, unlimited);
  fields.input<SpectrumInput>(k, in(metal, &MetalDesc::k), "absorption coefficient", 0, unlimited);
  fields.optional_input<SpectrumInput>("reflectance", in(metal, &MetalDesc::reflectance),
                                       "reflectance at normal incidence, instead of eta and k", 0, 1);
}

void metallic_roughness(Fields<S>& fields, const Place<MetallicRoughnessDesc>& base) {
  using M = MetallicRoughnessDesc;
  albedo(fields, "basecolor", in(base, &M::base_color), "albedo of the diffuse part, and colour of the metal");
  fields.input<NumberInput>("metallic", in(base, &M::metallic), "share of the metal", 0, 1);
  fields.input<NumberInput>("roughness", in(base, &M::roughness), "alpha of the facets is its square", 0, 1);
  fields.input<NumberInput>("specular", in(base, &M::specular), "strength of the dielectric's reflection", 0, 1);
  fields.input<SpectrumInput>("specularcolor", in(base, &M::specular_color), "its colour at normal incidence", 0,
                              unlimited);
  index(fields, in(base, &M::eta), "index of refraction of the dielectric", "eta", 1);
}

// ---- the materials --------------------------------------------------------------------------------------------------

Model<S> model(std::string_view name, std::string_view meaning, MaterialModel initial, Fields<S> fields) {
  S material;
  material.model = std::move(initial);
  return {name, meaning, std::move(material), std::move(fields)};
}

Model<S> diffuse() {
  Fields<S> fields;
  albedo(fields, "reflectance", of(&DiffuseDesc::albedo), "albedo");
  common(fields);
  return model("diffuse", "Lambertian reflection", DiffuseDesc{}, fields);
}

Model<S> coated_diffuse() {
  using M = CoatedDiffuseDesc;
  Fields<S> fields;
  albedo(fields, "reflectance", of(&M::albedo), "albedo of the base");
  index(fields, of(&M::eta), "index of refraction of the coat");
  roughness(fields, of(&M::facets));
  remap(fields, of(&M::maps_roughness));
  layer(fields, of(&M::layer));
  common(fields);
  return model("coateddiffuse", "a diffuse base under a rough dielectric coat", M{}, fields);
}

Model<S> coated_conductor() {
  using M = CoatedConductorDesc;
  Fields<S> fields;
  metal(fields, of(&M::metal), "conductor.eta", "conductor.k");
  roughness(fields, of(&M::metal_facets), {"conductor.roughness", "conductor.uroughness", "conductor.vroughness"});
  index(fields, of(&M::coat_eta), "index of refraction of the coat", "interface.eta");
  roughness(fields, of(&M::coat_facets), {"interface.roughness", "interface.uroughness", "interface.vroughness"});
  remap(fields, of(&M::maps_roughness));
  layer(fields, of(&M::layer));
  common(fields);
  return model("coatedconductor", "a metal under a rough dielectric coat", M{}, fields);
}

Model<S> conductor() {
  using M = ConductorDesc;
  Fields<S> fields;
  metal(fields, of(&M::metal));
  roughness(fields, of(&M::facets));
  remap(fields, of(&M::maps_roughness));
  common(fields);
  return model("conductor", "a rough or smooth metal (GGX)", M{}, fields);
}

Model<S> phong() {
  using M = PhongDesc;
  Fields<S> fields;
  albedo(fields, "kd", of(&M::diffuse_albedo), "diffuse albedo");
  albedo(fields, "ks", of(&M::glossy_albedo), "glossy albedo");
  fields.input<NumberInput>("exponent", of(&M::exponent), "exponent of the glossy lobe", 0, 1e6);
  common(fields);
  return model("phong", "Lafortune's energy-conserving Phong model", M{}, fields);
}

Model<S> metallic_roughness() {
  Fields<S> fields;
  metallic_roughness(fields, place_of<MetallicRoughnessDesc>());
  common(fields);
  return model("metallicroughness",
               "the material of glTF 2.0: a dielectric coat over a diffuse base, or a metal (Montelux alone)",
               MetallicRoughnessDesc{}, fields);
}

Model<S> coated_metallic_roughness() {
  using M = CoatedMetallicRoughnessDesc;
  Fields<S> fields;
  metallic_roughness(fields, of(&M::base));
  fields.input<NumberInput>("clearcoat", of(&M::coat), "share of the coat", 0, 1);
  fields.input<NumberInput>("clearcoatroughness", of(&M::coat_roughness), "alpha of its facets is the square", 0, 1);
  const Place<NormalMapDesc> normals = of(&M::coat_normals);
  fields.optional_input<SpectrumInput>(
      "coatnormaltexture", in(normals, &NormalMapDesc::texture),
      "tangent-space normals of the coat; default: those of the surface, not of the base", -unlimited, unlimited);
  normal_scale(fields, "coatnormalscale", normals, "factors of their x and y");
  fields.input<NumberInput>("anisotropy", of(&M::anisotropy), "strength of the grain", 0, 1);
  fields.number("anisotropyrotation", of(&M::grain_rotation), "rotation of the grain from u towards v in degrees",
                -unlimited, unlimited);
  fields.input<NumberInput>("grainx", of(&M::grain_x), "the unrotated grain, u component, from 0 (-1) to 1 (1)", 0, 1);
  fields.input<NumberInput>("grainy", of(&M::grain_y), "the same along v, where 0.5 is none", 0, 1);
  fields.flag("grainmirrored", of(&M::grain_is_mirrored), "v is against n x u");
  common(fields);
  return model("coatedmetallicroughness",
               "metallicroughness with a grain and a clear coat of index 1.5, as in extensions of glTF (Montelux "
               "alone)",
               M{}, fields);
}

Model<S> mix() {
  Fields<S> fields;
  fields.list<std::string>("materials", string, of(&MixDesc::materials), "the names of two materials");
  fields.input<NumberInput>("amount", of(&MixDesc::amount), "share of the second material", 0, 1);
  return model("mix", "a random choice between two materials at each point", MixDesc{}, fields);
}

Model<S> interface() { return model("interface", "no scattering at all: bounds a medium", InterfaceDesc{}, {}); }

Model<S> dielectric() {
  using M = DielectricDesc;
  Fields<S> fields;
  index(fields, of(&M::eta));
  roughness(fields, of(&M::facets));
  remap(fields, of(&M::maps_roughness));
  common(fields);
  return model("dielectric", "rough or smooth glass (GGX)", M{}, fields);
}

Model<S> tinted_dielectric() {
  using M = TintedDielectricDesc;
  Fields<S> fields;
  index(fields, of(&M::eta));
  albedo(fields, "tint", of(&M::tint), "factor of transmitted light");
  fields.spectrum("absorption", of(&M::absorption), "absorption inside, per unit of length", 0, unlimited);
  roughness(fields, of(&M::facets));
  remap(fields, of(&M::maps_roughness));
  common(fields);
  return model("tinteddielectric", "glass that tints transmitted light and absorbs inside (Montelux alone)", M{},
               fields);
}

Model<S> thin_dielectric() {
  using M = ThinDielectricDesc;
  Fields<S> fields;
  index(fields, of(&M::eta));
  albedo(fields, "tint", of(&M::tint), "factor of transmitted light (Montelux alone)");
  fields.input<NumberInput>("roughness", of(&M::roughness), "roughness of reflection and transmission (Montelux alone)",
                            0, unlimited);
  remap(fields, of(&M::maps_roughness));
  common(fields);
  return model("thindielectric", "a thin pane without refraction", M{}, fields);
}

Model<S> diffuse_transmission() {
  using M = DiffuseTransmissionDesc;
  Fields<S> fields;
  albedo(fields, "reflectance", of(&M::reflected), "albedo of reflection");
  albedo(fields, "transmittance", of(&M::transmitted), "albedo of transmission");
  fields.number("scale", of(&M::scale), "factor of both", 0, unlimited);
  common(fields);
  return model("diffusetransmission", "Lambertian reflection and transmission", M{}, fields);
}

Model<S> measured() {
  Fields<S> fields;
  fields.words("filename", of(&MeasuredDesc::file), "file of the table, *.bsdf of the RGL material database");
  common(fields);
  return model("measured", "a tabulated reflection (Dupuy and Jakob 2018), the same on both sides", MeasuredDesc{},
               fields);
}

// ---- materials that are not supported yet ---------------------------------------------------------------------------

const std::vector<ParameterType> number_map{number, texture}, spectrum_map{spectrum, texture};

Model<S> later(std::string_view name, std::string_view meaning, const std::vector<ParameterSpec>& rows) {
  Fields<S> fields;
  for (const ParameterSpec& row : rows) fields.other(row);
  common(fields);
  Model<S> result = model(name, meaning, DiffuseDesc{}, fields);
  result.later = true, result.instead = "diffuse";
  return result;
}

Model<S> hair() {
  return later("hair", "a fibre (Chiang et al. 2016)",
               {{"sigma_a", spectrum_map, "absorption; default from the others", 0, unlimited},
                {"reflectance", spectrum_map, "albedo, instead of the absorption", 0, 1},
                {"color", spectrum_map, "albedo, the older name", 0, 1},
                {"eumelanin", number_map, "concentration of eumelanin; default 1.3", 0, unlimited},
                {"pheomelanin", number_map, "concentration of pheomelanin; default 0", 0, unlimited},
                {"eta", number_map, "index of refraction; default 1.55", min_index, unlimited},
                {"beta_m", number_map, "longitudinal roughness; default 0.3", 0, 1},
                {"beta_n", number_map, "azimuthal roughness; default 0.3", 0, 1},
                {"alpha", number_map, "tilt of the scales in degrees; default 2", -90, 90}});
}

Model<S> subsurface() {
  return later("subsurface", "a dielectric over a scattering medium",
               {{"name", {string}, "a measured material"},
                {"sigma_a", spectrum_map, "absorption per millimetre; default 0.0011 0.0024 0.014", 0, unlimited},
                {"sigma_s", spectrum_map, "scattering per millimetre; default 2.55 3.21 3.77", 0, unlimited},
                {"mfp", spectrum_map, "mean free path, with reflectance", 0, unlimited},
                {"reflectance", spectrum_map, "albedo, with mfp", 0, 1},
                {"scale", {number}, "factor of the coefficients; default 1", 0, unlimited},
                {"g", {number}, "asymmetry; default 0", -1, 1},
                {"eta", {number}, "index of refraction; default 1.33", min_index, unlimited},
                {"roughness", number_map, "roughness of both directions; default 0", 0, unlimited},
                {"uroughness", number_map, "roughness along u; default that of both", 0, unlimited},
                {"vroughness", number_map, "roughness along v; default that of both", 0, unlimited},
                {"remaproughness", {boolean}, "roughness is perceptual: alpha is its square root; default true"}});
}

}  // namespace

const Models<MaterialDesc>& material_models() {
  static const Models<S> models({diffuse(), coated_diffuse(), coated_conductor(), conductor(), phong(),
                                 metallic_roughness(), coated_metallic_roughness(), mix(), interface(), dielectric(),
                                 tinted_dielectric(), thin_dielectric(), diffuse_transmission(), hair(), subsurface(),
                                 measured()});
  return models;
}

std::string_view name_of(const MaterialModel& model) {
  static const auto names = [] {
    std::array<std::string_view, std::variant_size_v<MaterialModel>> all;
    for (const EntitySpec& spec : material_models().specs())
      if (!spec.later) all[material_models().initial(spec.name).model.index()] = spec.name;
    return all;
  }();
  return names[model.index()];
}

}  // namespace montelux
