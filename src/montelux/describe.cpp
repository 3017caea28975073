#include "montelux/describe.h"

#include <algorithm>
#include <cmath>

#include "io/mesh_check.h"
#include "io/pbrt/meshes.h"
#include "io/pbrt/picture.h"
#include "io/ply.h"
#include "io/read_model.h"
#include "io/text_file.h"
#include "light/table.h"
#include "material/table.h"
#include "medium/table.h"
#include "montelux/parameters.h"
#include "scene/shape_models.h"
#include "texture/table.h"

namespace montelux::api {

namespace {

SourceLocation part(std::string name) { return {std::make_shared<const std::string>(std::move(name)), 0, 0}; }

class Description {
 public:
  explicit Description(const Scene::Content& content)
      : content_(content),
        folder_(content.folder.string()),
        report_(diagnostics_, false),
        reader_(content, folder_, report_) {}

  ReadResult make();

 private:
  std::optional<Entity> entity(Family family, const Model& model, const SourceLocation& where,
                               std::optional<montelux::TextureKind> kind = {});
  void take(Family family, const std::optional<Model>& model, Entity& target);
  std::optional<montelux::Transform> transform(const Transform& t, const SourceLocation& where);
  void add_shape(const Shape& shape, const SourceLocation& where);
  std::optional<MediumDescId> medium(std::optional<MediumId> id, const SourceLocation& where);
  bool set_shape(const Entity& stated, ShapeDesc& desc);
  bool set_form(const Model& model, ShapeDesc& desc, const SourceLocation& where);
  bool set_form(const Mesh& mesh, ShapeDesc& desc, const SourceLocation& where);
  std::optional<montelux::Mesh> checked_mesh(const Mesh& mesh, const SourceLocation& where);

