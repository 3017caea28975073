// All geometry of a scene in a few flat arrays, so that packs can gather from them and the ray-tracing kernel can share
// them: each vertex is stored once.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/curve.h"
#include "geometry/shape.h"
#include "geometry/triangle.h"
#include "math/transform.h"

namespace montelux {

// A vertex of a mesh, in the world or in the object that instances place: half a line of the cache, since rays read all
// of it. Read lane by lane as eight words.
struct alignas(32) MeshVertex {
  Vec3f position;
  Vec3f normal{0, 0, 0};  // not unit; 0 if the mesh has none
  Vec2f uv{0, 0};         // 0 if the mesh has none, and in the later poses of a deforming mesh
};
static_assert(sizeof(MeshVertex) == 32);

enum class GeometryKind : std::uint32_t { triangles, shape, curves };

// One surface with one material: a mesh, a quadric or patch, or a bundle of curves. Read lane by lane as sixteen words.
struct alignas(64) GeometryRow {
  GeometryKind kind = GeometryKind::triangles;
  std::uint32_t first = 0;  // triangles: number of the first; shape: its index; curves: index of the curve set
  std::uint32_t count = 0;  // triangles or segments
  std::uint32_t flags = 0;
  std::uint32_t material = 0;
  std::uint32_t first_light = 0;          // 1 + the light of primitive 0, the others following; 0: emits nothing
  std::uint32_t alpha = 0;                // 1 + number of a number texture; 0: opaque
  std::uint32_t object = 0;               // number of the object from 1, for the id layer
  std::uint32_t poses = 1;                // number of poses of a deforming mesh, evenly spaced over time
  std::uint32_t pose_vertices = 0;        // vertices of one pose; the poses are consecutive; 0: only one pose
  std::uint32_t inside = 0, outside = 0;  // numbers of the media on its sides, if it bounds media
  std::uint32_t unused[4] = {};

  static constexpr std::uint32_t has_normals = 1, has_uvs = 2, flip_normal = 4, invisible_to_shadow_rays = 8,
                                 ray_facing = 16, open_to_some_shadow_rays = 32;
  static constexpr std::uint32_t one_sided = 64;  // of triangles: the camera does not see their back
  static constexpr std::uint32_t bounds_media = 128;
};
static_assert(sizeof(GeometryRow) == 64);

// Geometries that instances place; indices into GeometryStore::rows.
struct ObjectRange {
  std::uint32_t first = 0, count = 0;
};

// A range of GeometryStore::instance_keys; none for a static instance.
struct KeyRange {
  std::uint32_t first = 0, count = 0;
};

struct PlacedObject {
  std::uint32_t object = 0;
  Transform object_to_world;  // at the start, if it moves
  KeyRange keys{};
};

struct GeometryStore {
  std::vector<MeshVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into vertices
  std::vector<Shape> shapes;
  std::vector<CurveSet> curves;
  std::vector<GeometryRow> rows;  // first those of the world, then those of the objects
  std::uint32_t world_rows = 0;
  std::vector<ObjectRange> objects;
  std::vector<PlacedObject> instances;
  std::vector<std::array<float, 24>> instance_rows;  // object to world, then world to object, three rows of four each
  // Object to world at times evenly spaced from the start to the end: in between, the kernel and surface() interpolate
  // the matrices linearly, entry by entry. Empty if no instance moves.
  std::vector<std::array<float, 12>> instance_keys;
  std::vector<KeyRange> instance_motion;  // of each instance; empty if none moves
  bool deforms = false;                   // some mesh has more than one pose
  bool bounds_media = false;              // some surface has different media on its sides
  // Some of these surfaces are interfaces, everywhere or in part: rays, also shadow rays, pass straight through them.
  bool has_open_boundaries = false;

  bool moves() const { return deforms || !instance_keys.empty(); }
  // Whether any surface exists for some rays and not for others.
  bool has_half_open() const {
    return std::ranges::any_of(
        rows, [](const GeometryRow& r) { return r.alpha != 0 || (r.flags & GeometryRow::open_to_some_shadow_rays); });
  }
};

// Where a ray hit the scene. `geometry` is a row number; `instance` is 1 + an instance's number, or 0.
template <class F>
struct Hit {
  F t, u, v;  // distance in units of the direction; the primitive's own parameters
  Uint<F> geometry, primitive, instance;
};

}  // namespace montelux
