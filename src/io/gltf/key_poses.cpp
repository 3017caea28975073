#include "io/gltf/key_poses.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "io/text_file.h"

namespace montelux::gltf {

namespace {

constexpr int max_steps = 128;  // per moving object, in the ray-tracing kernel
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

// The distance of the linear part from the chord between two maps, at `t`, relative to its own size.
double off_the_chord(const Matrix4& a, const Matrix4& b, double t, const Matrix4& there) {
  double size = 0, off = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      size = std::max(size, std::abs(there.m[i][j]));
      off = std::max(off, std::abs((1 - t) * a.m[i][j] + t * b.m[i][j] - there.m[i][j]));
    }
  return size > 0 ? off / size : 0;
}

// The error of approximating the motion between times by chords.
struct ChordErrors {
  std::vector<double> turns;  // of the linear parts, relative to their sizes, by chord
  std::size_t node = 0;       // the node with the largest of these
  double way = 0;             // of a position or of a morph target's weight, relative to its whole distance
};

std::string time_text(double seconds) {
  std::string text = std::to_string(seconds);
  return text.substr(0, text.find_last_not_of('0') + 2);
}

// The error of a path that is sampled between its times: the distance of samples from the chord over their distance
// from the start.
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

ChordErrors chord_errors(const NodeTree& tree, const KeyPoses& poses, const std::optional<Animation>& animation) {
  // With few steps, the motion may return to its chord within one.
  const std::size_t steps = poses.count() - 1, nodes = tree.nodes.size();
  const int parts = steps <= 16 ? 8 : 2;
  const double step = (poses.end - poses.start) / double(steps);
  ChordErrors errors{std::vector<double>(steps), 0, 0};
  double largest = 0;
  std::vector<WayError> ways(nodes), weights(nodes);
  for (std::size_t k = 0; k < steps; ++k)
    for (int part = 1; part <= parts; ++part) {
      const double t = double(part) / parts;  // the last one is the next key pose
      const Pose there = pose_at(tree, animation, poses.start + (double(k) + t) * step);
      for (std::size_t i = 0; i < nodes; ++i) {
        const Matrix4 &start = poses.world[0][i], &a = poses.world[k][i], &b = poses.world[k + 1][i];
        const double turn = off_the_chord(a, b, t, there.world[i]);
        errors.turns[k] = std::max(errors.turns[k], turn);
        if (turn > largest) largest = turn, errors.node = i;
        for (std::size_t j = 0; j < 3; ++j)
          ways[i].add_sample(std::abs(place_of(there.world[i], j) - place_of(start, j)),
                             off_between(place_of(a, j), place_of(b, j), t, place_of(there.world[i], j)));
        const auto &w = there.weights[i], &first = poses.weights[0][i], &before = poses.weights[k][i],
                   &after = poses.weights[k + 1][i];
        for (std::size_t j = 0; j < w.size(); ++j)
          weights[i].add_sample(std::abs(w[j] - first[j]), off_between(before[j], after[j], t, w[j]));
      }
    }
  for (std::size_t i = 0; i < nodes; ++i)
    errors.way = std::max({errors.way, ways[i].relative(), weights[i].relative()});
  return errors;
}

void fill(KeyPoses& poses, const NodeTree& tree, const std::optional<Animation>& animation, int steps) {
  poses.world.clear(), poses.weights.clear();
  for (int k = 0; k <= steps; ++k) {
    const double time = poses.start + (poses.end - poses.start) * k / steps;
    Pose pose = pose_at(tree, animation, time);
    poses.world.push_back(std::move(pose.world));
    poses.weights.push_back(std::move(pose.weights));
  }
}

// The largest turn in each of n intervals with the same number of chords; 0 for those that were given up.
std::vector<double> largest_turns(const ChordErrors& errors, std::size_t n, const std::vector<bool>& is_given_up) {
  std::vector<double> largest(n, 0.0);
  for (std::size_t k = 0; k < errors.turns.size(); ++k) {
    const std::size_t i = k * n / errors.turns.size();
    if (!is_given_up[i]) largest[i] = std::max(largest[i], errors.turns[k]);
  }
  return largest;
}

// Reports the intervals between times that not even this many chords approximate.
std::vector<bool> too_fast(Document& document, const NodeTree& tree, const std::optional<Animation>& animation,
                           const KeyPoses& poses, const ChordErrors& errors, int max_chords) {
  std::vector<bool> result(errors.turns.size(), false);
  const double step = (poses.end - poses.start) / double(errors.turns.size());
  bool is_reported = false;
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (errors.turns[k] <= tolerance) continue;
    KeyPoses fine{poses.start + double(k) * step, poses.start + double(k + 1) * step, {}, {}};
    fill(fine, tree, animation, max_chords);
    const ChordErrors off = chord_errors(tree, fine, animation);
    const double turn = std::ranges::max(off.turns);
    result[k] = turn > tolerance;
    if (!result[k] || std::exchange(is_reported, true)) continue;
    const std::string& name = tree.nodes[off.node].name;
    document.report().tolerable(document.whole(),
                                "node " + std::to_string(off.node) +
                                    (name.empty() ? std::string() : " '" + printable(name) + "'") +
                                    " rotates or jumps too fast to be followed while the shutter is open, at " +
                                    time_text(fine.start) + " to " + time_text(fine.end) + " s",
                                "a step of its motion has an error of " + std::to_string(turn) +
                                    " of the distance from its axis; use a shorter exposure or more frames per second");
  }
  return result;
}

