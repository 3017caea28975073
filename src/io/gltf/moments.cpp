#include "io/gltf/moments.h"

#include <algorithm>
#include <cmath>

#include "io/text_file.h"

namespace montelux::gltf {

namespace {

constexpr int most_steps = 128;  // of what moves, in the ray-tracing kernel
constexpr double aim = 1.3e-5, tolerance = 7.6e-5;

struct Pose {
  std::vector<Matrix4> world;
  std::vector<std::vector<double>> weights;
};

Pose pose_at(const NodeTree& tree, const std::optional<Animation>& animation, double time) {
  std::vector<LocalPose> poses = tree.poses();
  Pose pose;
  for (const Node& node : tree.nodes) pose.weights.push_back(node.weights);
  if (animation) animation->apply(time, poses, pose.weights);
  pose.world = tree.world_matrices(poses);
  return pose;
}

// How far the middle of the chord is from the map in the middle of its time: of the linear part against its own size.
double chord_error(const Matrix4& a, const Matrix4& middle, const Matrix4& b) {
  double size = 0, off = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      size = std::max(size, std::abs(middle.m[i][j]));
      off = std::max(off, std::abs(0.5 * (a.m[i][j] + b.m[i][j]) - middle.m[i][j]));
    }
  return size > 0 ? off / size : 0;
}

// The largest of these errors, and the node that has it.
struct Worst {
  double error = 0;
  std::size_t node = 0;
};

Worst worst_chord(const NodeTree& tree, const Moments& moments, const std::optional<Animation>& animation) {
  Worst worst;
  const double step = (moments.end - moments.start) / double(moments.count() - 1);
  for (std::size_t k = 0; k + 1 < moments.count(); ++k) {
    const Pose middle = pose_at(tree, animation, moments.start + (double(k) + 0.5) * step);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      const double error = chord_error(moments.world[k][i], middle.world[i], moments.world[k + 1][i]);
      if (error > worst.error) worst = {error, i};
    }
  }
  return worst;
}

void fill(Moments& moments, const NodeTree& tree, const std::optional<Animation>& animation, int steps) {
  moments.world.clear(), moments.weights.clear();
  for (int k = 0; k <= steps; ++k) {
    const double time = moments.start + (moments.end - moments.start) * k / steps;
    Pose pose = pose_at(tree, animation, time);
    moments.world.push_back(std::move(pose.world));
    moments.weights.push_back(std::move(pose.weights));
  }
}

}  // namespace

bool Moments::moves(std::size_t node) const {
  return std::any_of(world.begin(), world.end(), [&](const auto& w) { return !(w[node] == world.front()[node]); });
}
bool Moments::morphs(std::size_t node) const {
  return std::any_of(weights.begin(), weights.end(), [&](const auto& w) { return w[node] != weights.front()[node]; });
}

Moments moments_of(Document& document, const NodeTree& tree, const std::optional<Animation>& animation,
                   const AnimationWindow& window) {
  Moments moments{window.start, window.end, {}, {}};
  if (!animation || !(window.end > window.start)) {
    Pose pose = pose_at(tree, animation, window.start);
    moments.end = moments.start;
    moments.world.push_back(std::move(pose.world)), moments.weights.push_back(std::move(pose.weights));
    return moments;
  }
  const int intervals = std::max(window.intervals, 1);
  if (intervals > most_steps) {
    // The moments of the first frames; the rest is another scene.
    moments.end = window.start + (window.end - window.start) * most_steps / intervals;
    moments.frames_held = most_steps - 1;
    fill(moments, tree, animation, most_steps);
  } else {
    int between = 1;
    fill(moments, tree, animation, intervals);
    Worst worst = worst_chord(tree, moments, animation);
    while (window.open && worst.error > aim && 2 * between * intervals <= most_steps) {
      between *= 2;
      fill(moments, tree, animation, between * intervals);
      worst = worst_chord(tree, moments, animation);
    }
    if (!window.open || worst.error <= tolerance) return moments;
    // Errors go with the square of the step.
    const double needed = between * std::sqrt(worst.error / tolerance);
    const int fitting = int(double(most_steps) / needed);
    if (fitting >= 2 && intervals > 2)
      moments.frames_held = fitting - 1;
    else
      document.report().tolerable(
          document.whole(),
          "node " + std::to_string(worst.node) +
              (tree.nodes[worst.node].name.empty() ? std::string()
                                                   : " '" + printable(tree.nodes[worst.node].name) + "'") +
              " turns or jumps too fast for its way to be followed while the shutter is open",
          "a step of its way is off by " + std::to_string(worst.error) +
              " of the distance from its axis; a shorter exposure or more frames a second are followed");
  }
  return moments;
}

}  // namespace montelux::gltf
