#include "io/gltf/scene_builder.h"

#include <algorithm>
#include <cstring>

#include "io/gltf/lights_cameras.h"
#include "io/mesh_check.h"
#include "io/text_file.h"

namespace montelux::gltf {

namespace {

// Meshes with at least this many triangles that are shown more than once are stored once.
constexpr std::size_t fewest_to_instance = 256;
// Maximum size of all poses of a deforming mesh, in bytes.
constexpr std::size_t max_pose_bytes = std::size_t(8) << 30;

std::string shown_name(const Node& node, std::size_t number) {
  return node.name.empty() ? "node " + std::to_string(number) : "node '" + printable(node.name) + "'";
}

bool same(const MeshPose& a, const MeshPose& b) {
  const auto equal = [](const std::vector<Vec3f>& x, const std::vector<Vec3f>& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return equal(a.positions, b.positions) && equal(a.normals, b.normals);
}

}  // namespace

SceneDesc SceneBuilder::build() {
  scene_.file = *document_.whole().file;
  scene_.folder = document_.folder();
  scene_.materials.emplace_back();
  read_animation_and_time();
  read_meshes();
  place_meshes();
  place_lights();
  place_camera();
  return std::move(scene_);
}

void SceneBuilder::read_animation_and_time() {
  const std::optional<Animation> animation = read_animation(document_, tree_, options_.animation);
  const AnimationTime time{0, animation ? animation->end : 0};
  const AnimationWindow window = options_.window ? options_.window(time) : AnimationWindow{};
  key_poses_ = key_poses_of(document_, tree_, animation, window);
  scene_.transforms_start = key_poses_.start, scene_.transforms_end = key_poses_.end;
  scene_.shutter = std::pair{0.0, 0.0};
  scene_.frame_rate = time.frame_rate;
  scene_.whole_time = std::pair{time.start, time.end};
  scene_.frames_held = key_poses_.frames_held;
}

void SceneBuilder::read_meshes() {
  const auto traits = [this](std::optional<std::size_t> material) -> MaterialTraits {
    const MaterialUse& use = materials_.use(material);
    return {use.uv_set, use.mirrored.has_value()};
  };
  for (std::size_t i : tree_.shown) {
    if (!tree_.nodes[i].mesh) continue;
    const std::size_t mesh = *tree_.nodes[i].mesh;
    if (++times_used_[mesh] == 1) meshes_.emplace(mesh, read_mesh(document_, mesh, traits));
  }
}

void SceneBuilder::report_moves(const Element& where, std::string_view what) {
  where.tolerable(std::string(what) + " moves; only cameras and surfaces without emission can",
                  document_.report().lenient() ? "it stays at its first position" : "lenient reading leaves it there");
}

std::optional<SceneBuilder::Placing> SceneBuilder::placing_of(std::size_t node) {
  const Element& element = tree_.nodes[node].element;
  const std::string name = shown_name(tree_.nodes[node], node);
  const auto first = from_matrix(key_poses_.world.front()[node]);
  if (!first) {
    element.warning(name + " has a scale of zero: it is not shown");
    return std::nullopt;
  }
  Placing placing{*first, {}, first->swaps_handedness()};
  if (!key_poses_.moves(node)) return placing;
  for (std::size_t k = 1; k < key_poses_.count(); ++k) {
    const auto next = from_matrix(key_poses_.world[k][node]);
    if (!next || next->swaps_handedness() != placing.mirrored) {
      element.tolerable(name + " is mirrored during its motion, or its scale becomes zero",
                        "lenient reading leaves it at its start");
      placing.later.clear();
      return placing;
    }
    placing.later.push_back(*next);
  }
  return placing;
}

// The mesh without emission, because instanced objects cannot emit. Nothing if instancing is not worthwhile.
std::optional<ObjectDescId> SceneBuilder::object_of(std::size_t mesh, bool mirrored) {
  auto [place, is_new] = objects_.try_emplace({mesh, mirrored});
  if (!is_new) return place->second;
  ObjectDesc object{"mesh " + std::to_string(mesh) + (mirrored ? " mirrored" : ""), {}};
  std::size_t triangles = 0;
  for (const Primitive& primitive : meshes_[mesh].primitives) {
    // A deforming mesh has its own form at each node.
    if (!primitive.targets.empty() || primitive.skin) return std::nullopt;
    if (shines(primitive)) continue;
    triangles += primitive.mesh->triangles.size() / 3;
    object.shapes.push_back(shape_of(primitive, mirrored));
  }
  if (times_used_[mesh] < 2 || triangles < fewest_to_instance) return std::nullopt;
  place->second = ObjectDescId(scene_.objects.size());
  scene_.objects.push_back(std::move(object));
  return place->second;
}

ShapeDesc SceneBuilder::shape_of(const Primitive& primitive, bool mirrored) {
  const MaterialUse& material = materials_.use(primitive.material);
  // A map that mirrors inverts the mirroring of texture coordinates.
  const bool turned = primitive.is_mirrored != mirrored;
  ShapeDesc shape;
  shape.where = primitive.where.where();
  shape.alpha = material.alpha;
  shape.one_sided = material.one_sided;
  shape.material = turned ? material.mirrored.value_or(material.id) : material.id;
  shape.area_light = material.area_light;
  const auto& uvs = primitive.mesh->uvs;
  // Less than a texel beyond the edge is not worth a message.
  const auto is_beyond = [](const Vec2f& uv) {
    return std::min(uv.x, uv.y) < -1e-3f || std::max(uv.x, uv.y) > 1 + 1e-3f;
  };
  if (material.repeats_emission && std::any_of(uvs.begin(), uvs.end(), is_beyond))
    primitive.where.warning("texture coordinates are outside [0, 1], where an emissive texture is clamped to its edge");
  shape.form = MeshForm{primitive.mesh};
  return shape;
}

const Skin* SceneBuilder::skin_of(const Node& node, const Primitive& primitive) {
  if (!node.skin || !primitive.skin) return nullptr;
  auto [place, is_new] = skins_.try_emplace(*node.skin);
  if (is_new) place->second = read_skin(document_, *node.skin);
  if (!place->second) return nullptr;
  for (const auto& joints : primitive.skin->joints)
    for (std::uint32_t joint : joints)
      if (joint >= place->second->joints.size()) {
        primitive.where["attributes"]["JOINTS_0"].error("joint " + std::to_string(joint) + " is beyond the " +
                                                        std::to_string(place->second->joints.size()) +
                                                        " joints of skin " + std::to_string(*node.skin));
        return nullptr;
      }
  return &*place->second;
}

const std::vector<double>& SceneBuilder::weights_of(std::size_t node, std::size_t key) {
  const std::vector<double>& own = key_poses_.weights[key][node];
  return own.empty() ? meshes_[*tree_.nodes[node].mesh].weights : own;
}

// In world space: each time with its own vertices.
void SceneBuilder::place_deforming(std::size_t node, const Primitive& primitive) {
  const Node& n = tree_.nodes[node];
  const Skin* skin = skin_of(n, primitive);
  if (n.skin && primitive.skin && !skin) return;
  const std::size_t bytes = key_poses_.count() * primitive.mesh->positions.size() * 2 * sizeof(Vec3f);
  if (bytes > max_pose_bytes) {
    primitive.where.error(
        "takes more than 8 GiB in the " + std::to_string(key_poses_.count()) + " poses of its deformation",
        "render fewer frames at once");
    return;
  }
  auto mesh = std::make_shared<Mesh>(*primitive.mesh);
  bool changes = false;
  for (std::size_t k = 0; k < key_poses_.count(); ++k) {
    const auto& world = key_poses_.world[k];
    MeshPose pose = pose_of(primitive, {weights_of(node, k), skin, world, world[node]});
    for (const Vec3f& p : pose.positions) bounds_ = join(bounds_, p);
    if (k == 0) {
      mesh->positions = std::move(pose.positions), mesh->normals = std::move(pose.normals);
      continue;
    }
    changes = changes || !same(pose, {mesh->positions, mesh->normals});
    mesh->later.push_back(std::move(pose));
  }
  if (changes && shines(primitive)) report_moves(n.element, "an emitting surface");
  if (!changes || shines(primitive)) mesh->later.clear();
  drop_degenerate_faces(*mesh);
  if (mesh->triangles.empty()) return;
  const Transform placed(key_poses_.world.front()[node], Matrix4{});
  const bool mirrored = !skin && placed.swaps_handedness();
  ShapeDesc shape = shape_of(primitive, mirrored);
  shape.reverse_orientation = mirrored;  // the winding refers to the mesh's own space
  shape.form = MeshForm{std::move(mesh)};
  scene_.shapes.push_back(std::move(shape));
}

void SceneBuilder::place_mesh(std::size_t node) {
  const Node& n = tree_.nodes[node];
  const std::vector<Primitive>& primitives = meshes_[*n.mesh].primitives;
  std::optional<Placing> placing;
  std::optional<ObjectDescId> object;
  // A skin's node may have any matrix: it is not used.
  const bool is_rigid =
      std::any_of(primitives.begin(), primitives.end(), [&](const auto& p) { return !deforms(n, p); });
  if (is_rigid) {
    placing = placing_of(node);
    if (placing) object = object_of(*n.mesh, placing->mirrored);
  }
  if (object) scene_.instances.push_back({*object, placing->first, n.element.where(), placing->later});
  for (const Primitive& primitive : primitives) {
    if (deforms(n, primitive)) {
      place_deforming(node, primitive);
      continue;
    }
    if (!placing) continue;
    for (const Vec3f& p : primitive.mesh->positions) bounds_ = join(bounds_, placing->first.point(p));
    if (object && !shines(primitive)) continue;
    ShapeDesc shape = shape_of(primitive, placing->mirrored);
    shape.object_to_world = placing->first;
    shape.object_to_world_later = placing->later;
    if (shines(primitive) && !placing->later.empty()) {
      report_moves(n.element, "an emitting surface");
      shape.object_to_world_later.clear();
    }
    scene_.shapes.push_back(std::move(shape));
  }
}

void SceneBuilder::place_meshes() {
  for (std::size_t i : tree_.shown)
    if (tree_.nodes[i].mesh) place_mesh(i);
}

void SceneBuilder::place_lights() {
  for (std::size_t i : tree_.shown) {
    const Node& node = tree_.nodes[i];
    if (!node.light) continue;
    if (key_poses_.moves(i)) report_moves(node.element, "a light");
    if (std::optional<LightDesc> light = light_of(document_, *node.light, key_poses_.world.front()[i]))
      scene_.lights.push_back(*std::move(light));
  }
  if (options_.environment) return;
  if (std::optional<LightDesc> sky = environment_of(document_, tree_.scene)) scene_.lights.push_back(*std::move(sky));
  const bool shines = std::any_of(scene_.shapes.begin(), scene_.shapes.end(),
                                  [](const ShapeDesc& shape) { return shape.area_light.has_value(); });
  if (!scene_.lights.empty() || shines) return;
  document_.report().note(document_.whole(), "the scene has no light: a uniform sky of radiance 1 is used");
  LightDesc sky;
  sky.model = InfiniteLightDesc{}, sky.where = document_.whole();
  scene_.lights.push_back(std::move(sky));
}

void SceneBuilder::place_camera() {
  const std::optional<std::size_t> node = choose_camera(document_, tree_, options_.camera);
  if (!node) {
    if (!options_.camera)
      document_.report().note(document_.whole(), "the scene has no camera: one that shows all of it is used");
    state_default_camera(bounds_, scene_);
    return;
  }
  const std::size_t camera = *tree_.nodes[*node].camera;
  state_camera(document_, camera, key_poses_.world.front()[*node], scene_);
  if (!key_poses_.moves(*node)) return;
  for (std::size_t k = 1; k < key_poses_.count(); ++k)
    if (const auto placed = from_matrix(camera_to_world(document_, camera, key_poses_.world[k][*node])))
      scene_.world_to_camera_later.push_back(placed->inverted());
}

}  // namespace montelux::gltf
