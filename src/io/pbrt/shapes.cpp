// Shapes, and objects made of them.
#include "io/pbrt/meshes.h"
#include "io/pbrt/parser.h"
#include "io/ply.h"
#include "io/text_file.h"

namespace montelux::pbrt {

// The mesh of a file, which is read once however often it is placed.
std::shared_ptr<const Mesh> Parser::ply_mesh(const Entity& shape) {
  const Parameter* file = shape.parameters.find("filename");
  if (!file) return nullptr;
  std::string path = resolve_path(scene_.folder, shape.parameters.string("filename", ""));
  if (!is_regular_file(path)) return nullptr;  // reported with the other files
  auto [entry, is_new] = meshes_.try_emplace(path);
  if (!is_new) return entry->second;
  Diagnostics found;
  auto mesh = read_ply(path, file->where, found);
  for (const Diagnostic& diagnostic : found.all()) report_.add(diagnostic);
  if (mesh) entry->second = std::make_shared<const Mesh>(std::move(*mesh));
  return entry->second;
}

std::shared_ptr<const Mesh> Parser::mesh_of(Entity& shape) {
  if (shape.type == "plymesh") return ply_mesh(shape);
  auto mesh = take_mesh(shape, report_);
  return mesh ? std::make_shared<const Mesh>(std::move(*mesh)) : nullptr;
}

void Parser::directive_shape() {
  auto stated = stated_entity(Family::shape);
  if (!is_in_world(true) || !stated) return;
  note_texture_uses(*stated);
  ShapeDesc shape{std::move(stated->entity),  still_transform("shape"),
                  state_.reverse_orientation, static_cast<MaterialDescId>(state_.material),
                  state_.area_light,          nullptr};
  const std::string& type = shape.entity.type;
  if (type == "trianglemesh" || type == "plymesh" || type == "bilinearmesh" || type == "loopsubdiv") {
    shape.mesh = mesh_of(shape.entity);
    // A mesh that has lost all of its faces is no shape.
    if (!shape.mesh || (shape.mesh->triangles.empty() && shape.mesh->quads.empty())) return;
  }
  if (!open_object_) {
    scene_.shapes.push_back(std::move(shape));
    return;
  }
  if (shape.area_light) {
    report_.warning(here(), "a shape of an object cannot emit light; its area light is left out");
    shape.area_light.reset();
  }
  scene_.objects[static_cast<std::size_t>(*open_object_)].shapes.push_back(std::move(shape));
}

void Parser::directive_object_begin() {
  auto name = quoted_argument("a name");
  if (!name || !is_in_world(true)) return;
  if (open_object_) report_.error(here(), "ObjectBegin inside of ObjectBegin");
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
  // Blocks that were opened inside and not closed are reported and closed with the object.
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
  if (open_object_) return report_.error(here(), "ObjectInstance inside of ObjectBegin");
  scene_.instances.push_back({ObjectDescId{}, still_transform("instance"), here()});
  instance_uses_.push_back({std::move(*name), where});
}

}  // namespace montelux::pbrt
