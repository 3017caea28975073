#include "io/gltf/animations.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "io/gltf/choice.h"

namespace montelux::gltf {

namespace {

constexpr std::array<std::size_t, 3> fixed_widths{3, 4, 3};

void normalize(std::vector<double>& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (length > 1e-12)
    for (double& x : q) x /= length;
  else
    q = {0, 0, 0, 1};
}

// Interpolates along the shorter arc at constant speed (Shoemake 1985).
std::vector<double> slerp(std::vector<double> a, std::vector<double> b, double t) {
  normalize(a), normalize(b);
  double cosine = 0;
  for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
  const double sign = cosine < 0 ? -1 : 1, angle = std::acos(std::min(std::abs(cosine), 1.0)), sine = std::sin(angle);
  const bool is_near = sine < 1e-9;
  const double first = is_near ? 1 - t : std::sin((1 - t) * angle) / sine;
  const double second = sign * (is_near ? t : std::sin(t * angle) / sine);
  for (std::size_t i = 0; i < 4; ++i) a[i] = first * a[i] + second * b[i];
  normalize(a);
  return a;
}

// The keys of a sampler; nothing if they are wrong.
std::optional<std::vector<double>> read_times(Document& document, const Element& input) {
  const auto numbers = read_accessor(document, input, {{"SCALAR"}});
  if (!numbers) return std::nullopt;
  std::vector<double> times(numbers->values.begin(), numbers->values.end());
  if (times.empty()) {
    input.error("has no keys");
    return std::nullopt;
  }
  for (std::size_t i = 0; i < times.size(); ++i)
    if (times[i] < 0 || (i > 0 && !(times[i] > times[i - 1]))) {
      input.error("the times of keys must not be negative, and must increase: key " + std::to_string(i) + " is at " +
                  std::to_string(times[i]) + " s" +
                  (i > 0 ? ", the previous one at " + std::to_string(times[i - 1]) + " s" : ""));
      return std::nullopt;
    }
  return times;
}

// The morph targets of the mesh that a node places.
std::size_t targets_of(Document& document, std::size_t node) {
  const Element meshes = document.list("meshes");
  const auto mesh = document.list("nodes")[node]["mesh"].index_of(meshes, "a mesh");
  return mesh ? meshes[*mesh]["primitives"][std::size_t{0}]["targets"].size() : 0;
}

// The first key whose quaternion is zero.
std::optional<std::size_t> zero_rotation(const Numbers& values, bool is_cubic) {
  const std::size_t parts = is_cubic ? 3 : 1;
  for (std::size_t key = 0; key * parts < values.count; ++key) {
    const float* q = values.at(key * parts + (is_cubic ? 1 : 0));
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) return key;
  }
  return std::nullopt;
}

std::optional<Track> read_track(Document& document, const NodeTree& tree, const Element& channel,
                                const Element& samplers) {
  const Element target = channel.required("target");
  const auto path = target.required("path").choice({"translation", "rotation", "scale", "weights"});
  const auto sampler_number = channel.required("sampler").index_of(samplers, "a sampler of this animation");
  const auto node = target["node"].index_of(document.list("nodes"), "a node");
  if (!path || !sampler_number || !node) return std::nullopt;
  const Element sampler = samplers[*sampler_number];
  const auto kind = sampler["interpolation"].choice({"LINEAR", "STEP", "CUBICSPLINE"}).value_or("LINEAR");
  auto times = read_times(document, sampler.required("input"));
  Track track{*node, AnimatedPath::weights, Interpolation::linear, {}, 0, {}};
  if (kind != "LINEAR") track.interpolation = kind == "STEP" ? Interpolation::step : Interpolation::cubic;
  std::string_view shape = "SCALAR";
  if (*path == "translation") track.path = AnimatedPath::translation, shape = "VEC3";
  if (*path == "rotation") track.path = AnimatedPath::rotation, shape = "VEC4";
  if (*path == "scale") track.path = AnimatedPath::scale, shape = "VEC3";
  const auto values = read_accessor(document, sampler.required("output"), {{shape}});
  if (!times || !values) return std::nullopt;
  const std::size_t keys = times->size() * (track.interpolation == Interpolation::cubic ? 3 : 1);
  const bool is_free = track.path == AnimatedPath::weights;
  if (is_free ? values->count == 0 || values->count % keys != 0 : values->count != keys) {
    sampler["output"].error("has " + std::to_string(values->count) + " values for " + std::to_string(times->size()) +
                            " keys" + (track.interpolation == Interpolation::cubic ? ", which need three each" : ""));
    return std::nullopt;
  }
  if (!is_free && tree.nodes[*node].pose.fixed) {
    target["node"].error("node " + std::to_string(*node) + " has a matrix, which cannot be animated");
    return std::nullopt;
  }
  track.width = is_free ? values->count / keys : fixed_widths[std::size_t(track.path)];
  if (is_free && track.width != targets_of(document, *node)) {
    sampler["output"].error("has " + std::to_string(track.width) + " weights for each key; the mesh of node " +
                            std::to_string(*node) + " has " + std::to_string(targets_of(document, *node)) +
                            " morph targets");
    return std::nullopt;
  }
  if (track.path == AnimatedPath::rotation)
    if (const auto zero = zero_rotation(*values, track.interpolation == Interpolation::cubic)) {
      sampler["output"].error("the rotation of key " + std::to_string(*zero) + " has length zero");
      return std::nullopt;
    }
  track.times = *std::move(times);
  track.values = values->values;
  return track;
}

}  // namespace

