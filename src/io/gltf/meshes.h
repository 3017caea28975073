// Meshes of a glTF document.
#pragma once
#include <functional>

#include "geometry/mesh.h"
#include "io/gltf/accessors.h"

namespace montelux::gltf {

// Four joints of a skin a vertex, and their weights, which sum to one.
struct SkinBinding {
  std::vector<std::array<std::uint32_t, 4>> joints;
  std::vector<std::array<float, 4>> weights;
};

// What a morph target adds to positions and normals; empty where it adds nothing.
struct MorphTarget {
  std::vector<Vec3f> positions, normals;
};

// Triangles of one material. Texture coordinates have v upward, as the description has it.
struct Primitive {
  std::shared_ptr<const Mesh> mesh;
  std::optional<std::size_t> material;
  std::optional<SkinBinding> skin;
  std::vector<MorphTarget> targets;
  // The triangles whose texture coordinates are mirrored, where the primitive was split by that.
  bool is_mirrored = false;
  Element where;
};

struct MeshUse {
  std::vector<Primitive> primitives;
  std::vector<double> weights;  // of the morph targets; as many as there are
};

// What the reader of meshes asks about materials.
struct MaterialTraits {
  int uv_set = 0;
  bool parts_mirrored =
      false;  // triangles whose texture coordinates lie as in a mirror go into a primitive of their own
};
using TraitsOfMaterial = std::function<MaterialTraits(std::optional<std::size_t>)>;

// Reads the mesh with that number, which must be one. Points and lines are left out with a warning; a primitive in
// which anything is wrong is left out with an error.
MeshUse read_mesh(Document& document, std::size_t number, const TraitsOfMaterial& traits);

}  // namespace montelux::gltf
