// From a glTF document to a scene's description.
#pragma once
#include "geometry/bounds.h"
#include "io/gltf/deform.h"
#include "io/gltf/key_poses.h"
#include "io/gltf/materials.h"
#include "io/gltf/meshes.h"
#include "io/read_result.h"

namespace montelux::gltf {

class SceneBuilder {
 public:
  SceneBuilder(Document& document, const ReadOptions& options)
      : document_(document), options_(options), tree_(read_nodes(document)), materials_(document, scene_) {}

  // The scene is complete if no error was reported.
  SceneDesc build();

 private:
  // The transform of a node at the first time, and at later ones if it moves. Nothing if its scale is zero.
  struct Placing {
    Transform first;
    std::vector<Transform> later;
    bool mirrored = false;
  };

  void read_animation_and_time();
  void read_meshes();
  void place_meshes();
  void place_mesh(std::size_t node);
  void place_deforming(std::size_t node, const Primitive& primitive);
  std::optional<Placing> placing_of(std::size_t node);
  // `mirrored`: placed by maps that mirror.
  std::optional<ObjectDescId> object_of(std::size_t mesh, bool mirrored);
  ShapeDesc shape_of(const Primitive& primitive, bool mirrored);
  const Skin* skin_of(const Node& node, const Primitive& primitive);
  const std::vector<double>& weights_of(std::size_t node, std::size_t key);
  // Emitters must not move: an error, or with lenient reading they stay as they are at the first time.
  void report_moves(const Element& where, std::string_view what);
  void place_lights();
  void place_camera();
  bool shines(const Primitive& primitive) { return materials_.use(primitive.material).area_light.has_value(); }
  bool deforms(const Node& node, const Primitive& primitive) const {
    return (node.skin && primitive.skin) || !primitive.targets.empty();
  }

  Document& document_;
  const ReadOptions& options_;
  SceneDesc scene_;
  NodeTree tree_;
  KeyPoses key_poses_;
  MaterialReader materials_;
  std::map<std::size_t, MeshUse> meshes_;                                        // those that are shown
  std::map<std::size_t, std::size_t> times_used_;                                // how many nodes show a mesh
  std::map<std::pair<std::size_t, bool>, std::optional<ObjectDescId>> objects_;  // of meshes that are instanced
  std::map<std::size_t, std::optional<Skin>> skins_;
  Bounds3 bounds_;
};

}  // namespace montelux::gltf
