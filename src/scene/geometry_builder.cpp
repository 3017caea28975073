#include "scene/geometry_builder.h"

#include <algorithm>
#include <utility>

#include "geometry/ray_reach.h"
#include "geometry/tessellate.h"
#include "math/affine.h"

namespace montelux {

namespace {

Bounds3 bounds_of(const std::vector<Vec3f>& points) {
  Bounds3 box;
  for (const Vec3f& p : points) box = join(box, p);
  return box;
}

// Normals and texture coordinates: of each vertex, or of none.
void append_vertices(const std::vector<Vec3f>& positions, const std::vector<Vec3f>& normals,
                     const std::vector<Vec2f>& uvs, std::vector<MeshVertex>& to) {
  const std::size_t first = to.size();
  to.resize(first + positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) to[first + i].position = positions[i];
  for (std::size_t i = 0; i < normals.size(); ++i) to[first + i].normal = normals[i];
  for (std::size_t i = 0; i < uvs.size(); ++i) to[first + i].uv = uvs[i];
}

// Whether the oriented normal of triangle `i` is opposite to (p1 - p0) x (p2 - p0): vertex normals decide if there are
// any.
bool faces_backward(const Mesh& world, std::size_t i, bool flip) {
  const std::uint32_t* v = world.triangles.data() + 3 * i;
  if (world.normals.empty()) return flip;
  Vec3f n = cross(world.positions[v[1]] - world.positions[v[0]], world.positions[v[2]] - world.positions[v[0]]);
  return dot(n, world.normals[v[0]] + world.normals[v[1]] + world.normals[v[2]]) < 0;
}

// The quadric that a form is; no value for other forms.
std::optional<Shape> quadric_of(const ShapeDesc& shape) {
  const Transform& place = shape.object_to_world;
  const bool reverse = shape.reverse_orientation;
  if (const auto* f = std::get_if<SphereForm>(&shape.form))
    return clamped(
        Sphere{place, reverse, f->radius, f->z_min.value_or(-f->radius), f->z_max.value_or(f->radius), f->phi_max});
  if (const auto* f = std::get_if<DiskForm>(&shape.form))
    return Disk{place, reverse, f->height, f->radius, f->inner_radius, f->phi_max};
  if (const auto* f = std::get_if<CylinderForm>(&shape.form))
    return clamped(Cylinder{place, reverse, f->radius, f->z_min, f->z_max, f->phi_max});
  return std::nullopt;
}

// The shapes in the types of the light builder.
template <class S>
bool turned_round(const S& s) {
  return s.reverse_orientation != s.object_to_world.swaps_handedness();
}
SphereShape light_shape(const Sphere& s) {
  return {s.object_to_world, s.radius, s.z_min, s.z_max, s.phi_max, turned_round(s)};
}
DiskShape light_shape(const Disk& s) {
  return {s.object_to_world, s.radius, s.inner_radius, s.height, s.phi_max, turned_round(s)};
}
CylinderShape light_shape(const Cylinder& s) {
  return {s.object_to_world, s.radius, s.z_min, s.z_max, s.phi_max, turned_round(s)};
}
PatchShape light_shape(const BilinearPatch& s) {
  bool flip = s.flip_normal;
  if (s.normals) flip = dot(cross(s.p[1] - s.p[0], s.p[2] - s.p[0]), (*s.normals)[0]) < 0;
  return {s.p[0], s.p[1], s.p[2], s.p[3], s.uv[0], s.uv[1], s.uv[2], s.uv[3], flip};
}

}  // namespace

void GeometryBuilder::add_world_shape(const ShapeDesc& shape) {
  if (!shape.object_to_world_later.empty())
    moving_.push_back(&shape);
  else
    add_shape(shape, true);
}

std::uint32_t GeometryBuilder::add_store_object(const std::function<void()>& add_shapes) {
  if (!in_object_) store_.world_rows = std::uint32_t(store_.rows.size());
  in_object_ = true;
  object_bounds_.emplace_back();
  auto first = std::uint32_t(store_.rows.size());
  add_shapes();
  store_.objects.push_back({first, std::uint32_t(store_.rows.size()) - first});
  return std::uint32_t(store_.objects.size() - 1);
}

// The shape in its own space: its motion places it.
std::uint32_t GeometryBuilder::add_object_of(const ShapeDesc& moving) {
  ShapeDesc still = moving;
  still.object_to_world = Transform();
  still.object_to_world_later.clear();
  // A map that mirrors reverses the normals of quadrics, but not those of meshes and curves.
  if (quadric_of(moving) && moving.object_to_world.swaps_handedness())
    still.reverse_orientation = !moving.reverse_orientation;
  const std::uint32_t object = add_store_object([&] { add_shape(still, false); });
  return object;
}

void GeometryBuilder::add_object(const ObjectDesc& object) {
  ObjectParts parts{};
  parts.still = add_store_object([&] {
    for (const ShapeDesc& shape : object.shapes)
      if (shape.object_to_world_later.empty()) add_shape(shape, false);
  });
  for (const ShapeDesc& shape : object.shapes)
    if (!shape.object_to_world_later.empty())
      parts.moving.emplace_back(add_object_of(shape), Motion(shape.object_to_world, shape.object_to_world_later));
  objects_.push_back(std::move(parts));
}

void GeometryBuilder::add_instance(const InstanceDesc& instance) {
  // The usual range of rays in the world.
  constexpr float usual_coordinate = 1e9f;
  if (!(ray_reach(instance.object_to_world) >= usual_coordinate)) {
    diagnostics_.warning(instance.where, "an object that is so small or so far away cannot be seen", "it is omitted");
    return;
  }
  const ObjectParts& parts = objects_[std::size_t(instance.object)];
  const Transform& start = instance.object_to_world;
  const Motion motion(start, instance.object_to_world_later);
  if (motion.moves())
    place_moving(parts.still, {[&](double t) { return motion.at(t); }, motion.steps()});
  else
    place(parts.still, start);
  // Two nested motions bend even if neither rotates.
  for (const std::pair<std::uint32_t, Motion>& part : parts.moving)
    place_moving(part.first,
                 {[&](double t) { return motion.at(t) * part.second.at(t); },
                  motion.moves() ? std::max({motion.steps(), part.second.steps(), 64}) : part.second.steps()});
}

void GeometryBuilder::place(std::uint32_t object, const Transform& t) {
  store_.instances.push_back({object, t, {}});
  std::array<float, 24> row;
  std::copy(t.rows().begin(), t.rows().end(), row.begin());
  std::copy(t.inverse_rows().begin(), t.inverse_rows().end(), row.begin() + 12);
  store_.instance_rows.push_back(row);
  const Bounds3& box = object_bounds_[object];
  if (box.is_empty()) return;
  for (int corner = 0; corner < 8; ++corner)
    bounds_ = join(bounds_, t.point(Vec3f{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                          corner & 4 ? box.high.z : box.low.z}));
}

void GeometryBuilder::place_moving(std::uint32_t object, const Placing& placing) {
  const auto number = store_.instances.size();
  const KeyRange keys{std::uint32_t(store_.instance_keys.size()), std::uint32_t(placing.steps) + 1};
  for (int key = 0; key <= placing.steps; ++key)
    store_.instance_keys.push_back(placing.at(double(key) / placing.steps).rows());
  place(object, placing.at(0));
  store_.instances.back().keys = keys;
  store_.instance_motion.resize(number);
  store_.instance_motion.push_back(keys);
  // Points move in straight lines from key to key: the box of the corners at all keys contains them.
  const Bounds3& box = object_bounds_[object];
  if (box.is_empty()) return;
  for (std::uint32_t key = 0; key < keys.count; ++key) {
    const auto& m = store_.instance_keys[keys.first + key];
    Affine<float> map;
    std::copy(m.begin(), m.end(), map.m);
    for (int corner = 0; corner < 8; ++corner)
      bounds_ = join(bounds_, map.point(Vec3f{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                              corner & 4 ? box.high.z : box.low.z}));
  }
}

GeometryStore GeometryBuilder::take() {
  for (const ShapeDesc* shape : moving_) {
    const Motion motion(shape->object_to_world, shape->object_to_world_later);
    place_moving(add_object_of(*shape), {[&](double t) { return motion.at(t); }, motion.steps()});
  }
  if (!in_object_) store_.world_rows = std::uint32_t(store_.rows.size());
  if (!store_.instance_keys.empty()) store_.instance_motion.resize(store_.instances.size());
  // Idle lanes gather element 0 of every array.
  if (store_.vertices.empty()) store_.vertices.emplace_back();
  if (store_.triangles.empty()) store_.triangles.push_back({0, 0, 0});
  if (store_.rows.empty()) store_.rows.emplace_back();
  return std::move(store_);
}

void GeometryBuilder::add_shape(const ShapeDesc& shape, bool in_world) {
  std::optional<std::uint32_t> alpha = inputs_.alpha(shape);
  const bool interface = inputs_.is_interface(shape.material);
  const bool partly_interface = inputs_.is_partly_interface(shape.material);
  const std::optional<MediumSides> media = inputs_.media(shape);
  if (!alpha || (interface && !shape.area_light && !media)) {  // nothing that light could hit
    return;
  }
  if (shape.area_light && !in_world)
    diagnostics_.warning(shape.area_light->where, "area lights on shapes of an instanced object do not emit",
                         "place the shape outside ObjectBegin and ObjectEnd");
  std::optional<Emission> emission;
  if (shape.area_light && in_world) emission = inputs_.emission(*shape.area_light);
  if (emission) emission->masked = *alpha != 0, emission->seen_through = interface || partly_interface;

  GeometryRow row;
  row.alpha = *alpha;
  row.material = std::uint32_t(shape.material);
  row.object = next_object_number_++;
  if (media) {
    row.flags |= GeometryRow::bounds_media, row.inside = media->inside, row.outside = media->outside;
    store_.bounds_media = true;
    store_.has_open_boundaries = store_.has_open_boundaries || interface || partly_interface;
  }
  if (interface) row.flags |= GeometryRow::invisible_to_shadow_rays;
  if (partly_interface) row.flags |= GeometryRow::open_to_some_shadow_rays;
  if (shape.one_sided) row.flags |= GeometryRow::one_sided;
  if (const auto* mesh = std::get_if<MeshForm>(&shape.form); mesh && mesh->mesh)
    add_mesh(*mesh->mesh, shape, row, emission);
  else if (const auto* surface = std::get_if<SubdivisionForm>(&shape.form); surface && surface->control)
    add_mesh(loop_subdivide(*surface->control, surface->levels), shape, row, emission);
  else if (const auto* curve = std::get_if<CurveDesc>(&shape.form))
    add_curves(*curve, shape, row);
  else if (std::optional<Shape> quadric = quadric_of(shape))
    add_single(std::move(*quadric), row, emission);
}

void GeometryBuilder::add_mesh(const Mesh& mesh, const ShapeDesc& shape, const GeometryRow& row,
                               const std::optional<Emission>& emission) {
  WorldMesh world = to_world(mesh, shape.object_to_world, shape.reverse_orientation);
  if (world.mesh.quads.empty() || !world.mesh.later.empty()) {
    add_triangles(world.mesh, world.flip_normal, row, emission);
    return;
  }
  // A flat patch becomes two triangles unless its parameters are used; the kernel is much faster with those.
  const bool parameters_matter = emission || row.alpha != 0 || inputs_.uses_parameters(shape.material);
  SplitMesh split = parameters_matter ? split_affine_quads(world.mesh) : split_flat_quads(world.mesh);
  if (!split.triangles.triangles.empty()) add_triangles(split.triangles, world.flip_normal, row, emission);
  if (!split.patches.quads.empty()) add_patches(split.patches, world.flip_normal, row, emission);
}

void GeometryBuilder::add_triangles(const Mesh& world, bool flip, const GeometryRow& like,
                                    const std::optional<Emission>& emission) {
  GeometryRow row = like;
  const auto vertex_base = std::uint32_t(store_.vertices.size());
  const auto count = std::uint32_t(world.triangles.size() / 3);
  row.kind = GeometryKind::triangles;
  row.first = std::uint32_t(store_.triangles.size());
  row.count = count;
  if (flip) row.flags |= GeometryRow::flip_normal;
  if (!world.normals.empty()) row.flags |= GeometryRow::has_normals;
  if (!world.uvs.empty()) row.flags |= GeometryRow::has_uvs;
  append_vertices(world.positions, world.normals, world.uvs, store_.vertices);
  add_later_poses(world, row);
  for (std::size_t i = 0; i < world.triangles.size(); i += 3)
    store_.triangles.push_back(
        {world.triangles[i] + vertex_base, world.triangles[i + 1] + vertex_base, world.triangles[i + 2] + vertex_base});
  grow(bounds_of(world.positions));
  if (emission)
    for (std::uint32_t i = 0; i < count; ++i) {
      // Emission must be visible from the side that emits.
      if (faces_backward(world, i, flip) != flip) row.flags &= ~GeometryRow::one_sided;
      TriangleShape triangle;
      Vec3f* p[3] = {&triangle.p0, &triangle.p1, &triangle.p2};
      Vec2f* uv[3] = {&triangle.uv0, &triangle.uv1, &triangle.uv2};
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint32_t vertex = world.triangles[3 * i + c];
        *p[c] = world.positions[vertex];
        if (!world.uvs.empty()) *uv[c] = world.uvs[vertex];
      }
      triangle.flip = faces_backward(world, i, flip);
      LightId light = lights_.add(triangle, *emission);
      if (i == 0) row.first_light = std::uint32_t(light) + 1;
    }
  store_.rows.push_back(row);
}

