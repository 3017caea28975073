// The state of reading a pbrt scene, with one function per directive.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/checks.h"
#include "io/pbrt/lexer.h"
#include "io/pbrt/parameters.h"
#include "io/pbrt/picture.h"
#include "io/reporter.h"
#include "scene/description.h"

namespace montelux::pbrt {

// The current transform at the start and at the end of the shutter interval.
struct MovingTransform {
  Transform start, end;
  bool moves() const { return !(start.matrix() == end.matrix()); }
};

// What AttributeBegin saves.
struct GraphicsState {
  MovingTransform transform;
  bool change_start = true, change_end = true;  // by ActiveTransform
  bool reverse_orientation = false;
  std::uint32_t material = 0;  // a number of a material, or `named_material` plus one of a name
  std::optional<AreaLightDesc> area_light;
  MediumSidesDesc media;
  std::string color_space = "srgb";
  std::map<Family, ParameterList> attributes;  // defaults stated by Attribute
};

// Marks a material that is stated by a name, which may be defined later.
inline constexpr std::uint32_t named_material = 0x80000000u;

class Parser {
 public:
  Parser(std::string folder, Diagnostics& diagnostics, bool lenient);
  const std::vector<Omission>& omissions() const { return report_.omissions(); }

  void parse_file(const std::string& path);
  void parse_text(std::string_view text, const std::string& file_name);
  // Ends the reading: unclosed blocks, undefined names. The scene is complete if no error was reported.
  SceneDesc finish();

  static bool knows(std::string_view directive) { return find_directive(directive) != nullptr; }
  static std::vector<std::string_view> directive_names();

 private:
  using Directive = void (Parser::*)();
  struct DirectiveRow;
  static std::span<const DirectiveRow> directive_rows();
  static const DirectiveRow* find_directive(std::string_view word);

  // A Begin without its End so far.
  struct OpenBlock {
    std::string_view begin;  // the directive
    SourceLocation where;
    GraphicsState state;
  };
  struct TextureUse {
    std::string name;
    SourceLocation where;
    bool takes_number, takes_spectrum;
  };
  struct NameUse {
    std::string name;
    SourceLocation where;
  };
  // An entity that was read, with its row; no value after an error that leaves nothing usable.
  struct Stated {
    Entity entity;
    const EntitySpec* spec;
  };

  // parser.cpp
  void parse_source(Lexer& lexer);
  void parse_directive();
  void resynchronise();
  void include_file(bool keep_state);
  void directive_include() { include_file(true); }
  void directive_import() { include_file(false); }
  void open_block(std::string_view begin);
  std::optional<OpenBlock> close_block(std::string_view begin, std::string_view end);
  std::optional<std::string> quoted_argument(std::string_view meaning);
  std::optional<std::string> word_argument(std::initializer_list<std::string_view> valid);
  bool numbers(std::span<double> values);
  bool is_in_world(bool wanted);

  // transforms.cpp
  void directive_identity();
  void directive_translate();
  void directive_scale();
  void directive_rotate();
  void directive_look_at();
  void directive_transform();
  void directive_concat_transform();
  void directive_coordinate_system();
  void directive_coord_sys_transform();
  void directive_active_transform();
  void directive_transform_times();
  void directive_transform_begin() { open_block("TransformBegin"); }
  void directive_transform_end();
  std::optional<Matrix4> matrix_argument();
  void set_transform(const Transform& transform, bool concatenate);
  Transform still_transform(std::string_view owner);
  std::vector<Transform> transform_at_end(std::string_view owner);

  // entities.cpp
  ParameterList parameters();
  std::optional<Stated> stated_entity(Family family);
  std::optional<Stated> stated_entity(Family family, const std::string& type, const SourceLocation& type_where,
                                      const ParameterList& stated, std::optional<TextureKind> kind);
  const EntitySpec* stand_in(Family family, const EntitySpec& spec, const SourceLocation& where);
  void note_texture_uses(const Stated& stated);
  void directive_camera();
  void directive_film() { stated_option(Family::film, picture_.film); }
  void directive_filter() { stated_option(Family::filter, picture_.filter); }
  void directive_sampler() { stated_option(Family::sampler, picture_.sampler); }
  void directive_integrator() { stated_option(Family::integrator, picture_.integrator); }
  void directive_accelerator() { stated_option(Family::accelerator, picture_.accelerator); }
  void stated_option(Family family, Entity& target);
  void directive_option();
  void directive_color_space();
  void directive_world_begin();
  void directive_world_end();
  void directive_attribute_begin();
  void directive_attribute_end();
  void directive_attribute();
  void directive_reverse_orientation();

  // surfaces.cpp
  void directive_texture();
  void directive_material();
  void directive_make_named_material();
  void directive_named_material();
  std::optional<MaterialDescId> add_material(const Stated& stated, const std::string& name);
  void directive_light_source();
  void directive_area_light_source();
  void directive_make_named_medium();
  void directive_medium_interface();
  std::optional<MediumDescId> medium_named(const std::string& name, const SourceLocation& where);
  void check_texture_of_texture(const Stated& stated, TextureKind kind);

  // shapes.cpp
  void directive_shape();
  void directive_object_begin();
  void directive_object_end();
  void directive_object_instance();
  std::optional<ShapeDesc> shape_of(Entity stated);
  std::shared_ptr<const Mesh> mesh_stated_by(Entity& shape);
  std::shared_ptr<const Mesh> ply_mesh(const Entity& shape);
  std::shared_ptr<const Mesh> one_ply_mesh(const std::string& file, const SourceLocation& where);
  std::shared_ptr<const Mesh> posed_ply_mesh(const Mesh& first, const Parameter& later);

  // resolve.cpp
  void resolve_textures();
  void resolve_materials();
  void resolve_instances();
  void resolve_media();
  std::vector<std::string_view> material_names() const;

  SourceLocation here() const { return lexer_->where(directive_); }

  Reporter report_;
  SceneDesc scene_;
  StatedPicture picture_;
  GraphicsState state_;
  std::vector<OpenBlock> blocks_;
  Lexer* lexer_ = nullptr;
  Token directive_;  // the current one
  bool in_world_ = false;
  bool warned_of_world_ = false;
  std::vector<std::filesystem::path> open_files_;
  int files_read_ = 0;
  std::set<Family> options_stated_;

  std::map<std::string, MovingTransform> coordinate_systems_;
  std::map<std::string, SourceLocation> number_textures_, spectrum_textures_;
  std::vector<TextureUse> texture_uses_;
  std::map<std::string, MaterialDescId> named_materials_;
  std::vector<NameUse> material_uses_;
  // Where a mixture states its materials.
  struct MixtureUse {
    std::size_t mixture;  // its number
    SourceLocation where;
  };
  std::vector<MixtureUse> mixture_uses_;
  // Media get their numbers where they are first named, which may be before they are defined.
  struct NamedMedium {
    MediumDescId id;
    SourceLocation first_use;
    bool is_defined = false;
  };
  std::map<std::string, NamedMedium> media_;
  std::map<std::string, ObjectDescId> object_ids_;
  std::optional<ObjectDescId> open_object_;
  std::vector<NameUse> instance_uses_;  // one per instance
  std::map<std::string, std::shared_ptr<const Mesh>> meshes_;
};

}  // namespace montelux::pbrt
