#include "io/gltf/meshes.h"

#include <algorithm>
#include <cmath>

#include "io/mesh_check.h"

namespace montelux::gltf {

namespace {

std::vector<Vec3f> vectors(const Numbers& numbers) {
  std::vector<Vec3f> list(numbers.count);
  for (std::size_t i = 0; i < numbers.count; ++i) list[i] = numbers.vec3(i);
  return list;
}

// An attribute that must have an element for each of the `count` vertices.
std::optional<Numbers> attribute(Document& document, const Element& user, const AccessorUse& use, std::size_t count) {
  if (!user) return std::nullopt;
  auto numbers = read_accessor(document, user, use);
  if (!numbers || numbers->count == count) return numbers;
  user.error("has " + std::to_string(numbers->count) + " elements for " + std::to_string(count) + " vertices");
  return std::nullopt;
}

// The triangle corners that a primitive of this mode makes from a range of vertices (glTF 2.0, 3.7.2.1).
std::vector<std::uint32_t> triangles_of(std::uint64_t mode, const std::vector<std::uint32_t>& v) {
  if (mode == 4) return {v.begin(), v.begin() + std::ptrdiff_t(v.size() / 3 * 3)};
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == 5)
      corners.insert(corners.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    else
      corners.insert(corners.end(), {v[i + 1], v[i + 2], v[0]});
  }
  return corners;
}

std::optional<std::vector<std::uint32_t>> corners_of(Document& document, const Element& primitive, std::uint64_t mode,
                                                     std::size_t vertices) {
  std::vector<std::uint32_t> run;
  if (const Element indices = primitive["indices"]) {
    auto numbers = read_accessor(document, indices, {{"SCALAR"}, true});
    if (!numbers) return std::nullopt;
    for (std::uint32_t i : numbers->all)
      if (i >= vertices) {
        indices.error("index " + std::to_string(i) + " is beyond the " + std::to_string(vertices) + " vertices");
        return std::nullopt;
      }
    run = std::move(numbers->all);
  } else {
    run.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) run[i] = std::uint32_t(i);
  }
  if (mode == 4 && run.size() % 3 != 0)
    primitive.warning("the last " + std::to_string(run.size() % 3) + " indices make no triangle");
  return triangles_of(mode, run);
}

std::optional<SkinBinding> read_skin(Document& document, const Element& attributes, std::size_t count) {
  const Element joints = attributes["JOINTS_0"], weights = attributes["WEIGHTS_0"];
  if (!joints && !weights) return std::nullopt;
  if (!joints || !weights) {
    attributes.error("JOINTS_0 and WEIGHTS_0 must be used together");
    return std::nullopt;
  }
  const auto j = attribute(document, joints, {{"VEC4"}, true}, count);
  const auto w = attribute(document, weights, {{"VEC4"}}, count);
  if (!j || !w) return std::nullopt;
  if (attributes["JOINTS_1"]) attributes.warning("more than four joints per vertex: those of JOINTS_0 are used");
  SkinBinding skin;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 4> share{};
    float sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += share[k] = std::max(w->at(i)[k], 0.0f);
    for (float& x : share) x = sum > 0 ? x / sum : 0.25f;
    const std::uint32_t* joint = j->all.data() + 4 * i;
    skin.joints.push_back({joint[0], joint[1], joint[2], joint[3]});
    skin.weights.push_back(share);
  }
  return skin;
}

std::vector<MorphTarget> read_targets(Document& document, const Element& list, std::size_t count) {
  std::vector<MorphTarget> targets(list.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (const auto p = attribute(document, list[i]["POSITION"], {{"VEC3"}}, count)) targets[i].positions = vectors(*p);
    if (const auto n = attribute(document, list[i]["NORMAL"], {{"VEC3"}}, count)) targets[i].normals = vectors(*n);
  }
  return targets;
}

// Twice the signed area of the triangle in the plane of (u, v), relative to the side of the normals.
bool is_mirrored(const Mesh& mesh, const std::uint32_t* v) {
  const Vec2f a = mesh.uvs[v[1]] - mesh.uvs[v[0]], b = mesh.uvs[v[2]] - mesh.uvs[v[0]];
  float turn = a.x * b.y - a.y * b.x;
  if (!mesh.normals.empty()) {
    const Vec3f n = cross(mesh.positions[v[1]] - mesh.positions[v[0]], mesh.positions[v[2]] - mesh.positions[v[0]]);
    if (dot(n, mesh.normals[v[0]] + mesh.normals[v[1]] + mesh.normals[v[2]]) < 0) turn = -turn;
  }
  return turn < 0;
}

