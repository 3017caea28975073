// Parameter rows for every model of the closed list: a model without cases does not compile.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "material/coat_integrals.h"
#include "material/material.h"
#include "material/measured_file.h"
#include "measured_files.h"

namespace montelux::test {

struct BsdfCase {
  std::string label;
  BsdfRow row;
  bool lossless = false;   // all light comes back, in importance mode
  int panels = 1;          // for the quadrature of the density: more for sharp lobes
  bool reciprocal = true;  // not where parts have normals of their own: each has the cosine to its own
};

// A number, or a colour as paths carry it.
struct SlotValue {
  SlotValue(float x) : numbers{x} {}
  SlotValue(const Rgb& x) {
    const Spectrum<float> carried = from_rgb(x);
    numbers.assign(carried.c, carried.c + spectrum_size);
  }
  std::vector<float> numbers;
};
inline void put(BsdfRow& row, int slot, std::initializer_list<SlotValue> values) {
  for (const SlotValue& value : values)
    for (float v : value.numbers) row.v[slot++] = v;
}

template <BsdfKind kind>
struct CasesOf;

template <>
struct CasesOf<kind_of<Diffuse>> {
  static std::vector<BsdfCase> all() {
    BsdfCase grey{"coloured", {}}, white{"white", {}, true};
    put(grey.row, DiffuseSlots::reflectance, {Rgb{{0.8f, 0.5f, 0.1f}}});
    put(white.row, DiffuseSlots::reflectance, {gray_rgb(1)});
    return {grey, white};
  }
};

template <>
struct CasesOf<kind_of<Phong>> {
  static std::vector<BsdfCase> all() {
    BsdfCase broad{"broad", {}}, sharp{"sharp", {}}, pure{"without a diffuse part", {}};
    put(broad.row, PhongSlots::diffuse, {Rgb{{0.3f, 0.2f, 0.1f}}, Rgb{{0.4f, 0.5f, 0.6f}}, 5});
    put(sharp.row, PhongSlots::diffuse, {gray_rgb(0.5f), gray_rgb(0.4f), 80});
    put(pure.row, PhongSlots::diffuse, {Rgb{}, gray_rgb(0.9f), 20});
    return {broad, sharp, pure};
  }
};

inline BsdfCase metallic_roughness_case(std::string label, const Rgb& base, float metallic, float roughness,
                                        float specular = 1) {
  BsdfCase c{std::move(label), {}};
  using Slots = MetallicRoughnessSlots;
  put(c.row, Slots::base, {base});
  put(c.row, Slots::metallic, {metallic, roughness, specular, gray_rgb(1), 0.04f});
  return c;
}
template <>
struct CasesOf<kind_of<MetallicRoughness>> {
  static std::vector<BsdfCase> all() {
    BsdfCase tinted = metallic_roughness_case("strong tinted reflection", {{0.6f, 0.7f, 0.8f}}, 0.1f, 0.5f, 0.7f);
    put(tinted.row, MetallicRoughnessSlots::specular_color, {Rgb{{9, 4, 1}}});
    return {metallic_roughness_case("plastic", {{0.8f, 0.4f, 0.2f}}, 0, 0.4f),
            metallic_roughness_case("white plastic", gray_rgb(1), 0, 0.3f),
            metallic_roughness_case("white, rough", gray_rgb(1), 0, 1),
            metallic_roughness_case("white, smooth", gray_rgb(1), 0, 0),
            metallic_roughness_case("metal", {{0.9f, 0.7f, 0.3f}}, 1, 0.45f),
            metallic_roughness_case("mirror", {{0.9f, 0.7f, 0.3f}}, 1, 0),
            metallic_roughness_case("half a metal", {{0.5f, 0.6f, 0.7f}}, 0.5f, 0.6f),
            metallic_roughness_case("no reflection", {{0.5f, 0.6f, 0.7f}}, 0, 0.5f, 0),
            tinted};
  }
};

// A grain of this strength along the turned x axis under a share of a coat.
inline BsdfCase coated_metallic_case(std::string label, float metallic, float roughness, float anisotropy, float coat,
                                     float coat_roughness) {
  BsdfCase c = metallic_roughness_case(std::move(label), {{0.9f, 0.5f, 0.2f}}, metallic, roughness);
  put(c.row, CoatedMetallicRoughnessSlots::anisotropy,
      {anisotropy, 0.6f, -0.3f, 0.8f, 0.6f, coat, coat_roughness, -1, 0, 0, 1});
  return c;
}
template <>
struct CasesOf<kind_of<CoatedMetallicRoughness>> {
  static std::vector<BsdfCase> all() {
    BsdfCase white = coated_metallic_case("white under a rough coat", 0, 0.8f, 0, 1, 1);
    put(white.row, MetallicRoughnessSlots::base, {gray_rgb(1)});
    BsdfCase mirror = coated_metallic_case("white mirror under a smooth coat", 1, 0, 0, 1, 0);
    put(mirror.row, MetallicRoughnessSlots::base, {gray_rgb(1)});
    BsdfCase turned = coated_metallic_case("a grain of no direction", 1, 0.5f, 0.7f, 0.2f, 0.7f);
    put(turned.row, CoatedMetallicRoughnessSlots::grain_x, {0, 0});
    BsdfCase bent = coated_metallic_case("metal with a grain under a coat that looks away", 1, 0.4f, 0.5f, 1, 0.5f);
    put(bent.row, CoatedMetallicRoughnessSlots::coat_normal, {0.48f, -0.36f, 0.8f});
    bent.reciprocal = false;
    return {bent,
            coated_metallic_case("paint under a smooth coat", 0, 0.6f, 0, 1, 0),
            coated_metallic_case("metal under a rough coat", 1, 0.5f, 0, 0.8f, 0.5f),
            coated_metallic_case("metal with a grain", 1, 0.4f, 0.9f, 0, 0),
            coated_metallic_case("half a metal with a grain under half a coat", 0.5f, 0.5f, 0.5f, 0.5f, 0.4f),
            turned,
            white,
            mirror};
  }
};

inline BsdfCase conductor_case(std::string label, float alpha_x, float alpha_y, int first = 0) {
  BsdfCase c{std::move(label), {}};
  put(c.row, first + ConductorSlots::alpha_x, {alpha_x, alpha_y, Rgb{{0.2f, 0.92f, 1.1f}}, Rgb{{3.9f, 2.45f, 2.14f}}});
  return c;
}
template <>
struct CasesOf<kind_of<Conductor>> {
  static std::vector<BsdfCase> all() {
    return {conductor_case("rough", 0.5f, 0.5f), conductor_case("glossy", 0.15f, 0.15f),
            conductor_case("anisotropic", 0.1f, 0.5f), conductor_case("smooth", 0, 0)};
  }
};

inline BsdfCase dielectric_case(std::string label, float alpha_x, float alpha_y, float eta, int panels = 1) {
  BsdfCase c{std::move(label), {}, alpha_x < 1e-3f && alpha_y < 1e-3f, panels};
  put(c.row, DielectricSlots::alpha_x, {alpha_x, alpha_y, eta});
  return c;
}
template <>
struct CasesOf<kind_of<Dielectric>> {
  static std::vector<BsdfCase> all() {
    return {dielectric_case("rough", 0.5f, 0.5f, 1.5f), dielectric_case("glossy", 0.15f, 0.15f, 1.5f, 3),
            dielectric_case("anisotropic", 0.2f, 0.6f, 1.33f), dielectric_case("rarer below", 0.3f, 0.3f, 0.75f),
            dielectric_case("smooth", 0, 0, 1.5f)};
  }
};

// What absorbs on its way to the surface does so whatever comes then, and is tested on paths.
template <>
struct CasesOf<kind_of<TintedDielectric>> {
  static std::vector<BsdfCase> all() {
    std::vector<BsdfCase> cases{dielectric_case("rough", 0.5f, 0.5f, 1.5f),
                                dielectric_case("anisotropic", 0.2f, 0.6f, 1.33f),
                                dielectric_case("smooth", 0, 0, 1.5f)};
    for (BsdfCase& c : cases) {
      put(c.row, TintedDielectricSlots::tint, {Rgb{{0.3f, 0.9f, 0.6f}}, Rgb{{1, 2, 3}}});
      c.lossless = false;
    }
    return cases;
  }
};

template <>
struct CasesOf<kind_of<ThinDielectric>> {
  static std::vector<BsdfCase> all() {
    BsdfCase pane{"pane", {}, true}, green{"green pane", {}};
    put(pane.row, ThinDielectricSlots::eta, {1.5f, gray_rgb(1)});
    put(green.row, ThinDielectricSlots::eta, {1.5f, Rgb{{0.2f, 0.8f, 0.4f}}});
    BsdfCase rough{"rough pane", {}}, frosted{"frosted green pane", {}};
    put(rough.row, ThinDielectricSlots::eta, {1.5f, gray_rgb(1), 0.3f});
    put(frosted.row, ThinDielectricSlots::eta, {1.33f, Rgb{{0.2f, 0.8f, 0.4f}}, 0.7f});
    return {pane, green, rough, frosted};
  }
};

template <>
struct CasesOf<kind_of<DiffuseTransmission>> {
  static std::vector<BsdfCase> all() {
    BsdfCase leaf{"leaf", {}}, lossless{"lossless", {}, true};
    put(leaf.row, DiffuseTransmissionSlots::reflectance, {Rgb{{0.3f, 0.2f, 0.1f}}, Rgb{{0.1f, 0.6f, 0.2f}}});
    put(lossless.row, DiffuseTransmissionSlots::reflectance, {gray_rgb(0.3f), gray_rgb(0.7f)});
    return {leaf, lossless};
  }
};

struct CoatCase {
  float alpha_x = 0, alpha_y = 0, eta = 1.5f, thickness = 0.01f, g = 0, albedo = 0, max_depth = 10, samples = 1;
};
inline void put(BsdfRow& row, const CoatCase& c) {
  put(row, LayeredSlots::alpha_x,
      {c.alpha_x, c.alpha_y, c.eta, c.thickness, c.g, gray_rgb(c.albedo), c.max_depth, c.samples});
}
inline BsdfCase coated_diffuse_case(std::string label, const CoatCase& coat, float reflectance) {
  BsdfCase c{std::move(label), {}};
  put(c.row, coat);
  put(c.row, CoatedDiffuseSlots::reflectance, {Rgb{{reflectance, 0.5f * reflectance, 0.25f * reflectance}}});
  return c;
}
// The same with its walks summed in closed form.
inline BsdfCase summed_coat_case(std::string label, const CoatCase& coat, float reflectance) {
  BsdfCase c = coated_diffuse_case(std::move(label), coat, reflectance);
  const CoatParameters parameters{{coat.alpha_x, coat.alpha_y}, coat.eta, coat.thickness};
  put(c.row, CoatedDiffuseSlots::internal, {internal_reflectance(parameters)});
  std::ranges::copy(coat_transmittance::series(parameters), c.row.v + CoatedDiffuseSlots::series);
  return c;
}
inline BsdfCase coated_conductor_case(std::string label, const CoatCase& coat, float alpha_x, float alpha_y) {
  BsdfCase c = conductor_case(std::move(label), alpha_x, alpha_y, LayeredSlots::base);
  put(c.row, coat);
  return c;
}

template <>
struct CasesOf<kind_of<CoatedDiffuse>> {
  static std::vector<BsdfCase> all() {
    return {coated_diffuse_case("smooth coat", {}, 0.8f),
            coated_diffuse_case("rough coat", {.alpha_x = 0.4f, .alpha_y = 0.4f}, 0.8f),
            coated_diffuse_case("anisotropic coat", {.alpha_x = 0.1f, .alpha_y = 0.5f, .samples = 2}, 0.8f),
            coated_diffuse_case("scattering medium",
                                {.alpha_x = 0.3f, .alpha_y = 0.3f, .thickness = 0.5f, .g = 0.5f, .albedo = 0.8f}, 0.6f),
            coated_diffuse_case("smooth coat, scattering medium, odd depth",
                                {.thickness = 0.5f, .g = -0.3f, .albedo = 0.9f, .max_depth = 5}, 0.6f),
            coated_diffuse_case("odd depth", {.alpha_x = 0.2f, .alpha_y = 0.2f, .max_depth = 3}, 0.9f),
            summed_coat_case("smooth coat, summed", {}, 0.8f),
            summed_coat_case("rough coat, summed", {.alpha_x = 0.4f, .alpha_y = 0.4f}, 0.8f),
            summed_coat_case("anisotropic thick coat, summed, odd depth",
                             {.alpha_x = 0.1f, .alpha_y = 0.5f, .thickness = 0.2f, .max_depth = 5}, 0.9f)};
  }
};

template <>
struct CasesOf<kind_of<CoatedConductor>> {
  static std::vector<BsdfCase> all() {
    return {coated_conductor_case("smooth coat", {}, 0.4f, 0.4f),
            coated_conductor_case("rough coat, smooth base", {.alpha_x = 0.4f, .alpha_y = 0.4f}, 0, 0),
            coated_conductor_case("rough coat, anisotropic base", {.alpha_x = 0.3f, .alpha_y = 0.3f}, 0.2f, 0.5f),
            coated_conductor_case("smooth coat, scattering medium, smooth base",
                                  {.thickness = 0.4f, .g = 0.3f, .albedo = 0.7f}, 0, 0),
            coated_conductor_case("smooth coat, smooth base", {}, 0, 0)};
  }
};

// Interpolation is not reciprocal. The tables live as long as the program.
template <>
struct CasesOf<kind_of<Measured>> {
  static std::vector<BsdfCase> all() {
    static const std::vector<MeasuredTable> tables = [] {
      std::vector<MeasuredTable> made;
      const auto add = [&](const ClosedLobe& lobe, const Tabulation& t) {
        made.emplace_back(std::move(read_measured_data(measured_file(lobe, t))).value());
      };
      add({0.7, 0.7, {0.8, 0.5, 0.2}, {}}, {.facets = 24, .values = 16});
      add({0.3, 0.3, {0.1, 0.2, 0.05}, {0.6, 0.4, 0.3}}, {});
      add({0.25, 0.5, {0.1, 0.1, 0.1}, {0.7, 0.5, 0.3}}, {.azimuths = 7, .parts = 4});
      return made;
    }();
    std::vector<BsdfCase> cases{{"matte", {}}, {"glossy", {}}, {"brushed", {}}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
      put_address(&tables[i], cases[i].row.v + MeasuredSlots::table);
      cases[i].reciprocal = false;
    }
    return cases;
  }
};

// Calls f.template operator()<kind>() for each kind of the closed list.
template <class Function>
void for_each_kind(Function&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) { (f.template operator()<BsdfKind(I)>(), ...); }
  (std::make_index_sequence<bsdf_kind_count>());
}

