// A material of a scene: its model with parameters that are constants or bound to textures, and the look-ups at points.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "material/material.h"
#include "texture/texture_set.h"

namespace montelux {

class CoatTable;
class MeasuredTable;

// How the value of a texture is converted to a number of a row.
enum class RowEncoding : std::uint8_t {
  plain,
  unit,             // scaled, then clamped to [0, 1]
  signed_unit,      // 2 x - 1, as images store directions
  roughness,        // alpha = sqrt(roughness)
  reflectance_to_k  // for a metal with eta = 1: k = 2 sqrt(r / (1 - r))
};

// A slot of the row that a texture sets at each point; a spectrum sets spectrum_size slots.
struct RowBinding {
  std::uint8_t slot;
  RowEncoding encoding;
  bool is_spectrum;
  std::uint32_t texture;  // NumberTextureId or SpectrumTextureId
  float scale;            // factor of the encoded value; for unit, of the texture's value
};

// The number in the slot, by the value of the texture.
float encoded(float x, const RowBinding& binding);

// A choice between two materials.
struct Mixture {
  std::array<std::uint32_t, 2> children;  // material numbers
  NumberTextureId amount;                 // probability of the second
};

struct Material {
  BsdfKind kind = kind_of<Diffuse>;
  BsdfRow row;
  std::vector<RowBinding> bindings;
  std::optional<Mixture> mixture;
  std::shared_ptr<const MeasuredTable> table;  // whose address is in the row
  std::shared_ptr<const CoatTable> coat;       // of a CoatedDiffuse whose roughness is a texture
  std::shared_ptr<const TexelImage> normal_map;
  std::optional<SpectrumTextureId> normal_texture;       // instead of the image
  Vec2f normal_scale{1, 1};                              // factors of x and y of the mapped normal
  std::optional<SpectrumTextureId> coat_normal_texture;  // for the coat; without it the coat has the surface's normals
  Vec2f coat_normal_scale{1, 1};
  bool is_interface = false;

  bool has_normal_map() const { return normal_map || normal_texture; }
  bool has_any_normal_map() const { return has_normal_map() || coat_normal_texture; }

  // Nothing has to be looked up per point.
  bool is_plain() const { return bindings.empty() && !mixture && !has_any_normal_map() && !is_interface; }
};

// Whether the parametrisation of a surface with this material matters.
bool uses_parameters(const Material& material);
// Writes the values of the textures into the slots, in the lanes that are on; other lanes are unchanged.
template <class F>
void look_up_slots(const Material& material, const TextureSet& textures, const TexturePoints<F>& points, Mask<F> on,
                   BsdfSlots<F>& slots);
// All parameters at a point.
BsdfRow material_row(const Material& material, const TextureSet& textures, const TexturePoint& point);
// The normal of the map at the points in the tangent frame, not unit. Only if there is a map.
template <class F>
Vec3<F> mapped_normal(const Material& material, const TextureSet& textures, const TexturePoints<F>& points, Mask<F> on);
// The same for the coat, if it has a map of its own.
template <class F>
Vec3<F> mapped_coat_normal(const Material& material, const TextureSet& textures, const TexturePoints<F>& points,
                           Mask<F> on);

}  // namespace montelux