// The maximum number of intervals from the first on, fewer than all and at least `least`, that can be approximated,
// given the errors of this many chords. Errors are proportional to the square of the step.
int longest_part(const std::vector<double>& turns, int chords, int min_steps) {
  double needed = 1;
  int longest = min_steps;
  for (int n = 1; n < int(turns.size()); ++n) {
    needed = std::max(needed, chords * std::sqrt(turns[std::size_t(n - 1)] / tolerance));
    if (std::bit_floor(unsigned(max_steps / n)) >= needed) longest = std::max(longest, n);
  }
  return longest;
}

}  // namespace

bool KeyPoses::moves(std::size_t node) const {
  return std::any_of(world.begin(), world.end(), [&](const auto& w) { return !(w[node] == world.front()[node]); });
}
bool KeyPoses::morphs(std::size_t node) const {
  return std::any_of(weights.begin(), weights.end(), [&](const auto& w) { return w[node] != weights.front()[node]; });
}

KeyPoses key_poses_of(Document& document, const NodeTree& tree, const std::optional<Animation>& animation,
                      const AnimationWindow& window) {
  KeyPoses poses{window.start, window.end, {}, {}};
  if (!animation || !(window.end > window.start)) {
    Pose pose = pose_at(tree, animation, window.start);
    poses.end = poses.start;
    poses.world.push_back(std::move(pose.world)), poses.weights.push_back(std::move(pose.weights));
    return poses;
  }
  const int intervals = std::max(window.intervals, 1);
  const double exposure = std::clamp(window.exposure, 0.0, 1e6);
  // The first n intervals, with equal numbers of chords.
  const auto take = [&](int n, int chords) {
    poses.end = window.start + (window.end - window.start) * n / intervals;
    poses.frames_held = n < intervals ? std::max(1, int(n - std::max(exposure, 1.0) + 1e-9)) : 1 << 30;
    fill(poses, tree, animation, n * chords);
  };
  const int step_limit = std::min(intervals, max_steps);
  if (!window.open) {
    take(step_limit, 1);
    return poses;
  }
  // The times of the first frames, if all are too many; the rest becomes another scene. The minimum is one frame.
  const int min_steps = std::min(step_limit, 1 + int(std::ceil(exposure - 1e-9)));
  if (intervals > max_steps && exposure + 1 > max_steps)
    document.report().tolerable(document.whole(),
                                "the shutter is open over more than " + std::to_string(max_steps - 1) + " frames",
                                "use a shorter exposure, or fewer frames per second");
  std::vector<bool> is_given_up;
  for (int n = step_limit;;) {
    int chords = 1;
    take(n, chords);
    ChordErrors errors = chord_errors(tree, poses, animation);
    if (is_given_up.empty()) is_given_up = too_fast(document, tree, animation, poses, errors, max_steps / min_steps);
    const auto turns = [&] { return largest_turns(errors, std::size_t(n), is_given_up); };
    const auto is_rough = [&] { return std::ranges::max(turns()) > aim || errors.way > aim_of_ways; };
    while (2 * chords * n <= max_steps && is_rough()) {
      chords *= 2;
      take(n, chords);
      errors = chord_errors(tree, poses, animation);
    }
    const std::vector<double> all = turns();
    if (std::ranges::max(all) <= tolerance || n <= min_steps) return poses;
    n = longest_part(all, chords, min_steps);
  }
}

}  // namespace montelux::gltf