// Calls f(model, case) with the model of each case in one lane.
template <class Function>
void for_each_case(Function&& f) {
  for_each_kind([&]<BsdfKind kind>() {
    for (const BsdfCase& c : CasesOf<kind>::all()) f(BsdfOf<kind, float>(BsdfRows<float>{&c.row}), c);
  });
}

template <class Model>
inline constexpr bool is_layered = false;
template <>
inline constexpr bool is_layered<CoatedDiffuse<float>> = true;
template <>
inline constexpr bool is_layered<CoatedConductor<float>> = true;

inline Vec3f direction(float cos, float turns) {
  const SinCos<float> azimuth = sin_cos_two_pi(turns);
  const float sine = std::sqrt(1 - cos * cos);
  return {sine * azimuth.cos, sine * azimuth.sin, cos};
}
// Straight on, oblique, grazing, and from below.
inline std::vector<Vec3f> outgoing_directions() {
  return {direction(0.95f, 0.1f), direction(0.6f, 0.3f), direction(0.1f, 0.85f), direction(-0.5f, 0.6f)};
}

inline BsdfContext<float> context_of(RandomStream<float>& stream, TransportMode mode = TransportMode::radiance) {
  const std::uint32_t key = std::uint32_t(stream.next() * 0x1p24f);
  return {mode, RandomStream<float>(key, 0x6d2b79f5u)};
}
// The same, asking for densities that are no estimates.
inline BsdfContext<float> exact_context_of(RandomStream<float>& stream) {
  BsdfContext<float> context = context_of(stream);
  context.densities = Densities::exact;
  return context;
}

}  // namespace montelux::test
