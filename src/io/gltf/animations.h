// Animations of a glTF document.
#pragma once
#include "io/gltf/accessors.h"
#include "io/gltf/nodes.h"

namespace montelux::gltf {

enum class Interpolation { step, linear, cubic };
enum class AnimatedPath { translation, rotation, scale, weights };

// Values over time. For a cubic spline each key has an in-tangent, a value and an out-tangent.
struct Track {
  std::size_t node = 0;
  AnimatedPath path = AnimatedPath::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  // s, increasing
  std::size_t width = 0;      // numbers per value
  std::vector<float> values;  // of all keys

  // The value at a time; clamped to the first and the last key (glTF 2.0, appendix C). Rotations are unit.
  std::vector<double> at(double time) const;
};

struct Animation {
  std::vector<Track> tracks;
  double end = 0;  // time of its last key, s

  // Overwrites what is animated. `weights` are those of each node's morph targets.
  void apply(double time, std::vector<LocalPose>& poses, std::vector<std::vector<double>>& weights) const;
};

// The animation with that name or number, or the first; if there are several, a note says which one. Nothing if the
// document has none; an invalid choice is an error.
std::optional<Animation> read_animation(Document& document, const NodeTree& tree,
                                        const std::optional<std::string>& choice);

}  // namespace montelux::gltf
