// A hierarchy over the lights with a position: selects the light to sample at a point, by bounds of what each cluster
// of lights can send there (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting"; importance as in Pharr, Jakob and Humphreys 2023, sec. 12.6.3).
#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "light/light.h"
#include "math/row_gather.h"

namespace montelux {

namespace light_bvh {

// Angles are subtracted by a bound without square roots: cos(max(0, a - b)) <= min(1, cos a + sin b), which is close.
// Rounding must not turn a small importance into zero, so cosines near zero are increased by this much.
inline constexpr float slack = 1e-3f;
// The minimum probability of a child that is not dark: negligible in cost, yet a turn leaves half of the 24 bits of u.
inline constexpr float min_share = 0x1p-12f;

}  // namespace light_bvh

// The position, orientation and strength of a light.
struct LightBounds {
  Vec3f low{}, high{};     // box of its points
  Vec3f axis{0, 0, 1};     // unit: the middle of its normals
  float intensity = 0;     // largest radiant intensity, averaged over the components, W / sr
  float cos_spread = -1;   // cosine of the largest angle between the axis and a normal
  float cos_emission = 0;  // cosine of the largest angle between a normal and a direction of emission
  bool two_sided = false;  // emits the same in opposite directions
};

// Factors of the importances of clusters, by number: those of one place in every lane.
template <class F>
struct ClusterFactors {
  const float* values;
  Uint<F> first;     // of the place
  Uint<F> of_whole;  // that of the whole hierarchy; the next ones are those of lights without a place
};
// Every factor is 1.
struct NoFactors {};

// The bounds of both.
LightBounds unite(const LightBounds& a, const LightBounds& b);

class LightBvh {
 public:
  // Over all lights by number; those without bounds are omitted. O(n log n).
  explicit LightBvh(std::span<const std::optional<LightBounds>> bounds);
  LightBvh() = default;

  bool empty() const { return nodes_.empty(); }

  // Selects one light for the point p, by u in [0, 1). n is unit if only directions on its side matter, else zero.
  // Every light that reaches p on that side has a positive probability.
  // `factors`: NoFactors, or ClusterFactors<F> of p.
  template <class F, class Factors = NoFactors>
  LightChoice<F> choose(Vec3<F> p, Vec3<F> n, F u, Mask<F> on, const Factors& factors = {}) const;

  // The probability with which choose() selects the light at p, bit for bit. Only for lights with bounds.
  template <class F, class Factors = NoFactors>
  Mass<F> mass(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on, const Factors& factors = {}) const;

  // A rough estimate of the irradiance from all its lights at p on that side, averaged over the components; 0 only if
  // none of them reaches p. Only if there is a light.
  template <class F>
  F irradiance(Vec3<F> p, Vec3<F> n) const {
    return importance<F>(row_in_all_lanes<F>(nodes_.data()->v, 0), p, n);
  }

  // The upper nodes of the tree have numbers, by which ClusterFactors knows them; the root and nodes further down have
  // the number 0. By number, that of the first of two children, whose numbers are consecutive and greater; 0: there
  // are none, and the node is a cluster, which is not divided.
  std::span<const std::uint32_t> cluster_links() const { return cluster_links_; }

  // What learning needs to know of the choice of a light at p.
  struct Descent {
    std::uint32_t cluster;  // the number of the one that has the light
    float importance;       // of that cluster
    float mass;             // with which the light is selected where the cluster is given
  };
  // Calls visit(number, first, second) for each numbered node on the way down to the cluster, the root included, with
  // the importances of its children over its own.
  template <class Visit>
  Descent descend(LightId light, Vec3f p, Vec3f n, Visit visit) const;

 private:
  struct alignas(64) Node {
    float v[words_of_row] = {};
  };
  // Slots of a node. The intensity is negative if the lights emit both ways. The link (bits) is the first of two
  // consecutive children, or the light of a leaf, which the top bit marks.
  enum Slot {
    centre = 0,
    radius = 3,
    axis = 4,
    intensity = 7,
    spread,  // the sine of the largest angle between the axis and a normal; 2 if that exceeds a right angle
    cos_emission,
    link,
    inverse_radius_squared,
    number  // (bits) among clusters
  };
  static constexpr std::uint32_t leaf_bit = 0x80000000u;

  struct Item {
    std::uint32_t light;
    Vec3f middle, axis;
  };
  struct Builder;

