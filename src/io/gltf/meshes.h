// Meshes of a glTF document.
#pragma once
#include <functional>

#include "geometry/mesh.h"
#include "io/gltf/accessors.h"

namespace montelux::gltf {

// Four joints of a skin per vertex, and their weights, which sum to one.
struct SkinBinding {
  std::vector<std::array<std::uint32_t, 4>> joints;
  std::vector<std::array<float, 4>> weights;
};

// What a morph target adds to positions and normals; empty if it adds nothing.
struct MorphTarget {
  std::vector<Vec3f> positions, normals;
};

// Triangles of one material. v of the texture coordinates points upward, as in the description.
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
  std::vector<double> weights;  // of the morph targets; one for each
};

// What the mesh reader needs to know about materials.
struct MaterialTraits {
  int uv_set = 0;
  bool parts_mirrored = false;  // triangles with mirrored texture coordinates become a separate primitive
};
using TraitsOfMaterial = std::function<MaterialTraits(std::optional<std::size_t>)>;

// Reads the mesh with that number, which must be valid. Points and lines are omitted with a warning; a primitive
// with any error is omitted.
MeshUse read_mesh(Document& document, std::size_t number, const TraitsOfMaterial& traits);

}  // namespace montelux::gltf
