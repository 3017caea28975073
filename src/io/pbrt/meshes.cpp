#include "io/pbrt/meshes.h"

#include <algorithm>
#include <numeric>

#include "io/mesh_check.h"

namespace montelux::pbrt {

namespace {

SourceLocation place_of(const Entity& shape, std::string_view parameter) {
  const Parameter* p = shape.parameters.find(parameter);
  return p ? p->where : shape.where;
}

// An attribute must have one value per vertex, or none.
bool fits_vertices(const Entity& shape, std::string_view name, std::size_t count, std::size_t vertices,
                   Reporter& report) {
  if (count == 0 || count == vertices) return true;
  report.error(place_of(shape, name), "'" + std::string(name) + "' has " + std::to_string(count) + " values for " +
                                          std::to_string(vertices) + " vertices");
  return false;
}

// The indices of the faces, checked; no value after an error.
std::optional<std::vector<std::uint32_t>> face_indices(const Entity& shape, std::size_t corners, std::size_t vertices,
                                                       Reporter& report) {
  const std::vector<int>& stated = shape.parameters.array<int>("indices");
  std::vector<std::uint32_t> indices(stated.begin(), stated.end());
  if (stated.empty()) {
    bool has_default = shape.type != "loopsubdiv" && vertices == corners;
    if (!has_default) {
      report.error(shape.where, "shape '" + shape.type + "' needs 'indices'");
      return std::nullopt;
    }
    indices.resize(corners);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  SourceLocation where = place_of(shape, "indices");
  if (indices.size() % corners != 0) {
    report.error(where,
                 "'indices' takes " + std::to_string(corners) + " per face; found " + std::to_string(indices.size()));
    return std::nullopt;
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < vertices) continue;
    report.error(where, "index " + std::to_string(stated[i]) + " (number " + std::to_string(i + 1) +
                            " of 'indices') has no vertex: there are " + std::to_string(vertices));
    return std::nullopt;
  }
  return indices;
}

// The later poses of a mesh, from arrays that contain them consecutively; false after an error.
bool take_later_poses(const Entity& shape, Mesh& mesh, Reporter& report) {
  constexpr std::size_t max_poses = 128;  // after the first: the limit of the ray-tracing kernel
  const std::vector<Vec3f>&p = shape.parameters.array<Vec3f>("P1"), &n = shape.parameters.array<Vec3f>("N1");
  const std::size_t vertices = mesh.positions.size(), poses = p.size() / vertices;
  if (p.empty() && n.empty()) return true;
  if (p.empty() || p.size() % vertices != 0 || poses > max_poses) {
    report.error(place_of(shape, p.empty() ? "N1" : "P1"),
                 "'P1' takes the " + std::to_string(vertices) + " vertices once for each later time (at most " +
                     std::to_string(max_poses) + "); there are " + std::to_string(p.size()) + " values");
    return false;
  }
  if (n.size() != (mesh.normals.empty() ? 0 : p.size())) {
    report.error(place_of(shape, n.empty() ? "P1" : "N1"),
                 "'N1' takes a normal for each vertex of 'P1' if there is 'N', and none otherwise; found " +
                     std::to_string(n.size()) + " for " + std::to_string(p.size()));
    return false;
  }
  const auto part = [vertices](const std::vector<Vec3f>& all, std::size_t pose) {
    const auto first = all.begin() + std::ptrdiff_t(pose * vertices);
    return std::vector<Vec3f>(first, first + std::ptrdiff_t(vertices));
  };
  for (std::size_t pose = 0; pose < poses; ++pose)
    mesh.later.push_back({part(p, pose), n.empty() ? std::vector<Vec3f>{} : part(n, pose)});
  return true;
}

void remove_arrays(Entity& shape) {
  ParameterList rest;
  for (const Parameter& p : shape.parameters.all()) {
    constexpr std::string_view arrays[] = {"P", "N", "S", "uv", "indices", "P1", "N1"};
    bool taken = std::ranges::find(arrays, p.name) != std::end(arrays);
    if (!taken) rest.add(p);
  }
  shape.parameters = std::move(rest);
}

bool subdivision_is_sensible(const Entity& shape, std::size_t triangles, Reporter& report) {
  constexpr std::size_t max_triangles = std::size_t{1} << 28;
  auto levels = static_cast<std::size_t>(shape.parameters.integer("levels", 3));
  if ((triangles << (2 * levels)) <= max_triangles) return true;
  report.error(place_of(shape, "levels"),
               std::to_string(levels) + " levels give more than 2^28 triangles for " + std::to_string(triangles));
  return false;
}

}  // namespace

std::optional<Mesh> take_mesh(Entity& shape, Reporter& report) {
  const ParameterList& p = shape.parameters;
  Mesh mesh;
  mesh.positions = p.array<Vec3f>("P");
  if (mesh.positions.empty()) {
    report.error(shape.where, "shape '" + shape.type + "' needs 'P', its vertices");
    return std::nullopt;
  }
  mesh.normals = p.array<Vec3f>("N");
  mesh.tangents = p.array<Vec3f>("S");
  mesh.uvs = p.array<Vec2f>("uv");
  std::size_t vertices = mesh.positions.size();
  bool good = fits_vertices(shape, "N", mesh.normals.size(), vertices, report);
  good &= fits_vertices(shape, "S", mesh.tangents.size(), vertices, report);
  good &= fits_vertices(shape, "uv", mesh.uvs.size(), vertices, report);
  good &= take_later_poses(shape, mesh, report);
  bool is_bilinear = shape.type == "bilinearmesh";
  auto indices = face_indices(shape, is_bilinear ? 4 : 3, vertices, report);
  if (!indices || !good) return std::nullopt;
  (is_bilinear ? mesh.quads : mesh.triangles) = std::move(*indices);
  if (shape.type == "loopsubdiv") {
    // Even a flat face of a control mesh contributes to the subdivision.
    if (!subdivision_is_sensible(shape, mesh.triangles.size() / 3, report)) return std::nullopt;
  } else if (std::size_t dropped = drop_degenerate_faces(mesh).total()) {
    report.add(dropped_faces_warning(dropped, "", shape.where));
  }
  remove_arrays(shape);
  return mesh;
}

}  // namespace montelux::pbrt
