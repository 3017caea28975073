// Shapes, and objects made of them.
#include "io/pbrt/meshes.h"
#include "io/pbrt/parser.h"
#include "io/ply.h"
#include "io/read_model.h"
#include "io/text_file.h"
#include "scene/shape_models.h"

namespace montelux::pbrt {

namespace {

// Quadrilaterals as two triangles each.
void split_quads(Mesh& mesh) {
  for (std::size_t i = 0; i + 3 < mesh.quads.size(); i += 4) {
    const std::uint32_t *q = &mesh.quads[i], halves[] = {q[0], q[1], q[3], q[0], q[3], q[2]};
    mesh.triangles.insert(mesh.triangles.end(), std::begin(halves), std::end(halves));
  }
  mesh.quads.clear();
}

}  // namespace

// The mesh of a file, which is read once, however often it is placed.
std::shared_ptr<const Mesh> Parser::one_ply_mesh(const std::string& file, const SourceLocation& where) {
  std::string path = resolve_path(scene_.folder, file);
  if (!is_regular_file(path)) return nullptr;  // reported with the other files
  auto [entry, is_new] = meshes_.try_emplace(path);
  if (!is_new) return entry->second;
  Diagnostics found;
  auto mesh = read_ply(path, where, found);
  for (const Diagnostic& diagnostic : found.all()) report_.add(diagnostic);
  if (mesh) entry->second = std::make_shared<const Mesh>(std::move(*mesh));
  return entry->second;
}

// The faces of the first file with the vertices of the others at later times.
std::shared_ptr<const Mesh> Parser::posed_ply_mesh(const Mesh& first, const Parameter& later) {
  auto mesh = std::make_shared<Mesh>(first);
  if (!mesh->quads.empty())
    report_.note(later.where, "the quadrilaterals of a deforming mesh are split into triangles");
  split_quads(*mesh);
  const auto& files = std::get<std::vector<std::string>>(later.values);
  constexpr std::size_t max_poses = 128;
  if (files.size() > max_poses) {
    report_.error(later.where, "'filename1' takes at most " + std::to_string(max_poses) + " files");
    return nullptr;
  }
  for (const std::string& file : files) {
    const std::shared_ptr<const Mesh> pose = one_ply_mesh(file, later.where);
    if (!pose) return nullptr;
    if (pose->positions.size() != first.positions.size() || pose->normals.size() != first.normals.size()) {
      report_.error(later.where, "'" + printable(file) + "' has " + std::to_string(pose->positions.size()) +
                                     " vertices and " + std::to_string(pose->normals.size()) +
                                     " normals; the first file has " + std::to_string(first.positions.size()) +
                                     " and " + std::to_string(first.normals.size()));
      return nullptr;
    }
    mesh->later.push_back({pose->positions, pose->normals});
  }
  return mesh;
}

std::shared_ptr<const Mesh> Parser::ply_mesh(const Entity& shape) {
  const Parameter* file = shape.parameters.find("filename");
  if (!file) return nullptr;
  std::shared_ptr<const Mesh> mesh = one_ply_mesh(shape.parameters.string("filename", ""), file->where);
  const Parameter* later = shape.parameters.find("filename1");
  return mesh && later ? posed_ply_mesh(*mesh, *later) : mesh;
}

std::shared_ptr<const Mesh> Parser::mesh_stated_by(Entity& shape) {
  if (shape.type == "plymesh") return ply_mesh(shape);
  auto mesh = take_mesh(shape, report_);
  return mesh ? std::make_shared<const Mesh>(std::move(*mesh)) : nullptr;
}

// Its form and what belongs to it; no value where nothing is left of it.
std::optional<ShapeDesc> Parser::shape_of(Entity stated) {
  const bool has_mesh = is_mesh(stated.type);
  const std::shared_ptr<const Mesh> mesh = has_mesh ? mesh_stated_by(stated) : nullptr;
  if (has_mesh && (!mesh || (mesh->triangles.empty() && mesh->quads.empty()))) return std::nullopt;
  std::optional<ShapeDesc> shape = read_model(shape_models(), Family::shape, stated, report_);
  if (!shape) return std::nullopt;
  shape->where = stated.where;
  set_mesh(*shape, mesh);
  return *std::move(shape);
}

void Parser::directive_shape() {
  auto stated = stated_entity(Family::shape);
  if (!is_in_world(true) || !stated) return;
  note_texture_uses(*stated);
  // Lights that are sampled cannot move.
  const bool shines = state_.area_light && !open_object_;
  const Transform place = shines ? still_transform("shape, which emits light,") : state_.transform.start;
  const std::vector<Transform> later = shines ? std::vector<Transform>() : transform_at_end("shape");
  std::optional<ShapeDesc> made = shape_of(std::move(stated->entity));
  if (!made) return;
  ShapeDesc& shape = *made;
  shape.object_to_world = place, shape.object_to_world_later = later;
  shape.reverse_orientation = state_.reverse_orientation;
  shape.material = static_cast<MaterialDescId>(state_.material);
  shape.area_light = state_.area_light, shape.media = state_.media;
  if (const auto mesh = mesh_of(shape); mesh && shines && !mesh->later.empty()) {
    report_.tolerable(here(), "this shape emits light and deforms; only shapes without emission can",
                      report_.lenient() ? "it keeps its first pose" : "lenient reading keeps its first pose");
    auto first_form = std::make_shared<Mesh>(*mesh);
    first_form->later.clear();
    set_mesh(shape, std::move(first_form));
  }
  if (!open_object_) {
    scene_.shapes.push_back(std::move(shape));
    return;
  }
  if (shape.area_light) {
    report_.warning(here(), "a shape of an object cannot emit light; its area light is omitted");
    shape.area_light.reset();
  }
  scene_.objects[static_cast<std::size_t>(*open_object_)].shapes.push_back(std::move(shape));
}

void Parser::directive_object_begin() {
  auto name = quoted_argument("a name");
  if (!name || !is_in_world(true)) return;
  if (open_object_) report_.error(here(), "ObjectBegin inside ObjectBegin");
  open_block("ObjectBegin");
  if (open_object_) return;
  auto id = static_cast<ObjectDescId>(scene_.objects.size());
  if (!object_ids_.emplace(*name, id).second)
    report_.error(here(), "object '" + printable(*name) + "' is defined twice");
  scene_.objects.push_back({*name, {}});
  open_object_ = id;
}

void Parser::directive_object_end() {
  if (!is_in_world(true)) return;
  if (!open_object_) return report_.error(here(), "ObjectEnd without ObjectBegin");
  // Blocks that were opened inside the object and not closed are reported and closed with it.
  while (!blocks_.empty() && blocks_.back().begin != "ObjectBegin") {
    report_.error(blocks_.back().where, std::string(blocks_.back().begin) + " has no end before ObjectEnd");
    blocks_.pop_back();
  }
  open_object_.reset();
  if (blocks_.empty()) return;
  state_ = std::move(blocks_.back().state);
  blocks_.pop_back();
}

void Parser::directive_object_instance() {
  SourceLocation where = lexer_->where(lexer_->peek());
  auto name = quoted_argument("the name of an object");
  if (!name || !is_in_world(true)) return;
  if (open_object_) return report_.error(here(), "ObjectInstance inside ObjectBegin");
  scene_.instances.push_back({ObjectDescId{}, state_.transform.start, here(), transform_at_end("instance")});
  instance_uses_.push_back({std::move(*name), where});
}

}  // namespace montelux::pbrt