  // A node in every lane, by its slots.
  template <class F>
  using NodeOf = std::array<F, words_of_row>;
  template <class F>
  MONTELUX_INLINE NodeOf<F> node_of(Uint<F> node) const {
    return gather_rows<F>(nodes_.data()->v, node);
  }
  template <class F>
  static MONTELUX_INLINE Mask<F> is_inner(Uint<F> link_bits) {
    return (link_bits & Uint<F>(leaf_bit)) == Uint<F>(0u);
  }
  template <class F>
  static F importance(const NodeOf<F>& node, Vec3<F> p, Vec3<F> n);
  template <class F>
  static MONTELUX_INLINE F importance(const NodeOf<F>& node, Vec3<F> p, Vec3<F> n, const NoFactors&) {
    return importance<F>(node, p, n);
  }
  template <class F>
  static MONTELUX_INLINE F importance(const NodeOf<F>& node, Vec3<F> p, Vec3<F> n, const ClusterFactors<F>& factors) {
    return importance<F>(node, p, n) * gather(factors.values, Uint<F>(factors.first + float_bits(node[number])));
  }
  // Sets of few lights are scanned instead of descended: the choice is then exactly proportional to each light's
  // importance.
  static constexpr std::size_t max_scanned = 16;
  bool is_scanned() const { return leaves_.size() <= max_scanned; }
  // The importances of all leaves, summed in their order.
  template <class F>
  struct Scan {
    F importance[max_scanned];
    F sum;
  };
  template <class F, class Factors>
  MONTELUX_INLINE Scan<F> scan(Vec3<F> p, Vec3<F> n, const Factors& factors) const {
    Scan<F> s;
    s.sum = F(0.0f);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      s.importance[i] = importance<F>(row_in_all_lanes<F>(nodes_.data()->v, leaves_[i]), p, n, factors);
      s.sum = s.sum + s.importance[i];
    }
    return s;
  }
  template <class F, class Factors>
  LightChoice<F> choose_by_scan(Vec3<F> p, Vec3<F> n, F u, Mask<F> on, const Factors& factors) const;
  void number_clusters();
  // The probability of the first of two children, whether either can emit light to p, and the links of both.
  template <class F>
  struct Fork {
    F first;
    Mask<F> any_light;
    Uint<F> link_of_first, link_of_second;
  };
  template <class F, class Factors>
  MONTELUX_INLINE Fork<F> fork(Uint<F> first_child, Vec3<F> p, Vec3<F> n, const Factors& factors) const {
    const NodeOf<F> one = node_of<F>(first_child), other = node_of<F>(Uint<F>(first_child + Uint<F>(1u)));
    F a = importance<F>(one, p, n, factors);
    F b = importance<F>(other, p, n, factors);
    F sum = a + b, first = a / max(sum, F(1e-37f));
    // A child that can send light keeps a share that u can hit, however large the other's importance is.
    first = select(b > F(0.0f), min(first, F(1.0f - light_bvh::min_share)), first);
    first = select(a > F(0.0f), max(first, F(light_bvh::min_share)), first);
    return {first, sum > F(0.0f), float_bits(one[link]), float_bits(other[link])};
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> turns_;   // by light: bit k is the turn at depth k
  std::vector<std::uint32_t> leaves_;  // nodes that are leaves, in the order of the tree
  std::vector<std::uint32_t> places_;  // by light: its index among the leaves
  std::vector<std::uint32_t> cluster_links_;
};

template <class F>
F LightBvh::importance(const NodeOf<F>& node, Vec3<F> p, Vec3<F> n) {
  using namespace light_bvh;
  const F one(1.0f);
  const Vec3<F> from = p - Vec3<F>{node[centre], node[centre + 1], node[centre + 2]};
  const F inverse_d = one / sqrt(max(length_squared(from), F(1e-30f)));
  const Vec3<F> w = from * inverse_d;

  // The angular radius of the bounding ball; from inside, all directions.
  const F sin_b = node[radius] * inverse_d;
  const Mask<F> inside = sin_b >= one;

  // The smallest angle between a normal of the cluster and a direction to p.
  const Vec3<F> a{node[axis], node[axis + 1], node[axis + 2]};
  const F strength = node[intensity], along = dot(a, w);
  const F cos_w = select(strength < F(0.0f), abs(along), along);
  const F cos_p = select(inside, one, min(cos_w + node[spread] + sin_b, one));
  const F near = min(inverse_d * inverse_d, node[inverse_radius_squared]);
  F result = abs(strength) * max(cos_p, F(slack)) * near;
  result = select(cos_p > node[cos_emission] - slack, result, F(0.0f));

  // The smallest angle between n and a direction to the cluster.
  const F cos_q = select(inside, one, min(sin_b - dot(n, w), one));
  const F facing = select(cos_q > F(-slack), max(cos_q, F(slack)), F(0.0f));
  return result * select(length_squared(n) > F(0.5f), facing, one);
}

template <class F, class Factors>
LightChoice<F> LightBvh::choose_by_scan(Vec3<F> p, Vec3<F> n, F u, Mask<F> on, const Factors& factors) const {
  const Scan<F> s = scan<F>(p, n, factors);
  const F target = u * s.sum;
  // The first light at which the running sum exceeds the target; if rounding prevents that, the last valid one.
  F running(0.0f), chosen(0.0f);
  Uint<F> light(0u);
  Mask<F> open = on & (s.sum > F(0.0f));
  const Mask<F> valid = open;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    running = running + s.importance[i];
    const Mask<F> takes = open & (s.importance[i] > F(0.0f));
    chosen = select(takes, s.importance[i], chosen);
    light = select(takes, Uint<F>(float_bits(nodes_[leaves_[i]].v[link]) & ~leaf_bit), light);
    open = open & !Mask<F>(running > target);
  }
  return {light, {select(valid, chosen / max(s.sum, F(1e-37f)), F(0.0f))}, valid};
}

