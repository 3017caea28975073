// Entities in general, and the directives that state how to render the image.
#include "io/pbrt/parser.h"
#include "io/text_file.h"

namespace montelux::pbrt {

ParameterList Parser::parameters() { return read_parameters({*lexer_, report_, scene_.folder, state_.color_space}); }

// The substitute for an entity; null if it requires lenient reading and reading is not lenient.
const EntitySpec* Parser::stand_in(Family family, const EntitySpec& spec, const SourceLocation& where) {
  std::string name = std::string(name_of(family)) + " '" + std::string(spec.name) + "'";
  std::string instead(spec.instead);
  if (spec.later) {
    report_.tolerable(where, name + " is not supported yet",
                      instead.empty() ? "" : "lenient reading uses '" + instead + "' instead");
    return report_.lenient() && !instead.empty() ? find_entity(table_of(family), instead) : nullptr;
  }
  bool says_so = family == Family::integrator || family == Family::film;
  if (says_so && !instead.empty() && !spec.same) report_.note(where, name + " is replaced by '" + instead + "'");
  return &spec;
}

std::optional<Parser::Stated> Parser::stated_entity(Family family) {
  if (lexer_->peek().kind != TokenKind::quoted) {
    quoted_argument("the name of a " + std::string(name_of(family)));
    return std::nullopt;
  }
  Token type = lexer_->next();
  SourceLocation where = lexer_->where(type);
  ParameterList stated = parameters();
  return stated_entity(family, unescape(type.text), where, stated, std::nullopt);
}

std::optional<Parser::Stated> Parser::stated_entity(Family family, const std::string& type,
                                                    const SourceLocation& type_where, const ParameterList& stated,
                                                    std::optional<TextureKind> kind) {
  const EntitySpec* named = find_entity(table_of(family), type);
  if (!named) {
    report_unknown_name(family, type, type_where, report_);
    return std::nullopt;
  }
  const EntitySpec* spec = stand_in(family, *named, type_where);
  if (!spec && named->parameters.empty()) return std::nullopt;  // the table does not know its parameters yet
  ParameterList all = stated;
  // Defaults set by Attribute, if the entity accepts them and does not state them.
  auto defaults = state_.attributes.find(family);
  if (defaults != state_.attributes.end())
    for (const Parameter& parameter : defaults->second.all())
      if (find_parameter(*named, parameter.name) && !stated.find(parameter.name)) all.add(parameter);
  CheckContext context{report_, scene_.folder, spelling, kind};
  Entity entity{type, checked_parameters(family, *named, all, context), here()};
  if (!spec) return std::nullopt;
  if (spec != named) {
    // A substitute keeps the parameters that it knows; the substitution has been reported.
    Entity other{std::string(spec->name), {}, here()};
    for (const Parameter& parameter : entity.parameters.all()) {
      const ParameterSpec* row = find_parameter(*spec, parameter.name);
      if (row && type_fits(*row, parameter.type, kind)) other.parameters.add(parameter);
    }
    entity = std::move(other);
  }
  check_entity(family, entity, context);
  expect_uses(entity.parameters, *spec);
  return Stated{std::move(entity), spec};
}

// Names of textures are resolved at the end: they may be defined later.
void Parser::note_texture_uses(const Stated& stated) {
  for (const Parameter& parameter : stated.entity.parameters.all()) {
    const auto* use = std::get_if<TextureName>(&parameter.values);
    const ParameterSpec* row = find_parameter(*stated.spec, parameter.name);
    if (!use || !row) continue;
    texture_uses_.push_back({use->name, parameter.where, type_fits(*row, ParameterType::number, std::nullopt),
                             type_fits(*row, ParameterType::spectrum, std::nullopt)});
  }
}

void Parser::stated_option(Family family, Entity& target) {
  auto stated = stated_entity(family);
  if (!is_in_world(false) || !stated) return;
  if (!options_stated_.insert(family).second)
    report_.warning(here(), "a second " + std::string(directive_.text) + " replaces the first");
  target = std::move(stated->entity);
}

void Parser::directive_camera() {
  bool outside = !in_world_;
  stated_option(Family::camera, picture_.camera);
  if (!outside) return;
  scene_.world_to_camera = state_.transform.start;
  scene_.camera_medium = state_.media.outside;
  scene_.world_to_camera_later = transform_at_end("camera");
  coordinate_systems_["camera"] = {state_.transform.start.inverted(), state_.transform.end.inverted()};
}

void Parser::directive_option() {
  ParameterList stated = parameters();
  if (!is_in_world(false)) return;
  if (stated.all().empty()) return report_.error(here(), "Option takes a parameter, such as \"integer seed\" 1");
  CheckContext context{report_, scene_.folder, spelling};
  ParameterList good = checked_parameters(Family::option, table_of(Family::option)[0], stated, context);
  expect_uses(good, table_of(Family::option)[0]);
  for (const Parameter& p : good.all()) picture_.options.add(p);
}

void Parser::directive_color_space() {
  Token name = lexer_->peek();
  auto space = quoted_argument("the name of a colour space");
  if (!space) return;
  std::vector<std::string_view> valid{"srgb", "dci-p3", "rec2020", "aces2065-1"};
  for (std::string_view v : valid)
    if (v == *space) {
      state_.color_space = *space;
      return;
    }
  report_.error(lexer_->where(name), "there is no colour space '" + printable(*space) + "'",
                "valid: srgb, dci-p3, rec2020, aces2065-1");
}

void Parser::directive_world_begin() {
  if (in_world_) return report_.error(here(), "a second WorldBegin");
  in_world_ = true;
  state_.transform = {};
  state_.change_start = state_.change_end = true;
  coordinate_systems_["world"] = {};
}

void Parser::directive_world_end() {
  report_.tolerable(here(), "WorldEnd is not a directive of pbrt-v4", "remove it: the world ends with the file");
}

void Parser::directive_attribute_begin() {
  if (is_in_world(true)) open_block("AttributeBegin");
}

void Parser::directive_attribute_end() {
  if (!is_in_world(true)) return;
  // An End that closes an object would leave its shapes without owner; the object stays open for its own End.
  if (!blocks_.empty() && blocks_.back().begin == "ObjectBegin")
    return report_.error(here(), "AttributeEnd without AttributeBegin inside ObjectBegin");
  if (auto block = close_block("AttributeBegin", "AttributeEnd")) state_ = std::move(block->state);
}

void Parser::directive_attribute() {
  struct Target {
    std::string_view name;
    Family family;
  };
  constexpr std::array<Target, 5> targets{{{"shape", Family::shape},
                                           {"light", Family::light},
                                           {"material", Family::material},
                                           {"medium", Family::medium},
                                           {"texture", Family::texture}}};
  Token name = lexer_->peek();
  auto target = quoted_argument("shape, light, material, medium or texture");
  if (!target) return;
  ParameterList stated = parameters();
  for (const Target& t : targets) {
    if (t.name != *target) continue;
    ParameterList& defaults = state_.attributes[t.family];
    for (const Parameter& parameter : stated.all()) {
      bool known = false;
      for (const EntitySpec& spec : table_of(t.family)) known |= find_parameter(spec, parameter.name) != nullptr;
      if (known)
        defaults.add(parameter);
      else
        report_.tolerable(parameter.where, "no " + *target + " has a parameter '" + printable(parameter.name) + "'");
    }
    return;
  }
  report_.error(lexer_->where(name),
                "Attribute takes shape, light, material, medium or texture; found '" + printable(*target) + "'");
}

void Parser::directive_reverse_orientation() {
  if (is_in_world(true)) state_.reverse_orientation = !state_.reverse_orientation;
}

}  // namespace montelux::pbrt