// Appends the poses after the first, positions and normals.
void GeometryBuilder::add_later_poses(const Mesh& world, GeometryRow& row) {
  if (world.later.empty()) return;
  row.poses = std::uint32_t(world.later.size()) + 1;
  row.pose_vertices = std::uint32_t(world.positions.size());
  store_.deforms = true;
  for (const MeshPose& pose : world.later) {
    append_vertices(pose.positions, pose.normals, {}, store_.vertices);
    grow(bounds_of(pose.positions));
  }
}

void GeometryBuilder::add_patches(const Mesh& world, bool flip, const GeometryRow& like,
                                  const std::optional<Emission>& emission) {
  GeometryRow row = like;
  for (std::size_t quad = 0; quad < world.quads.size() / 4; ++quad)
    add_single(patch_of(world, quad, flip), row, emission);
}

void GeometryBuilder::add_single(Shape shape, const GeometryRow& like, const std::optional<Emission>& emission) {
  GeometryRow row = like;
  row.kind = GeometryKind::shape;
  row.first = std::uint32_t(store_.shapes.size());
  row.count = 1;
  grow(montelux::bounds(shape));
  if (emission)
    row.first_light =
        std::uint32_t(std::visit([&](const auto& s) { return lights_.add(light_shape(s), *emission); }, shape)) + 1;
  store_.shapes.push_back(std::move(shape));
  store_.rows.push_back(row);
}

void GeometryBuilder::add_curves(const CurveDesc& stated, const ShapeDesc& shape, const GeometryRow& like) {
  GeometryRow row = like;
  Result<CurveSet> made = make_curves(stated);
  if (!made) {
    diagnostics_.error(shape.where, made.error());
    return;
  }
  CurveSet curves = to_world(*made, shape.object_to_world, shape.reverse_orientation);
  if (shape.area_light)
    diagnostics_.warning(shape.area_light->where, "area lights on curves do not emit",
                         "put the light on a mesh or a quadric");
  row.kind = GeometryKind::curves;
  if (curves.type != CurveType::ribbon) row.flags |= GeometryRow::ray_facing;
  row.first = std::uint32_t(store_.curves.size());
  row.count = std::uint32_t(curves.first.size());
  Bounds3 box;
  for (const CurveControl& c : curves.controls)
    box = join(join(box, Vec3f{c.x - c.radius, c.y - c.radius, c.z - c.radius}),
               Vec3f{c.x + c.radius, c.y + c.radius, c.z + c.radius});
  grow(box);
  store_.curves.push_back(std::move(curves));
  store_.rows.push_back(row);
}

}  // namespace montelux
