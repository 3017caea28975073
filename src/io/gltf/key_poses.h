// The nodes of a document at the times of an animation.
#pragma once
#include <span>

#include "io/gltf/animations.h"
#include "io/read_result.h"

namespace montelux::gltf {

// Matrices and weights at times evenly spaced from start to end. Only one time: nothing moves.
struct KeyPoses {
  double start = 0, end = 0;                              // s
  std::vector<std::vector<Matrix4>> world;                // of the nodes, by time
  std::vector<std::vector<std::vector<double>>> weights;  // of the nodes' morph targets, by time
  int frames_held = 1 << 30;                              // see SceneDesc

  std::size_t count() const { return world.size(); }
  bool moves(std::size_t node) const;
  bool morphs(std::size_t node) const;
};

// The times that the window needs and, if the shutter is open, as many times in between as linear interpolation needs
// to approximate rotations to 1.3e-5 of the distance from the axis, and positions and weights to a thousandth of their
// path; at most 129 in all. If these do not approximate rotations to 7.6e-5, or are too few for the frames, the scene
// contains fewer frames than requested; if not even one is possible, that is an error.
KeyPoses key_poses_of(Document& document, const NodeTree& tree, const std::optional<Animation>& animation,
                      const AnimationWindow& window);

}  // namespace montelux::gltf
