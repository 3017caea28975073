#include "material/build.h"

#include <fmt/format.h>

#include "material/row_builder.h"

namespace montelux {

namespace {

// The parts of a mixture, which scatter instead of it.
void fill_mixture(const MixDesc& stated, const MaterialInputs& inputs, RowBuilder& builder) {
  if (stated.materials.size() != 2) {
    builder.error(fmt::format("a mix takes the names of two materials; found {}", stated.materials.size()));
    return;
  }
  Mixture mixture{{0, 0}, inputs.textures.number(stated.amount)};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto part = inputs.material(stated.materials[i]);
    if (!part) builder.error(fmt::format("the mix names material \"{}\", which is not defined", stated.materials[i]));
    mixture.children[i] = part.value_or(0);
  }
  builder.material().mixture = mixture;
}

}  // namespace

Material build_material(const MaterialDesc& desc, const MaterialInputs& inputs) {
  Material material;
  RowBuilder builder(inputs, desc.where, material);
  const auto fill = [&]<class Stated>(const Stated& stated) {
    if constexpr (std::is_same_v<Stated, MixDesc>) {
      fill_mixture(stated, inputs, builder);
    } else if constexpr (std::is_same_v<Stated, InterfaceDesc>) {
      material.is_interface = true;
    } else {
      material.kind = kind_stated_by<Stated>;
      stated.fill(builder);
    }
  };
  std::visit(fill, desc.model);
  if (material.mixture || material.is_interface) return material;
  if (!desc.normal_file.empty())
    material.normal_map = inputs.textures.image(desc.normal_file, desc.where, ColorEncoding{});
  if (desc.normals.texture) material.normal_texture = inputs.textures.spectrum(*desc.normals.texture);
  material.normal_scale = {desc.normals.scale[0], desc.normals.scale[1]};
  return material;
}

}  // namespace montelux
