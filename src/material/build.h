// From stated materials to models with their parameters: constants are set once, the rest is bound to textures.
#pragma once
#include <functional>
#include <optional>

#include "color/sampled_spectrum.h"
#include "material/bound_material.h"
#include "material/coat_table.h"
#include "material/description.h"
#include "texture/build.h"

namespace montelux {

// What the builder needs from the scene.
struct MaterialInputs {
  TextureBuilder& textures;
  std::function<ConductorRgb(const SpectrumValue& eta, const SpectrumValue& k)> conductor;
  std::function<Rgb(const SpectrumValue&)> unbounded;  // an index or an absorption
  std::function<float(const SpectrumValue&)> index;    // one index of refraction for all wavelengths
  std::function<std::optional<std::uint32_t>(const std::string&)> material;  // number of a named material
  // The table of a file; null if it cannot be read, which has been reported.
  std::function<std::shared_ptr<const MeasuredTable>(const std::string& file, const SourceLocation& where)> measured;
  CoatTables& coats;
  Diagnostics& diagnostics;
};

// What cannot be built is reported, and a default is used.
Material build_material(const MaterialDesc& desc, const MaterialInputs& inputs);

}  // namespace montelux