  const Scene::Content& content_;
  std::string folder_;
  Diagnostics diagnostics_;
  Reporter report_;
  ParameterReader reader_;
  SceneDesc desc_;
};

// The entity with those of its parameters that are right. No value where there is no such thing.
std::optional<Entity> Description::entity(Family family, const Model& model, const SourceLocation& where,
                                          std::optional<montelux::TextureKind> kind) {
  const EntitySpec* spec = find_entity(table_of(family), model.name);
  if (!spec) {
    report_unknown_name(family, model.name, where, report_);
    return std::nullopt;
  }
  if (spec->later) {
    report_.error(where, std::string(name_of(family)) + " '" + model.name + "' is not supported yet");
    return std::nullopt;
  }
  const CheckContext context{report_, folder_, name_of_type, kind};
  Entity entity{model.name,
                checked_parameters(family, *spec, reader_.read(model.parameters, *spec, where, kind), context), where};
  check_entity(family, entity, context);
  expect_uses(entity.parameters, *spec);
  return entity;
}

void Description::take(Family family, const std::optional<Model>& model, Entity& target) {
  if (!model) return;
  if (auto stated = entity(family, *model, part(std::string(name_of(family))))) target = *std::move(stated);
}

// An affine map with an inverse.
std::optional<montelux::Transform> Description::transform(const Transform& t, const SourceLocation& where) {
  Matrix4 matrix;
  for (std::size_t i = 0; i < 16; ++i) matrix.m[i / 4][i % 4] = t.m[i];
  const bool is_affine = t.m[12] == 0 && t.m[13] == 0 && t.m[14] == 0 && t.m[15] == 1;
  std::optional<montelux::Transform> invertible = is_affine ? from_matrix(matrix) : std::nullopt;
  if (!invertible) report_.error(where, "the transform is not an affine map with an inverse");
  return invertible;
}

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::optional<montelux::Mesh> Description::checked_mesh(const Mesh& mesh, const SourceLocation& where) {
  const std::size_t vertices = mesh.positions.size();
  const auto complain = [&](std::string message) {
    report_.error(where, std::move(message));
    return std::nullopt;
  };
  const auto one_each = [&](std::size_t count) { return count == 0 || count == vertices; };
  if (!one_each(mesh.normals.size()) || !one_each(mesh.uvs.size()))
    return complain("a mesh has one normal and one uv for each vertex, or none; there are " + std::to_string(vertices) +
                    " positions, " + std::to_string(mesh.normals.size()) + " normals and " +
                    std::to_string(mesh.uvs.size()) + " uvs");
  if (mesh.triangles.size() % 3 != 0 || mesh.quads.size() % 4 != 0)
    return complain("a mesh takes three indices a triangle and four a quad; there are " +
                    std::to_string(mesh.triangles.size()) + " and " + std::to_string(mesh.quads.size()));
  for (const auto* indices : {&mesh.triangles, &mesh.quads})
    for (std::uint32_t index : *indices)
      if (index >= vertices)
        return complain("index " + std::to_string(index) + " has no vertex: there are " + std::to_string(vertices));
  const bool good_uvs = std::ranges::all_of(mesh.uvs, [](Vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); });
  if (!std::ranges::all_of(mesh.positions, is_finite) || !std::ranges::all_of(mesh.normals, is_finite) || !good_uvs)
    return complain("a vertex has coordinates that are not finite");
  montelux::Mesh result;
  for (Vec3 v : mesh.positions) result.positions.push_back({v.x, v.y, v.z});
  for (Vec3 v : mesh.normals) result.normals.push_back({v.x, v.y, v.z});
  for (Vec2 v : mesh.uvs) result.uvs.push_back({v.x, v.y});
  result.triangles = mesh.triangles, result.quads = mesh.quads;
  if (std::size_t dropped = drop_degenerate_faces(result).total())
    report_.add(dropped_faces_warning(dropped, "", where));
  return result;
}

// What the entity states of a shape besides its mesh.
bool Description::set_shape(const Entity& stated, ShapeDesc& desc) {
  std::optional<ShapeDesc> read = read_model(shape_models(), Family::shape, stated, report_);
  if (!read) return false;
  desc = *std::move(read);
  desc.where = stated.where;
  return true;
}

bool Description::set_form(const Mesh& mesh, ShapeDesc& desc, const SourceLocation& where) {
  auto stated = entity(Family::shape, {"trianglemesh", mesh.parameters}, where);
  for (const char* array : {"P", "N", "S", "uv", "indices", "P1", "N1"})
    if (stated && stated->parameters.find(array))
      report_.error(where, "'" + std::string(array) + "' of a mesh is one of its own arrays, and no parameter");
  auto checked = checked_mesh(mesh, where);
  if (!stated || !checked) return false;
  expect_uses(stated->parameters, *find_entity(table_of(Family::shape), "trianglemesh"));
  if (!set_shape(*stated, desc)) return false;
  const bool has_faces = !checked->triangles.empty() || !checked->quads.empty();
  set_mesh(desc, std::make_shared<const montelux::Mesh>(*std::move(checked)));
  return has_faces;
}

bool Description::set_form(const Model& model, ShapeDesc& desc, const SourceLocation& where) {
  auto stated = entity(Family::shape, model, where);
  if (!stated) return false;
  std::optional<montelux::Mesh> mesh;
  if (is_mesh(model.name) && model.name != "plymesh") {
    mesh = pbrt::take_mesh(*stated, report_);
    if (!mesh) return false;
  }
  if (!set_shape(*stated, desc)) return false;
  if (!is_mesh(model.name)) return true;
  if (const auto* form = std::get_if<MeshForm>(&desc.form); form && !form->later_files.empty()) {
    report_.error(where, "'filename1' is read from scene files only");
  } else if (form && !form->file.empty()) {
    const std::string path = resolve_path(folder_, form->file);
    if (is_regular_file(path)) mesh = read_ply(path, where, diagnostics_);
  }
  if (!mesh) return false;
  const bool has_faces = !mesh->triangles.empty() || !mesh->quads.empty();
  set_mesh(desc, std::make_shared<const montelux::Mesh>(*std::move(mesh)));
  return has_faces;
}

std::optional<MediumDescId> Description::medium(std::optional<MediumId> id, const SourceLocation& where) {
  if (!id) return std::nullopt;
  if (std::size_t(*id) >= content_.media.size()) {
    report_.error(where, "the medium is none of this scene");
    return std::nullopt;
  }
  return MediumDescId(std::uint32_t(*id));
}

void Description::add_shape(const Shape& shape, const SourceLocation& where) {
  const Surface& surface = shape.surface;
  ShapeDesc desc{};
  bool good = std::visit([&](const auto& form) { return set_form(form, desc, where); }, shape.form);
  const auto place = transform(surface.object_to_world, where);
  if (place) desc.object_to_world = *place;
  desc.reverse_orientation = surface.reverse_orientation;
  if (surface.material && std::size_t(*surface.material) >= content_.materials.size())
    report_.error(where, "the material is none of this scene"), good = false;
  // Number 0 of a description is the default material.
  if (surface.material) desc.material = MaterialDescId(std::uint32_t(*surface.material) + 1);
  if (surface.area_light)
    if (const auto stated = entity(Family::area_light, *surface.area_light, where)) {
      desc.area_light = read_model(area_light_models(), Family::area_light, *stated, report_);
      if (desc.area_light) desc.area_light->where = where;
    }
  desc.media = {medium(surface.media.inside, where), medium(surface.media.outside, where)};
  if (!surface.object) {
    if (good && place) desc_.shapes.push_back(std::move(desc));
    return;
  }
  if (surface.area_light) report_.error(where, "a part of an object cannot emit light");
  if (std::size_t(*surface.object) >= desc_.objects.size())
    report_.error(where, "the object is none of this scene");
  else if (good && place)
    desc_.objects[std::size_t(*surface.object)].shapes.push_back(std::move(desc));
}

ReadResult Description::make() {
  desc_.file = "the scene", desc_.folder = folder_;
  pbrt::StatedPicture picture;
  take(Family::film, content_.film, picture.film);
  take(Family::camera, content_.camera.model, picture.camera);
  take(Family::filter, content_.filter, picture.filter);
  take(Family::sampler, content_.sampler, picture.sampler);
  take(Family::integrator, content_.integrator, picture.integrator);
  pbrt::describe_picture(picture, desc_, report_);
  if (const auto t = transform(content_.camera.transform, part("camera"))) desc_.world_to_camera = t->inverted();

  for (std::size_t i = 0; i < content_.textures.size(); ++i) {
    const auto& [kind, placed] = content_.textures[i];
    const bool is_spectrum = kind == TextureKind::color;
    const SourceLocation where = part(name_of_texture(i));
    auto stated = entity(Family::texture, placed.model, where,
                         is_spectrum ? montelux::TextureKind::spectrum : montelux::TextureKind::number);
    const auto t = transform(placed.transform, where);
    std::optional<TextureDesc> desc =
        stated ? read_model(texture_models(), Family::texture, *stated, report_) : std::nullopt;
    if (!desc || !t) continue;
    desc->name = name_of_texture(i), desc->is_spectrum = is_spectrum, desc->texture_to_world = *t, desc->where = where;
    desc_.textures.push_back(*std::move(desc));
  }
  desc_.materials.emplace_back();
  for (std::size_t i = 0; i < content_.materials.size(); ++i) {
    const SourceLocation where = part(name_of_material(i));
    std::optional<MaterialDesc> material;
    if (const auto stated = entity(Family::material, content_.materials[i], where))
      material = read_model(material_models(), Family::material, *stated, report_);
    MaterialDesc& desc = desc_.materials.emplace_back(std::move(material).value_or(MaterialDesc{}));
    desc.name = name_of_material(i), desc.where = where;
  }
  for (std::size_t i = 0; i < content_.media.size(); ++i) {
    const std::string name = "medium " + std::to_string(i);
    auto stated = entity(Family::medium, content_.media[i], part(name));
    desc_.media.push_back(
        {name, stated ? read_model(medium_models(), Family::medium, *stated, report_) : std::nullopt, {}});
  }
  desc_.camera_medium = medium(content_.camera_medium, part("camera"));
  for (std::size_t i = 0; i < content_.lights.size(); ++i) {
    const SourceLocation where = part("light " + std::to_string(i));
    auto stated = entity(Family::light, content_.lights[i].model, where);
    const auto t = transform(content_.lights[i].transform, where);
    std::optional<LightDesc> light =
        stated ? read_model(light_models(), Family::light, *stated, report_) : std::nullopt;
    if (!light || !t) continue;
    light->where = where, light->light_to_world = *t;
    desc_.lights.push_back(*std::move(light));
  }
  for (std::uint32_t i = 0; i < content_.objects; ++i) desc_.objects.push_back({"object " + std::to_string(i), {}});
  for (std::size_t i = 0; i < content_.shapes.size(); ++i)
    add_shape(content_.shapes[i], part("shape " + std::to_string(i)));
  for (std::size_t i = 0; i < content_.instances.size(); ++i) {
    const SourceLocation where = part("instance " + std::to_string(i));
    const auto t = transform(content_.instances[i].object_to_world, where);
    const auto object = std::uint32_t(content_.instances[i].object);
    if (object >= content_.objects)
      report_.error(where, "the object is none of this scene");
    else if (t)
      desc_.instances.push_back({ObjectDescId(object), *t, where, {}});
  }
  report_.finish();
  ReadResult result;
  if (!diagnostics_.has_errors()) result.scene = std::move(desc_);
  result.diagnostics = std::move(diagnostics_);
  return result;
}

}  // namespace

ReadResult describe(const Scene::Content& content) { return Description(content).make(); }

}  // namespace montelux::api
