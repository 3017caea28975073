// The tree of nodes of a glTF document, and their transforms.
#pragma once
#include "io/gltf/document.h"
#include "math/transform.h"

namespace montelux::gltf {

// The transform of a node in its parent: a matrix, or translation, rotation (a unit quaternion x, y, z, w) and scale.
struct LocalPose {
  std::optional<Matrix4> fixed;
  std::array<double, 3> translation{}, scale{1, 1, 1};
  std::array<double, 4> rotation{0, 0, 0, 1};

  Matrix4 matrix() const;  // translation * rotation * scale (glTF 2.0, 3.5.3)
};

struct Node {
  Element element;
  std::string name;
  std::vector<std::size_t> children;
  std::optional<std::size_t> parent;
  LocalPose pose;
  std::optional<std::size_t> mesh, camera, skin, light;
  std::vector<double> weights;  // of morph targets; empty: the mesh's own
};

struct NodeTree {
  explicit NodeTree(Element shown_scene) : scene(std::move(shown_scene)) {}

  std::vector<Node> nodes;
  std::vector<std::size_t> shown;  // those of the scene, parents before their children
  Element scene;                   // absent if the document has none

  // The matrices of all nodes, from poses that may differ from their own. Nodes outside the scene's tree get the
  // matrices that their parents give them, too.
  std::vector<Matrix4> world_matrices(const std::vector<LocalPose>& poses) const;
  std::vector<LocalPose> poses() const;

 private:
  friend NodeTree read_nodes(Document& document);
  std::vector<std::size_t> ordered_;  // all nodes, parents first
};

// Reports children that are their own ancestors, or have two parents, as errors.
NodeTree read_nodes(Document& document);

}  // namespace montelux::gltf
