// A material as stated by a scene: plain data, with the values that hold where nothing is stated.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "parameter/input.h"

namespace montelux {

// ---- what several materials have ------------------------------------------------------------------------------------

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

// ---- the materials --------------------------------------------------------------------------------------------------

// `maps_roughness`: the roughness is perceptual, and GGX's alpha is its square root; otherwise it is alpha.

struct DiffuseDesc {
  SpectrumInput albedo = gray_value(0.5f);
  bool operator==(const DiffuseDesc&) const = default;
};

// A diffuse base under a dielectric coat.
struct CoatedDiffuseDesc {
  SpectrumInput albedo = gray_value(0.5f);  // of the base
  IndexInput eta = 1.5f;                    // of the coat
  FacetsDesc facets{};                      // of the coat
  bool maps_roughness = true;
  LayerDesc layer{};
  bool operator==(const CoatedDiffuseDesc&) const = default;
};

// A metal under a dielectric coat.
struct CoatedConductorDesc {
  MetalDesc metal{};
  FacetsDesc metal_facets{};
  IndexInput coat_eta = 1.5f;
  FacetsDesc coat_facets{};
  bool maps_roughness = true;  // of both
  LayerDesc layer{};
  bool operator==(const CoatedConductorDesc&) const = default;
};

struct ConductorDesc {
  MetalDesc metal{};
  FacetsDesc facets{};
  bool maps_roughness = true;
  bool operator==(const ConductorDesc&) const = default;
};

// Lafortune's energy-conserving Phong model.
struct PhongDesc {
  SpectrumInput diffuse_albedo = gray_value(0.5f), glossy_albedo = gray_value(0.3f);
  NumberInput exponent = 32.0f;  // of the glossy lobe
  bool operator==(const PhongDesc&) const = default;
};

// The material of glTF 2.0: a dielectric coat over a diffuse base, or a metal.
struct MetallicRoughnessDesc {
  SpectrumInput base_color = gray_value(1);  // albedo of the diffuse part, and colour of the metal
  NumberInput metallic = 1.0f;               // share of the metal
  NumberInput roughness = 1.0f;              // GGX's alpha is its square
  NumberInput specular = 1.0f;               // strength of the dielectric's reflection
  SpectrumInput specular_color = gray_value(1);
  IndexInput eta = 1.5f;  // of the dielectric
  bool operator==(const MetallicRoughnessDesc&) const = default;
};

// The same with a grain, and under a clear coat of index 1.5.
struct CoatedMetallicRoughnessDesc {
  MetallicRoughnessDesc base{};
  NumberInput coat = 1.0f;            // share of the coat
  NumberInput coat_roughness = 0.0f;  // GGX's alpha is its square
  NormalMapDesc coat_normals{};
  NumberInput anisotropy = 0.0f;   // strength of the grain
  float grain_rotation = 0;        // from u towards v, in degrees
  NumberInput grain_x = 1.0f;      // the unrotated grain's component along u, from 0 (-1) to 1 (1)
  NumberInput grain_y = 0.5f;      // the same along v
  bool grain_is_mirrored = false;  // v is against n x u
  bool operator==(const CoatedMetallicRoughnessDesc&) const = default;
};

// A random choice between two materials at each point.
struct MixDesc {
  std::vector<std::string> materials{};  // the names of two
  NumberInput amount = 0.5f;             // share of the second
  bool operator==(const MixDesc&) const = default;
};

// No scattering at all: bounds a medium.
struct InterfaceDesc {
  bool operator==(const InterfaceDesc&) const = default;
};

// Glass.
struct DielectricDesc {
  IndexInput eta = 1.5f;
  FacetsDesc facets{};
  bool maps_roughness = true;
  bool operator==(const DielectricDesc&) const = default;
};

// Glass that tints transmitted light and absorbs inside.
struct TintedDielectricDesc {
  IndexInput eta = 1.5f;
  SpectrumInput tint = gray_value(1);        // factor of transmitted light
  SpectrumValue absorption = gray_value(0);  // inside, per unit of length
  FacetsDesc facets{};
  bool maps_roughness = true;
  bool operator==(const TintedDielectricDesc&) const = default;
};

// A pane without refraction.
struct ThinDielectricDesc {
  IndexInput eta = 1.5f;
  SpectrumInput tint = gray_value(1);  // factor of transmitted light
  NumberInput roughness = 0.0f;        // of reflection and transmission
  bool maps_roughness = true;
  bool operator==(const ThinDielectricDesc&) const = default;
};

struct DiffuseTransmissionDesc {
  SpectrumInput reflected = gray_value(0.25f), transmitted = gray_value(0.25f);  // albedos
  float scale = 1;                                                               // factor of both
  bool operator==(const DiffuseTransmissionDesc&) const = default;
};

// A tabulated reflection, of both sides alike.
struct MeasuredDesc {
  std::string file{};  // *.bsdf of the RGL material database
  bool operator==(const MeasuredDesc&) const = default;
};

using MaterialModel =
    std::variant<DiffuseDesc, CoatedDiffuseDesc, CoatedConductorDesc, ConductorDesc, PhongDesc, MetallicRoughnessDesc,
                 CoatedMetallicRoughnessDesc, MixDesc, InterfaceDesc, DielectricDesc, TintedDielectricDesc,
                 ThinDielectricDesc, DiffuseTransmissionDesc, MeasuredDesc>;

struct MaterialDesc {
  std::string name{};  // empty if it was stated in place
  MaterialModel model{};
  // Of all but mixtures and interfaces.
  std::string normal_file{};  // an image of normals; a texture has precedence
  NormalMapDesc normals{};
  std::optional<NumberInput> displacement{};  // height of bumps in scene units, not applied yet
  SourceLocation where{};
};

}  // namespace montelux
