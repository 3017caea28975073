// Textures as stated by a scene: plain data. Inputs are values or the names of textures stated before. A texture is of
// numbers or of spectra; a number that a texture of spectra takes is the same in all components.
#pragma once
#include <string>
#include <string_view>

#include "texture/models.h"

namespace montelux {

// The name by which files and programs state it.
std::string_view name_of(const TextureModel& model);
// Whether a texture of spectra, or of numbers, can be of this model.
bool can_be(const TextureModel& model, bool is_spectrum);

struct TextureDesc {
  std::string name;
  bool is_spectrum = false;  // false: a texture of numbers
  TextureModel model{};
  Transform texture_to_world{};
  SourceLocation where{};
};

}  // namespace montelux
