#include "material/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using List = std::vector<ParameterSpec>;

constexpr double most = 1e30;
// An index of refraction may be one number or vary with the wavelength.
const std::vector<ParameterType> number_map{number, texture}, spectrum_map{spectrum, texture}, index{number, spectrum};

List join(std::initializer_list<List> lists) {
  List all;
  for (const List& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

// Every material has these.
List common() {
  return {{"displacement", number_map, "bump height in scene units; default none", -most, most, {}, false, true},
          {"normalmap", {string}, "file of an image of tangent-space normals; default none"},
          {"normaltexture", spectrum_map,
           "tangent-space normals as a texture of spectra, instead of normalmap; default none (Montelux alone)"},
          {"normalscale",
           {number},
           "factors of x and y of the mapped normal; default 1 1 (Montelux alone)",
           -most,
           most,
           {},
           true}};
}

List roughness(std::string_view value, std::string_view u, std::string_view v) {
  return {{value, number_map, "roughness of both directions; default 0", 0, most},
          {u, number_map, "roughness along u; default that of both", 0, most},
          {v, number_map, "roughness along v; default that of both", 0, most}};
}

List remap() {
  return {{"remaproughness", {boolean}, "roughness is perceptual: alpha is its square root; default true"}};
}

List layer() {
  return {{"thickness", number_map, "thickness of the coat in scene units; default 0.01", 0, most},
          {"g", number_map, "asymmetry of scattering inside the coat; default 0", -1, 1},
          {"albedo", spectrum_map, "single-scattering albedo inside the coat; default 0", 0, 1},
          {"maxdepth", {integer}, "maximum number of bounces between the layers; default 10", 0, 100000},
          {"nsamples", {integer}, "random walks per evaluation; default 1", 1, 100000}};
}

List metallic_roughness() {
  return {{"basecolor", spectrum_map, "albedo of the diffuse part, and colour of the metal; default 1", 0, 1},
          {"metallic", number_map, "share of the metal; default 1", 0, 1},
          {"roughness", number_map, "alpha of the facets is its square; default 1", 0, 1},
          {"specular", number_map, "strength of the dielectric's reflection; default 1", 0, 1},
          {"specularcolor", spectrum_map, "its colour at normal incidence; default 1", 0, most},
          {"eta", index, "index of refraction of the dielectric; default 1.5", 1, most}};
}

List metal(std::string_view eta, std::string_view k) {
  return {{eta, spectrum_map, "index of refraction; default metal-Cu-eta", 0, most},
          {k, spectrum_map, "absorption coefficient; default metal-Cu-k", 0, most},
          {"reflectance", spectrum_map, "reflectance at normal incidence, instead of eta and k", 0, 1}};
}

std::vector<EntitySpec> opaque_materials() {
  return {
      {"diffuse", "Lambertian reflection",
       join({{{"reflectance", spectrum_map, "albedo; default 0.5", 0, 1}}, common()})},
      {"coateddiffuse", "a diffuse base under a rough dielectric coat",
       join({{{"reflectance", spectrum_map, "albedo of the base; default 0.5", 0, 1},
              {"eta", index, "index of refraction of the coat; default 1.5", 1e-3, most}},
             roughness("roughness", "uroughness", "vroughness"),
             remap(),
             layer(),
             common()})},
      {"coatedconductor", "a metal under a rough dielectric coat",
       join({metal("conductor.eta", "conductor.k"),
             roughness("conductor.roughness", "conductor.uroughness", "conductor.vroughness"),
             {{"interface.eta", index, "index of refraction of the coat; default 1.5", 1e-3, most}},
             roughness("interface.roughness", "interface.uroughness", "interface.vroughness"),
             remap(),
             layer(),
             common()})},
      {"conductor", "a rough or smooth metal (GGX)",
       join({metal("eta", "k"), roughness("roughness", "uroughness", "vroughness"), remap(), common()})},
      {"phong", "Lafortune's energy-conserving Phong model",
       join({{{"kd", spectrum_map, "diffuse albedo; default 0.5", 0, 1},
              {"ks", spectrum_map, "glossy albedo; default 0.3", 0, 1},
              {"exponent", number_map, "exponent of the glossy lobe; default 32", 0, 1e6}},
             common()})},
      {"metallicroughness",
       "the material of glTF 2.0: a dielectric coat over a diffuse base, or a metal (Montelux alone)",
       join({metallic_roughness(), common()})},
      {"coatedmetallicroughness",
       "metallicroughness with a grain and a clear coat of index 1.5, as in extensions of glTF (Montelux "
       "alone)",
       join({metallic_roughness(),
             {{"clearcoat", number_map, "share of the coat; default 1", 0, 1},
              {"clearcoatroughness", number_map, "alpha of its facets is the square; default 0", 0, 1},
              {"coatnormaltexture", spectrum_map,
               "tangent-space normals of the coat; default: those of the surface, not of the base"},
              {"coatnormalscale", {number}, "factors of their x and y; default 1 1", -most, most, {}, true},
              {"anisotropy", number_map, "strength of the grain; default 0", 0, 1},
              {"anisotropyrotation", {number}, "rotation of the grain from u towards v in degrees; default 0"},
              {"grainx", number_map, "the unrotated grain, u component, from 0 (-1) to 1 (1); default 1", 0, 1},
              {"grainy", number_map, "the same along v; default 0.5, that is 0", 0, 1},
              {"grainmirrored", {boolean}, "v is against n x u; default false"}},
             common()})},
      {"mix",
       "a random choice between two materials at each point",
       {{"materials", {string}, "the names of two materials", -most, most, {}, true},
        {"amount", number_map, "share of the second material; default 0.5", 0, 1}}},
      {"interface", "no scattering at all: bounds a medium", {}},
  };
}

std::vector<EntitySpec> transparent_materials() {
  return {
      {"dielectric", "rough or smooth glass (GGX)",
       join({{{"eta", index, "index of refraction; default 1.5", 1e-3, most}},
             roughness("roughness", "uroughness", "vroughness"),
             remap(),
             common()})},
      {"tinteddielectric", "glass that tints transmitted light and absorbs inside (Montelux alone)",
       join({{{"eta", index, "index of refraction; default 1.5", 1e-3, most},
              {"tint", spectrum_map, "factor of transmitted light; default 1", 0, 1},
              {"absorption", {spectrum}, "absorption inside, per unit of length; default 0", 0, most}},
             roughness("roughness", "uroughness", "vroughness"),
             remap(),
             common()})},
      {"thindielectric", "a thin pane without refraction",
       join({{{"eta", index, "index of refraction; default 1.5", 1e-3, most},
              {"tint", spectrum_map, "factor of transmitted light; default 1 (Montelux alone)", 0, 1},
              {"roughness", number_map, "roughness of reflection and transmission; default 0 (Montelux alone)", 0,
               most}},
             remap(),
             common()})},
      {"diffusetransmission", "Lambertian reflection and transmission",
       join({{{"reflectance", spectrum_map, "albedo of reflection; default 0.25", 0, 1},
              {"transmittance", spectrum_map, "albedo of transmission; default 0.25", 0, 1},
              {"scale", {number}, "factor of both; default 1", 0, most}},
             common()})},
  };
}

std::vector<EntitySpec> later_materials() {
  return {
      {"hair", "a fibre (Chiang et al. 2016)",
       join({{{"sigma_a", spectrum_map, "absorption; default from the others", 0, most},
              {"reflectance", spectrum_map, "albedo, instead of the absorption", 0, 1},
              {"color", spectrum_map, "albedo, the older name", 0, 1},
              {"eumelanin", number_map, "concentration of eumelanin; default 1.3", 0, most},
              {"pheomelanin", number_map, "concentration of pheomelanin; default 0", 0, most},
              {"eta", number_map, "index of refraction; default 1.55", 1e-3, most},
              {"beta_m", number_map, "longitudinal roughness; default 0.3", 0, 1},
              {"beta_n", number_map, "azimuthal roughness; default 0.3", 0, 1},
              {"alpha", number_map, "tilt of the scales in degrees; default 2", -90, 90}},
             common()}),
       true, "diffuse"},
      {"subsurface", "a dielectric over a scattering medium",
       join({{{"name", {string}, "a measured material"},
              {"sigma_a", spectrum_map, "absorption per millimetre; default 0.0011 0.0024 0.014", 0, most},
              {"sigma_s", spectrum_map, "scattering per millimetre; default 2.55 3.21 3.77", 0, most},
              {"mfp", spectrum_map, "mean free path, with reflectance", 0, most},
              {"reflectance", spectrum_map, "albedo, with mfp", 0, 1},
              {"scale", {number}, "factor of the coefficients; default 1", 0, most},
              {"g", {number}, "asymmetry; default 0", -1, 1},
              {"eta", {number}, "index of refraction; default 1.33", 1e-3, most}},
             roughness("roughness", "uroughness", "vroughness"),
             remap(),
             common()}),
       true, "diffuse"},
      {"measured", "a tabulated BRDF", join({{{"filename", {string}, "the table"}}, common()}), true, "diffuse"},
  };
}

}  // namespace

std::span<const EntitySpec> material_table() {
  static const std::vector<EntitySpec> table = [] {
    std::vector<EntitySpec> all = opaque_materials();
    for (auto more : {transparent_materials(), later_materials()}) all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return table;
}

}  // namespace montelux