// A constant white changes nothing.
void check_colors(Document& document, const Element& attributes, std::size_t count) {
  const Element colors = attributes["COLOR_0"];
  const auto numbers = attribute(document, colors, {{"VEC3", "VEC4"}}, count);
  if (!numbers) return;
  if (!std::all_of(numbers->values.begin(), numbers->values.end(), [](float x) { return x >= 1; }))
    colors.warning("vertex colours are not applied");
}

class PrimitiveReader {
 public:
  PrimitiveReader(Document& document, const TraitsOfMaterial& traits) : document_(document), traits_(traits) {}

  // One primitive, two where it is split, or none.
  std::vector<Primitive> read(const Element& element) {
    const std::uint64_t mode = element["mode"].whole(6).value_or(4);
    const Element attributes = element.required("attributes");
    const auto material = element["material"].index_of(document_.list("materials"), "a material");
    if (mode < 4) {
      element.warning("points and lines are not shown");
      return {};
    }
    if (element["extensions"]["KHR_draco_mesh_compression"] && !attributes["POSITION"]) return {};
    if (!attributes["POSITION"]) {
      if (attributes) attributes.warning("a primitive without positions is not shown");
      return {};
    }
    const auto positions = read_accessor(document_, attributes["POSITION"], {{"VEC3"}});
    if (!positions) return {};
    const MaterialTraits traits = traits_(material);
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = vectors(*positions);
    if (const auto n = attribute(document_, attributes["NORMAL"], {{"VEC3"}}, positions->count))
      mesh->normals = vectors(*n);
    read_uvs(attributes, traits, *mesh);
    check_colors(document_, attributes, positions->count);
    auto corners = corners_of(document_, element, mode, positions->count);
    auto skin = read_skin(document_, attributes, positions->count);
    auto targets = read_targets(document_, element["targets"], positions->count);
    if (!corners) return {};
    mesh->triangles = *std::move(corners);
    // A triangle without area may get some when deformed.
    if (!skin && targets.empty()) drop_degenerate_faces(*mesh);
    if (mesh->triangles.empty()) return {};
    Primitive whole{std::move(mesh), material, std::move(skin), std::move(targets), false, element};
    return traits.parts_mirrored ? split_by_side(std::move(whole)) : std::vector<Primitive>{std::move(whole)};
  }

 private:
  void read_uvs(const Element& attributes, const MaterialTraits& traits, Mesh& mesh) {
    const std::string name = "TEXCOORD_" + std::to_string(traits.uv_set);
    const auto uvs = attribute(document_, attributes[std::string_view(name)], {{"VEC2"}}, mesh.positions.size());
    if (!uvs) return;
    mesh.uvs.reserve(uvs->count);
    for (std::size_t i = 0; i < uvs->count; ++i) mesh.uvs.push_back({uvs->at(i)[0], 1 - uvs->at(i)[1]});
  }

  static std::vector<Primitive> split_by_side(Primitive whole) {
    const Mesh& mesh = *whole.mesh;
    if (mesh.uvs.empty()) return {std::move(whole)};
    std::array<std::vector<std::uint32_t>, 2> sides;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
      auto& side = sides[is_mirrored(mesh, mesh.triangles.data() + i) ? 1 : 0];
      side.insert(side.end(), mesh.triangles.begin() + std::ptrdiff_t(i),
                  mesh.triangles.begin() + std::ptrdiff_t(i + 3));
    }
    std::vector<Primitive> parts;
    for (std::size_t side = 0; side < 2; ++side) {
      if (sides[side].empty()) continue;
      Primitive part = whole;
      if (!sides[1 - side].empty()) {
        auto copy = std::make_shared<Mesh>(mesh);
        copy->triangles = std::move(sides[side]);
        part.mesh = std::move(copy);
      }
      part.is_mirrored = side == 1;
      parts.push_back(std::move(part));
    }
    return parts;
  }

  Document& document_;
  const TraitsOfMaterial& traits_;
};

}  // namespace

MeshUse read_mesh(Document& document, std::size_t number, const TraitsOfMaterial& traits) {
  const Element element = document.list("meshes")[number], list = element.required("primitives");
  MeshUse use;
  PrimitiveReader reader(document, traits);
  std::size_t targets = 0;
  for (std::size_t i = 0; i < list.size(); ++i)
    for (Primitive& primitive : reader.read(list[i])) {
      targets = std::max(targets, primitive.targets.size());
      use.primitives.push_back(std::move(primitive));
    }
  const Element weights = element["weights"];
  for (std::size_t i = 0; i < weights.size(); ++i) use.weights.push_back(weights[i].number().value_or(0));
  use.weights.resize(targets);
  return use;
}

}  // namespace montelux::gltf
