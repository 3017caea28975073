#include "io/pbrt/parser.h"

#include <algorithm>
#include <utility>

#include "io/numbers.h"
#include "io/text_file.h"

namespace montelux::pbrt {

struct Parser::DirectiveRow {
  std::string_view name;
  Directive action;
};

std::span<const Parser::DirectiveRow> Parser::directive_rows() {
  static constexpr std::array<DirectiveRow, 41> rows{{{"AttributeBegin", &Parser::directive_attribute_begin},
                                                      {"AttributeEnd", &Parser::directive_attribute_end},
                                                      {"Translate", &Parser::directive_translate},
                                                      {"Rotate", &Parser::directive_rotate},
                                                      {"Scale", &Parser::directive_scale},
                                                      {"Shape", &Parser::directive_shape},
                                                      {"ObjectInstance", &Parser::directive_object_instance},
                                                      {"NamedMaterial", &Parser::directive_named_material},
                                                      {"Transform", &Parser::directive_transform},
                                                      {"ConcatTransform", &Parser::directive_concat_transform},
                                                      {"AreaLightSource", &Parser::directive_area_light_source},
                                                      {"Material", &Parser::directive_material},
                                                      {"MakeNamedMaterial", &Parser::directive_make_named_material},
                                                      {"Texture", &Parser::directive_texture},
                                                      {"LightSource", &Parser::directive_light_source},
                                                      {"ReverseOrientation", &Parser::directive_reverse_orientation},
                                                      {"TransformBegin", &Parser::directive_transform_begin},
                                                      {"TransformEnd", &Parser::directive_transform_end},
                                                      {"ObjectBegin", &Parser::directive_object_begin},
                                                      {"ObjectEnd", &Parser::directive_object_end},
                                                      {"Include", &Parser::directive_include},
                                                      {"Import", &Parser::directive_import},
                                                      {"Identity", &Parser::directive_identity},
                                                      {"LookAt", &Parser::directive_look_at},
                                                      {"CoordinateSystem", &Parser::directive_coordinate_system},
                                                      {"CoordSysTransform", &Parser::directive_coord_sys_transform},
                                                      {"ActiveTransform", &Parser::directive_active_transform},
                                                      {"TransformTimes", &Parser::directive_transform_times},
                                                      {"Attribute", &Parser::directive_attribute},
                                                      {"WorldBegin", &Parser::directive_world_begin},
                                                      {"WorldEnd", &Parser::directive_world_end},
                                                      {"Camera", &Parser::directive_camera},
                                                      {"Film", &Parser::directive_film},
                                                      {"PixelFilter", &Parser::directive_filter},
                                                      {"Sampler", &Parser::directive_sampler},
                                                      {"Integrator", &Parser::directive_integrator},
                                                      {"Accelerator", &Parser::directive_accelerator},
                                                      {"ColorSpace", &Parser::directive_color_space},
                                                      {"Option", &Parser::directive_option},
                                                      {"MakeNamedMedium", &Parser::directive_make_named_medium},
                                                      {"MediumInterface", &Parser::directive_medium_interface}}};
  return rows;
}

const Parser::DirectiveRow* Parser::find_directive(std::string_view word) {
  for (const DirectiveRow& row : directive_rows())
    if (row.name == word) return &row;
  return nullptr;
}

std::vector<std::string_view> Parser::directive_names() {
  std::vector<std::string_view> names;
  for (const DirectiveRow& row : directive_rows()) names.push_back(row.name);
  return names;
}

bool is_directive(std::string_view word) { return Parser::knows(word); }

Parser::Parser(std::string folder, Diagnostics& diagnostics, bool lenient) : report_(diagnostics, lenient) {
  scene_.folder = std::move(folder);
  scene_.materials.emplace_back();
}

// The format of a file that is not pbrt's, recognised by its beginning.
static std::string_view other_format(std::string_view text) {
  if (text.starts_with("glTF")) return "binary glTF";
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (text.starts_with("{")) return "JSON, as glTF is";
  if (text.starts_with("<")) return "XML, as Mitsuba's scenes are";
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return "a ply mesh";
  return {};
}

void Parser::parse_file(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int max_files = 20000;
  constexpr std::size_t max_depth = 200;
  SourceLocation where = lexer_ ? here() : SourceLocation{std::make_shared<const std::string>(path), 0, 0};
  std::error_code problem;
  fs::path canonical = fs::canonical(path, problem);
  if (problem) return report_.error(where, "there is no file '" + printable(path) + "'");
  for (const fs::path& open : open_files_)
    if (open == canonical) return report_.error(where, "'" + printable(path) + "' includes itself");
  if (open_files_.size() >= max_depth || ++files_read_ > max_files)
    return report_.error(where, "includes are nested too deeply; '" + printable(path) + "' is omitted");
  auto bytes = read_whole_file(path);
  if (!bytes) return report_.error(where, bytes.error());
  const std::string_view text = without_byte_order_mark(*bytes);
  if (const std::string_view other = other_format(text); !other.empty())
    return report_.error(where, "'" + printable(path) + "' is " + std::string(other),
                         "scenes are read from pbrt-v4 files");
  open_files_.push_back(std::move(canonical));
  parse_text(text, path);
  open_files_.pop_back();
}

void Parser::parse_text(std::string_view text, const std::string& file_name) {
  if (scene_.file.empty()) scene_.file = file_name;
  Lexer lexer(without_byte_order_mark(text), std::make_shared<const std::string>(file_name));
  Lexer* outer = lexer_;
  Token outer_directive = directive_;
  parse_source(lexer);
  lexer_ = outer;
  directive_ = outer_directive;
}

void Parser::parse_source(Lexer& lexer) {
  lexer_ = &lexer;
  while (lexer.peek().kind != TokenKind::end) {
    parse_directive();
    lexer_ = &lexer;
  }
}

void Parser::parse_directive() {
  directive_ = lexer_->next();
  if (directive_.kind == TokenKind::word)
    if (const DirectiveRow* row = find_directive(directive_.text)) return (this->*row->action)();
  if (directive_.kind == TokenKind::word) {
    std::string_view near = nearest_name(directive_.text, directive_names());
    report_.error(here(), "there is no directive " + describe(directive_),
                  near.empty() ? "examples of directives: Shape, Material, Translate"
                               : "did you mean " + std::string(near) + "?");
  } else if (directive_.kind == TokenKind::unclosed_quote) {
    report_.error(here(), "a quoted string has no end on its line");
  } else {
    report_.error(here(), "a directive is expected here; found " + describe(directive_));
  }
  resynchronise();
}

// Skips to the next directive, or to a word at the start of a line that looks as if it should be one.
void Parser::resynchronise() {
  int line = std::max(directive_.line, lexer_->peek().line);
  while (true) {
    const Token& token = lexer_->peek();
    if (token.kind == TokenKind::end || (token.kind == TokenKind::word && is_directive(token.text))) return;
    bool capital = token.kind == TokenKind::word && token.text.front() >= 'A' && token.text.front() <= 'Z';
    if (capital && token.line > line) return;
    line = token.line;
    lexer_->next();
  }
}

void Parser::include_file(bool keep_state) {
  auto name = quoted_argument("the name of a file");
  if (!name) return;
  if (!keep_state && !is_in_world(true)) return;
  std::string path = resolve_path(scene_.folder, *name);
  if (keep_state) return parse_file(path);
  // An imported file does not change the graphics state.
  GraphicsState saved = state_;
  std::size_t depth = blocks_.size();
  parse_file(path);
  while (blocks_.size() > depth) {
    report_.error(blocks_.back().where, std::string(blocks_.back().begin) + " has no end in the imported file");
    blocks_.pop_back();
  }
  state_ = std::move(saved);
}

void Parser::open_block(std::string_view begin) {
  constexpr std::size_t max_depth = 10000;
  if (blocks_.size() == max_depth) report_.error(here(), "blocks are nested more than 10000 deep");
  if (blocks_.size() >= max_depth) return;
  blocks_.push_back({begin, here(), state_});
}

std::optional<Parser::OpenBlock> Parser::close_block(std::string_view begin, std::string_view end) {
  if (blocks_.empty()) {
    report_.error(here(), std::string(end) + " without " + std::string(begin));
    return std::nullopt;
  }
  OpenBlock block = std::move(blocks_.back());
  blocks_.pop_back();
  if (block.begin != begin)
    report_.error(here(), std::string(end) + " closes " + std::string(block.begin) + " of line " +
                              std::to_string(block.where.line));
  return block;
}

std::optional<std::string> Parser::quoted_argument(std::string_view meaning) {
  if (lexer_->peek().kind == TokenKind::quoted) return unescape(lexer_->next().text);
  report_.error(lexer_->where(lexer_->peek()), std::string(directive_.text) + " takes " + std::string(meaning) +
                                                   " in quotes; found " + describe(lexer_->peek()));
  resynchronise();
  return std::nullopt;
}

std::optional<std::string> Parser::word_argument(std::initializer_list<std::string_view> valid) {
  const Token& token = lexer_->peek();
  for (std::string_view word : valid)
    if (token.kind == TokenKind::word && token.text == word) return std::string(lexer_->next().text);
  std::string list;
  for (std::string_view word : valid) list += (list.empty() ? "" : ", ") + std::string(word);
  report_.error(lexer_->where(token),
                std::string(directive_.text) + " takes one of " + list + "; found " + describe(token));
  resynchronise();
  return std::nullopt;
}

// Reads `values`, which may be in brackets.
bool Parser::numbers(std::span<double> values) {
  bool bracketed = lexer_->peek().kind == TokenKind::open;
  if (bracketed) lexer_->next();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Token& token = lexer_->peek();
    auto value = token.kind == TokenKind::number ? to_double(token.text) : std::nullopt;
    if (!value) {
      report_.error(lexer_->where(token), std::string(directive_.text) + " takes " + std::to_string(values.size()) +
                                              " finite numbers; found " + describe(token) + " as number " +
                                              std::to_string(i + 1));
      resynchronise();
      return false;
    }
    values[i] = *value;
    lexer_->next();
  }
  if (!bracketed) return true;
  if (lexer_->peek().kind == TokenKind::close) {
    lexer_->next();
    return true;
  }
  report_.error(lexer_->where(lexer_->peek()), "']' is expected after " + std::to_string(values.size()) +
                                                   " numbers; found " + describe(lexer_->peek()));
  resynchronise();
  return false;
}

// Whether the directive is on its side of WorldBegin. Only the first one that is not is reported: the others follow
// from it.
bool Parser::is_in_world(bool wanted) {
  if (in_world_ == wanted) return true;
  if (!std::exchange(warned_of_world_, true))
    report_.error(here(), std::string(directive_.text) + " must stand " + (wanted ? "after" : "before") + " WorldBegin",
                  "further misplaced directives are not reported");
  return false;
}

SceneDesc Parser::finish() {
  SourceLocation whole{std::make_shared<const std::string>(scene_.file), 0, 0};
  for (const OpenBlock& block : blocks_) report_.error(block.where, std::string(block.begin) + " has no end");
  if (!in_world_ && report_.errors() == 0) report_.error(whole, "the scene has no WorldBegin");
  resolve_textures();
  resolve_materials();
  resolve_instances();
  resolve_media();
  describe_picture(picture_, scene_, report_);
  report_.finish();
  return std::move(scene_);
}

}  // namespace montelux::pbrt