std::vector<double> Track::at(double time) const {
  const bool is_cubic = interpolation == Interpolation::cubic;
  // Part 0 of a cubic key is its in-tangent, 1 its value, 2 its out-tangent.
  const auto part = [&](std::size_t key, std::size_t which) {
    const auto first = values.begin() + std::ptrdiff_t((is_cubic ? 3 * key + which : key) * width);
    return std::vector<double>(first, first + std::ptrdiff_t(width));
  };
  const auto unit = [&](std::vector<double> v) {
    if (path == AnimatedPath::rotation) normalize(v);
    return v;
  };
  if (!(time > times.front())) return unit(part(0, 1));
  if (time >= times.back()) return unit(part(times.size() - 1, 1));
  const std::size_t next = std::size_t(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  const std::size_t last = next - 1;
  if (interpolation == Interpolation::step) return unit(part(last, 1));
  const double length = times[next] - times[last], t = (time - times[last]) / length;
  std::vector<double> a = part(last, 1), b = part(next, 1);
  if (!is_cubic) {
    if (path == AnimatedPath::rotation) return slerp(std::move(a), std::move(b), t);
    for (std::size_t i = 0; i < width; ++i) a[i] = a[i] * (1 - t) + b[i] * t;
    return a;
  }
  const std::vector<double> out = part(last, 2), in = part(next, 0);
  const double t2 = t * t, t3 = t2 * t;
  for (std::size_t i = 0; i < width; ++i)
    a[i] = (2 * t3 - 3 * t2 + 1) * a[i] + length * (t3 - 2 * t2 + t) * out[i] + (3 * t2 - 2 * t3) * b[i] +
           length * (t3 - t2) * in[i];
  return unit(std::move(a));
}

void Animation::apply(double time, std::vector<LocalPose>& poses, std::vector<std::vector<double>>& weights) const {
  // A scale of zero is replaced by a small one, so that the map can be inverted.
  constexpr double min_scale = 1e-6;
  for (const Track& track : tracks) {
    const std::vector<double> value = track.at(time);
    LocalPose& pose = poses[track.node];
    if (track.path == AnimatedPath::translation)
      std::copy_n(value.begin(), 3, pose.translation.begin());
    else if (track.path == AnimatedPath::rotation)
      std::copy_n(value.begin(), 4, pose.rotation.begin());
    else if (track.path == AnimatedPath::scale)
      for (std::size_t i = 0; i < 3; ++i)
        pose.scale[i] = std::abs(value[i]) < min_scale ? std::copysign(min_scale, value[i]) : value[i];
    else
      weights[track.node] = value;
  }
}

std::optional<Animation> read_animation(Document& document, const NodeTree& tree,
                                        const std::optional<std::string>& choice) {
  const Element list = document.list("animations");
  std::optional<std::size_t> number;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    names.push_back(list[i]["name"].text().value_or(""));
    if (choice && !number && names.back() == *choice) number = i;
  }
  if (choice && !number)
    if (const auto n = as_number(*choice); n && *n < list.size()) number = *n;
  if (choice && !number) {
    report_no_such(document, "animation", *choice, list.size(), names);
    return std::nullopt;
  }
  if (list.size() == 0) return std::nullopt;
  if (!number && list.size() > 1)
    document.report().note(document.whole(),
                           "the file has " + std::to_string(list.size()) + " animations; the first one is used" +
                               (names[0].empty() ? std::string() : ", '" + printable(names[0]) + "'"));
  const Element element = list[number.value_or(0)], channels = element.required("channels");
  const Element samplers = element.required("samplers");
  Animation animation;
  std::set<std::pair<std::size_t, AnimatedPath>> seen;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    std::optional<Track> track = read_track(document, tree, channels[i], samplers);
    if (!track) continue;
    if (!seen.insert({track->node, track->path}).second) {
      channels[i].error("another channel of the animation has the same target");
      continue;
    }
    animation.end = std::max(animation.end, track->times.back());
    animation.tracks.push_back(*std::move(track));
  }
  return animation;
}

}  // namespace montelux::gltf
