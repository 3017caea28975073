// Names that may be used before they are defined.
#include "io/pbrt/parser.h"
#include "io/text_file.h"

namespace montelux::pbrt {

namespace {

std::string did_you_mean(const std::string& name, const std::vector<std::string_view>& known) {
  std::string_view near = nearest_name(name, known);
  return near.empty() ? "" : "did you mean '" + std::string(near) + "'?";
}

}  // namespace

void Parser::resolve_textures() {
  for (const TextureUse& use : texture_uses_) {
    bool as_number = number_textures_.contains(use.name), as_spectrum = spectrum_textures_.contains(use.name);
    if ((use.takes_number && as_number) || (use.takes_spectrum && as_spectrum)) continue;
    std::string quoted = "texture '" + printable(use.name) + "'";
    if (as_number || as_spectrum) {
      report_.error(use.where, quoted + " is of " + (as_number ? "\"float\"" : "\"spectrum\"") +
                                   "; here it must be of " + (as_number ? "\"spectrum\"" : "\"float\""));
      continue;
    }
    std::vector<std::string_view> known;
    if (use.takes_number)
      for (const auto& [name, where] : number_textures_) known.push_back(name);
    if (use.takes_spectrum)
      for (const auto& [name, where] : spectrum_textures_) known.push_back(name);
    report_.error(use.where, "there is no " + quoted, did_you_mean(use.name, known));
  }
}

std::vector<std::string_view> Parser::material_names() const {
  std::vector<std::string_view> names;
  for (const auto& [name, id] : named_materials_) names.push_back(name);
  return names;
}

void Parser::resolve_materials() {
  std::vector<std::uint32_t> found(material_uses_.size(), 0);
  for (std::size_t i = 0; i < material_uses_.size(); ++i) {
    const NameUse& use = material_uses_[i];
    auto named = named_materials_.find(use.name);
    if (named != named_materials_.end())
      found[i] = static_cast<std::uint32_t>(named->second);
    else
      report_.error(use.where, "there is no material '" + printable(use.name) + "'",
                    did_you_mean(use.name, material_names()));
  }
  auto resolve = [&](ShapeDesc& shape) {
    auto id = static_cast<std::uint32_t>(shape.material);
    if (id & named_material) shape.material = static_cast<MaterialDescId>(found[id & ~named_material]);
  };
  for (ShapeDesc& shape : scene_.shapes) resolve(shape);
  for (ObjectDesc& object : scene_.objects)
    for (ShapeDesc& shape : object.shapes) resolve(shape);

  // A mixture names only materials before it, so that none can contain itself.
  for (const MixtureUse& use : mixture_uses_)
    for (const std::string& name : std::get<MixDesc>(scene_.materials[use.mixture].model).materials) {
      auto named = named_materials_.find(name);
      if (named == named_materials_.end())
        report_.error(use.where, "there is no material '" + printable(name) + "'",
                      did_you_mean(name, material_names()));
      else if (static_cast<std::size_t>(named->second) >= use.mixture)
        report_.error(use.where, "material '" + printable(name) + "' must be defined before the mixture of it");
    }
}

void Parser::resolve_media() {
  std::vector<std::string_view> names;
  for (const auto& [name, medium] : media_)
    if (medium.is_defined) names.push_back(name);
  for (const auto& [name, medium] : media_)
    if (!medium.is_defined)
      report_.error(medium.first_use, "there is no medium '" + printable(name) + "'", did_you_mean(name, names));
}

void Parser::resolve_instances() {
  std::vector<std::string_view> names;
  for (const auto& [name, id] : object_ids_) names.push_back(name);
  for (std::size_t i = 0; i < instance_uses_.size(); ++i) {
    auto object = object_ids_.find(instance_uses_[i].name);
    if (object != object_ids_.end())
      scene_.instances[i].object = object->second;
    else
      report_.error(instance_uses_[i].where, "there is no object '" + printable(instance_uses_[i].name) + "'",
                    did_you_mean(instance_uses_[i].name, names));
  }
}

}  // namespace montelux::pbrt
