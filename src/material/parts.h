// Parts of what scenes state of materials: plain data, with the values that hold where nothing is stated.
//
// What a scene states of a model is a struct beside it (PhongDesc of Phong). Besides its members, such a struct defines
//   static constexpr std::string_view meaning;
//   static Fields<PhongDesc> rows(): its parameters, by which readers, writer and documentation know them;
//   void fill(RowBuilder&) const: how they become the slots of a row.
// Those that all models have (MaterialDesc) are not among them. Where it has a member `maps_roughness`, that states
// whether roughness is perceptual, and GGX's alpha is its square root; otherwise it is alpha.
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "parameter/input.h"

namespace montelux {

template <class S>
class Fields;
class RowBuilder;

// The facets of a rough boundary (GGX). 0: it is smooth.
struct FacetsDesc {
  NumberInput roughness = 0.0f;                             // in both directions
  std::optional<NumberInput> roughness_u{}, roughness_v{};  // along one of them; none: that of both
  bool operator==(const FacetsDesc&) const = default;
};

// A metal, by its index of refraction or by its reflectance.
struct MetalDesc {
  SpectrumInput eta = SpectrumValue(NamedSpectrum{"metal-Cu-eta"});  // real part of the index
  SpectrumInput k = SpectrumValue(NamedSpectrum{"metal-Cu-k"});      // imaginary part: absorption
  std::optional<SpectrumInput> reflectance{};                        // at normal incidence, instead of eta and k
  bool operator==(const MetalDesc&) const = default;
};

// What is inside a coat, and how light is traced through it.
struct LayerDesc {
  NumberInput thickness = 0.01f;         // in scene units
  NumberInput g = 0.0f;                  // asymmetry of scattering (Henyey and Greenstein), in [-1, 1]
  SpectrumInput albedo = gray_value(0);  // of single scattering
  int max_depth = 10;                    // maximum number of bounces between the layers
  int samples = 1;                       // random walks per evaluation
  bool operator==(const LayerDesc&) const = default;
};

// Tangent-space normals, stored as colours; none: those of the surface.
struct NormalMapDesc {
  std::optional<SpectrumInput> texture{};
  std::array<float, 2> scale{1, 1};  // factors of x and y of the normals
  bool operator==(const NormalMapDesc&) const = default;
};

}  // namespace montelux
