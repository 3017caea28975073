// Deforming meshes: morph targets and skins.
#pragma once
#include "io/gltf/meshes.h"
#include "io/gltf/nodes.h"

namespace montelux::gltf {

// Joints, and the maps from the space of the mesh to theirs.
struct Skin {
  std::vector<std::size_t> joints;  // nodes
  std::vector<Matrix4> to_joint;
};
// The skin with that number, which must be valid; nothing if the skin is wrong.
std::optional<Skin> read_skin(Document& document, std::size_t number);

// A deforming primitive at one time.
struct Deformation {
  const std::vector<double>& weights;  // of the morph targets
  const Skin* skin = nullptr;          // or none
  const std::vector<Matrix4>& world;   // of the nodes
  Matrix4 placed;                      // of the mesh's node; unused if there is a skin
};
// Positions and normals in the world. Joints must be in range.
MeshPose pose_of(const Primitive& primitive, const Deformation& deformation);

}  // namespace montelux::gltf
