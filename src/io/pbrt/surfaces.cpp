// Textures, materials, lights; media by name.
#include <utility>

#include "io/pbrt/parser.h"
#include "io/read_model.h"
#include "io/text_file.h"
#include "light/table.h"
#include "material/table.h"
#include "medium/table.h"
#include "texture/table.h"

namespace montelux::pbrt {

void Parser::directive_texture() {
  auto name = quoted_argument("a name");
  if (!name) return;
  Token kind_token = lexer_->peek();
  auto kind_name = quoted_argument("\"float\" or \"spectrum\"");
  if (!kind_name) return;
  Token type = lexer_->peek();
  auto type_name = quoted_argument("the name of a texture's type");
  if (!type_name) return;
  ParameterList stated = parameters();
  if (!is_in_world(true)) return;
  if (*kind_name != "float" && *kind_name != "spectrum")
    return report_.error(lexer_->where(kind_token),
                         "a texture is of \"float\" or \"spectrum\"; found '" + printable(*kind_name) + "'");
  TextureKind kind = *kind_name == "float" ? TextureKind::number : TextureKind::spectrum;
  SourceLocation where = here();
  auto& names = kind == TextureKind::number ? number_textures_ : spectrum_textures_;
  auto texture = stated_entity(Family::texture, *type_name, lexer_->where(type), stated, kind);
  if (texture) check_texture_of_texture(*texture, kind);
  // The name counts as defined even if the texture is invalid, so that its uses are not reported as well.
  auto [first, is_new] = names.emplace(*name, where);
  if (!is_new)
    return report_.error(where, "texture '" + printable(*name) + "' is defined twice",
                         "first in line " + std::to_string(first->second.line));
  if (!texture) return;
  std::optional<TextureDesc> desc = read_model(texture_models(), Family::texture, texture->entity, report_);
  if (!desc) return;
  desc->name = *name, desc->is_spectrum = kind == TextureKind::spectrum, desc->where = texture->entity.where;
  desc->texture_to_world = still_transform("texture");
  if (!can_be(desc->model, desc->is_spectrum))
    report_.error(desc->where, "texture '" + texture->entity.type + "' is of \"" +
                                   (desc->is_spectrum ? "float" : "spectrum") + "\" only");
  scene_.textures.push_back(*std::move(desc));
}

// Textures use only textures before them, so that none can contain itself.
void Parser::check_texture_of_texture(const Stated& stated, TextureKind kind) {
  for (const Parameter& parameter : stated.entity.parameters.all()) {
    const auto* use = std::get_if<TextureName>(&parameter.values);
    const ParameterSpec* row = find_parameter(*stated.spec, parameter.name);
    if (!use || !row) continue;
    bool of_spectra = type_fits(*row, ParameterType::spectrum, kind);
    const auto& names = of_spectra ? spectrum_textures_ : number_textures_;
    if (names.contains(use->name)) continue;
    std::vector<std::string_view> known;
    for (const auto& [name, where] : names) known.push_back(name);
    std::string_view near = nearest_name(use->name, known);
    report_.error(parameter.where,
                  std::string("there is no texture of ") + (of_spectra ? "spectra" : "numbers") + " '" +
                      printable(use->name) + "' before this one",
                  near.empty() ? "" : "did you mean '" + std::string(near) + "'?");
  }
}

// No value after an error.
std::optional<MaterialDescId> Parser::add_material(const Stated& stated, const std::string& name) {
  note_texture_uses(stated);
  std::optional<MaterialDesc> material = read_model(material_models(), Family::material, stated.entity, report_);
  if (!material) return std::nullopt;
  material->name = name, material->where = stated.entity.where;
  if (std::holds_alternative<MixDesc>(material->model))
    if (const Parameter* materials = stated.entity.parameters.find("materials"))
      mixture_uses_.push_back({scene_.materials.size(), materials->where});
  scene_.materials.push_back(*std::move(material));
  return MaterialDescId(scene_.materials.size() - 1);
}

void Parser::directive_material() {
  Token type = lexer_->peek();
  if (type.kind == TokenKind::quoted && (type.text.empty() || type.text == "none")) {
    // Older files denote the absence of a material in this way.
    lexer_->next();
    parameters();
    if (!is_in_world(true)) return;
    report_.warning(here(), "a material '" + std::string(type.text) + "' is 'interface' in pbrt-v4");
    state_.material = static_cast<std::uint32_t>(scene_.materials.size());
    MaterialDesc& none = scene_.materials.emplace_back();
    none.model = InterfaceDesc{}, none.where = here();
    return;
  }
  auto material = stated_entity(Family::material);
  if (!is_in_world(true) || !material) return;
  if (const auto id = add_material(*material, "")) state_.material = static_cast<std::uint32_t>(*id);
}

void Parser::directive_make_named_material() {
  auto name = quoted_argument("a name");
  if (!name) return;
  ParameterList stated = parameters();
  if (!is_in_world(true)) return;
  const Parameter* type = stated.find("type");
  std::string type_name = stated.string("type", "");
  if (type_name.empty()) {
    named_materials_.try_emplace(*name, MaterialDescId{0});
    return report_.error(type ? type->where : here(), "MakeNamedMaterial needs \"string type\"");
  }
  ParameterList others;
  for (const Parameter& parameter : stated.all())
    if (parameter.name != "type") others.add(parameter);
  auto material = stated_entity(Family::material, type_name, type->where, others, std::nullopt);
  auto id = static_cast<MaterialDescId>(material ? scene_.materials.size() : 0);
  if (!named_materials_.try_emplace(*name, id).second)
    return report_.error(here(), "material '" + printable(*name) + "' is defined twice");
  if (material) add_material(*material, *name);
}

void Parser::directive_named_material() {
  SourceLocation where = lexer_->where(lexer_->peek());
  auto name = quoted_argument("the name of a material");
  if (!name || !is_in_world(true)) return;
  state_.material = named_material | static_cast<std::uint32_t>(material_uses_.size());
  material_uses_.push_back({std::move(*name), where});
}

void Parser::directive_light_source() {
  auto light = stated_entity(Family::light);
  if (!is_in_world(true) || !light) return;
  std::optional<LightDesc> desc = read_model(light_models(), Family::light, light->entity, report_);
  if (!desc) return;
  desc->where = light->entity.where, desc->light_to_world = still_transform("light");
  scene_.lights.push_back(*std::move(desc));
}

void Parser::directive_area_light_source() {
  auto light = stated_entity(Family::area_light);
  if (!is_in_world(true) || !light) return;
  state_.area_light = read_model(area_light_models(), Family::area_light, light->entity, report_);
  if (state_.area_light) state_.area_light->where = light->entity.where;
}

std::optional<MediumDescId> Parser::medium_named(const std::string& name, const SourceLocation& where) {
  if (name.empty()) return std::nullopt;
  const auto [medium, is_new] = media_.try_emplace(name, NamedMedium{MediumDescId(scene_.media.size()), where});
  if (is_new) scene_.media.push_back({name, {}});
  return medium->second.id;
}

void Parser::directive_make_named_medium() {
  auto name = quoted_argument("a name");
  if (!name) return;
  ParameterList stated = parameters();
  if (name->empty()) return report_.error(here(), "a medium needs a name that is not empty");
  const MediumDescId id = *medium_named(*name, here());
  NamedMedium& medium = media_.find(*name)->second;
  if (std::exchange(medium.is_defined, true))
    return report_.error(here(), "medium '" + printable(*name) + "' is defined twice");
  const Parameter* type = stated.find("type");
  const std::string type_name = stated.string("type", "");
  if (type_name.empty()) return report_.error(type ? type->where : here(), "MakeNamedMedium needs \"string type\"");
  ParameterList others;
  for (const Parameter& parameter : stated.all())
    if (parameter.name != "type") others.add(parameter);
  auto entity = stated_entity(Family::medium, type_name, type->where, others, std::nullopt);
  // What is left out is empty space.
  if (!entity) return;
  scene_.media[std::size_t(id)].model = read_model(medium_models(), Family::medium, entity->entity, report_);
  scene_.media[std::size_t(id)].where = entity->entity.where;
}

void Parser::directive_medium_interface() {
  SourceLocation where = lexer_->where(lexer_->peek());
  auto inside = quoted_argument("one or two names of media");
  if (!inside) return;
  // One name stands for both sides.
  std::string outside = *inside;
  SourceLocation outside_where = where;
  if (lexer_->peek().kind == TokenKind::quoted) {
    outside_where = lexer_->where(lexer_->peek());
    outside = unescape(lexer_->next().text);
  }
  state_.media = {medium_named(*inside, where), medium_named(outside, outside_where)};
}

}  // namespace montelux::pbrt
