#include "io/gltf/moments.h"

#include <algorithm>
#include <cmath>

#include "io/text_file.h"

namespace montelux::gltf {

namespace {

constexpr int most_steps = 128;  // of what moves, in the ray-tracing kernel
constexpr double aim = 1.3e-5, tolerance = 7.6e-5, aim_of_ways = 1e-3;

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

// Of the linear part, against its own size: how far it is from the chord between two maps, of which it is at `t`.
double off_the_chord(const Matrix4& a, const Matrix4& b, double t, const Matrix4& there) {
  double size = 0, off = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      size = std::max(size, std::abs(there.m[i][j]));
      off = std::max(off, std::abs((1 - t) * a.m[i][j] + t * b.m[i][j] - there.m[i][j]));
    }
  return size > 0 ? off / size : 0;
}

// What chords leave out of the motion between moments.
struct Worst {
  double turn = 0;       // of a linear part, against its size,
  std::size_t node = 0;  // and the node that has it
  double way = 0;        // of a place or of a morph target's weight, against all of its way
};

// Of a way that is sampled between its moments: how far samples are from the chord, over how far they are from the
// start.
class WayError {
 public:
  void add_sample(double from_start, double off) {
    extent_ = std::max(extent_, from_start), off_ = std::max(off_, off);
  }
  double relative() const { return extent_ > 1e-12 ? off_ / extent_ : 0; }

 private:
  double extent_ = 0, off_ = 0;
};

double place_of(const Matrix4& m, std::size_t i) { return m.m[i][3]; }
double off_between(double a, double b, double t, double there) { return std::abs((1 - t) * a + t * b - there); }

Worst worst_chord(const NodeTree& tree, const Moments& moments, const std::optional<Animation>& animation) {
  // Where steps are few, motion may come back to its chord within one.
  const std::size_t steps = moments.count() - 1;
  const int parts = steps <= 16 ? 8 : 2;
  const double step = (moments.end - moments.start) / double(steps);
  const std::size_t nodes = tree.nodes.size();
  Worst worst;
  std::vector<WayError> ways(nodes), weights(nodes);
  for (std::size_t k = 0; k < steps; ++k)
    for (int part = 1; part <= parts; ++part) {
      const double t = double(part) / parts;  // the last one is the next moment
      const Pose there = pose_at(tree, animation, moments.start + (double(k) + t) * step);
      for (std::size_t i = 0; i < nodes; ++i) {
        const Matrix4 &start = moments.world[0][i], &a = moments.world[k][i], &b = moments.world[k + 1][i];
        const double turn = off_the_chord(a, b, t, there.world[i]);
        if (turn > worst.turn) worst.turn = turn, worst.node = i;
        for (std::size_t j = 0; j < 3; ++j)
          ways[i].add_sample(std::abs(place_of(there.world[i], j) - place_of(start, j)),
                             off_between(place_of(a, j), place_of(b, j), t, place_of(there.world[i], j)));
        const auto &w = there.weights[i], &first = moments.weights[0][i], &before = moments.weights[k][i],
                   &after = moments.weights[k + 1][i];
        for (std::size_t j = 0; j < w.size(); ++j)
          weights[i].add_sample(std::abs(w[j] - first[j]), off_between(before[j], after[j], t, w[j]));
      }
    }
  for (std::size_t i = 0; i < nodes; ++i) worst.way = std::max({worst.way, ways[i].relative(), weights[i].relative()});
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
  // The first n intervals, with as many chords each.
  const auto take = [&](int n, int chords) {
    moments.end = window.start + (window.end - window.start) * n / intervals;
    moments.frames_held = n < intervals ? std::max(1, int(n - std::max(window.exposure, 1.0))) : 1 << 30;
    fill(moments, tree, animation, n * chords);
  };
  const int most = std::min(intervals, most_steps);
  if (!window.open) {
    take(most, 1);
    return moments;
  }
  // The moments of the first frames, if all are too many; the rest is another scene. One frame is the least.
  const int least = std::min(most, 2 + int(std::ceil(window.exposure)));
  if (intervals > most_steps && window.exposure + 2 > most_steps)
    document.report().tolerable(document.whole(),
                                "the shutter is open over " + std::to_string(int(window.exposure)) +
                                    " frames, and no more than " + std::to_string(most_steps - 2) + " can be held",
                                "a shorter exposure, or fewer frames a second");
  Worst worst;
  for (int n = most;;) {
    int chords = 1;
    take(n, chords);
    worst = worst_chord(tree, moments, animation);
    while ((worst.turn > aim || worst.way > aim_of_ways) && 2 * chords * n <= most_steps) {
      chords *= 2;
      take(n, chords);
      worst = worst_chord(tree, moments, animation);
    }
    if (worst.turn <= tolerance) return moments;
    if (n <= least) break;
    // Errors go with the square of the step.
    const double needed = std::exp2(std::ceil(std::log2(chords * std::sqrt(worst.turn / tolerance))));
    n = std::clamp(int(most_steps / needed), least, n - 1);
  }
  document.report().tolerable(
      document.whole(),
      "node " + std::to_string(worst.node) +
          (tree.nodes[worst.node].name.empty() ? std::string() : " '" + printable(tree.nodes[worst.node].name) + "'") +
          " turns or jumps too fast for its way to be followed while the shutter is open",
      "a step of its way is off by " + std::to_string(worst.turn) +
          " of the distance from its axis; a shorter exposure or more frames a second are followed");
  return moments;
}

}  // namespace montelux::gltf