template <class F, class Factors>
LightChoice<F> LightBvh::choose(Vec3<F> p, Vec3<F> n, F u, Mask<F> on, const Factors& factors) const {
  if (is_scanned()) return choose_by_scan<F>(p, n, u, on, factors);
  F mass(1.0f);
  Mask<F> valid = on & Mask<F>(!nodes_.empty());
  if (!any(valid)) return {Uint<F>(0u), {F(0.0f)}, valid};
  Uint<F> below(float_bits(nodes_.front().v[link]));
  Mask<F> inner = valid & is_inner<F>(below);
  while (any(inner)) {
    Uint<F> child = select(inner, below, Uint<F>(0u));
    Fork<F> f = fork<F>(child, p, n, factors);
    // The rescaled remainder of u decides further down.
    Mask<F> first = u < f.first;
    F share = select(first, f.first, F(1.0f) - f.first);
    F rest = min(select(first, u, u - f.first) / max(share, F(1e-37f)), F(one_minus_epsilon));
    u = select(inner, rest, u);
    mass = select(inner, mass * share, mass);
    below = select(inner, select(first, f.link_of_first, f.link_of_second), below);
    valid = valid & (f.any_light | !inner);
    inner = inner & f.any_light & is_inner<F>(below);
  }
  const Uint<F> light = select(valid, Uint<F>(below & Uint<F>(~leaf_bit)), Uint<F>(0u));
  return {light, {select(valid, mass, F(0.0f))}, valid};
}

template <class F, class Factors>
Mass<F> LightBvh::mass(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on, const Factors& factors) const {
  if (!any(on) || nodes_.empty()) return {F(0.0f)};
  if (is_scanned()) {
    const Scan<F> all = scan<F>(p, n, factors);
    const Uint<F> place = gather(places_.data(), select(on, light, Uint<F>(0u)));
    F own(0.0f);
    for (std::size_t i = 0; i < leaves_.size(); ++i)
      own = select(place == Uint<F>(std::uint32_t(i)), all.importance[i], own);
    return {select(on & (all.sum > F(0.0f)), own / max(all.sum, F(1e-37f)), F(0.0f))};
  }
  Uint<F> below(float_bits(nodes_.front().v[link])), turns = gather(turns_.data(), select(on, light, Uint<F>(0u)));
  F mass(1.0f);
  Mask<F> inner = on & is_inner<F>(below);
  while (any(inner)) {
    Uint<F> child = select(inner, below, Uint<F>(0u));
    Fork<F> f = fork<F>(child, p, n, factors);
    const Mask<F> first = (turns & Uint<F>(1u)) == Uint<F>(0u);
    F share = select(first, f.first, F(1.0f) - f.first);
    share = select(f.any_light, share, F(0.0f));
    mass = select(inner, mass * share, mass);
    below = select(inner, select(first, f.link_of_first, f.link_of_second), below);
    turns = select(inner, Uint<F>(turns >> 1), turns);
    inner = inner & is_inner<F>(below);
  }
  return {select(on, mass, F(0.0f))};
}

template <class Visit>
LightBvh::Descent LightBvh::descend(LightId light, Vec3f p, Vec3f n, Visit visit) const {
  const auto node_at = [&](std::uint32_t node) { return node_of<float>(node); };
  const auto is_leaf = [](const NodeOf<float>& node) { return !is_inner<float>(float_bits(node[link])); };
  NodeOf<float> node = node_at(is_scanned() ? leaves_[places_[std::uint32_t(light)]] : 0u);
  std::uint32_t turns = turns_[std::uint32_t(light)];
  float of_node = importance<float>(node, p, n);
  while (!is_leaf(node) && cluster_links_[float_bits(node[number])] != 0) {
    const std::uint32_t first = float_bits(node[link]);
    const std::array<NodeOf<float>, 2> children{node_at(first), node_at(first + 1)};
    const std::array<float, 2> parts{importance<float>(children[0], p, n), importance<float>(children[1], p, n)};
    const float over = 1 / std::max(of_node, 1e-37f);
    visit(float_bits(node[number]), parts[0] * over, parts[1] * over);
    node = children[turns & 1u], of_node = parts[turns & 1u];
    turns >>= 1;
  }
  Descent down{float_bits(node[number]), of_node, 1};
  while (!is_leaf(node)) {
    const std::uint32_t first = float_bits(node[link]);
    const Fork<float> f = fork<float>(first, p, n, NoFactors{});
    down.mass *= (turns & 1u) == 0 ? f.first : 1 - f.first;
    node = node_at(first + (turns & 1u));
    turns >>= 1;
  }
  return down;
}

}  // namespace montelux
