// A document's nodes at the moments of an animation.
#pragma once
#include <span>

#include "io/gltf/animations.h"
#include "io/read_result.h"

namespace montelux::gltf {

// Matrices and weights at each moment, evenly spaced from start to end. One moment: nothing moves.
struct Moments {
  double start = 0, end = 0;                              // s
  std::vector<std::vector<Matrix4>> world;                // of the nodes, by moment
  std::vector<std::vector<std::vector<double>>> weights;  // of the nodes' morph targets, by moment
  int frames_held = 1 << 30;                              // see SceneDesc

  std::size_t count() const { return world.size(); }
  bool moves(std::size_t node) const;
  bool morphs(std::size_t node) const;
};

// As many moments as the window asks for, and where the shutter is open as many between them as straight lines from one
// to the next need to follow what turns to 1.3e-5 of its distance from the axis, and places and weights to a thousandth
// of their way; 129 in all at most. Where these do not follow turns to 7.6e-5, or are too few for the frames, the scene
// holds fewer frames than were asked for, and where it does not even follow one, that is an error.
Moments moments_of(Document& document, const NodeTree& tree, const std::optional<Animation>& animation,
                   const AnimationWindow& window);

}  // namespace montelux::gltf
