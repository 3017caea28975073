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

  bool empty() const { return singles_.empty(); }

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
    return importance<F>(single<F>(0), Receiver<F>(p, n));
  }

  // The upper nodes of the tree have numbers, by which ClusterFactors knows them; the root and nodes further down have
  // the number 0.
  struct NumberedNode {
    std::uint32_t parent = 0;
    // The numbers of its children are consecutive and greater. No children: it is a cluster, which is not divided.
    std::uint32_t first_child = 0, child_count = 0;
  };
  std::span<const NumberedNode> numbered_nodes() const { return numbered_nodes_; }

  // What learning needs to know of the choice of a light at p.
  struct Descent {
    std::uint32_t cluster;  // the number of the one that has the light
    float importance;       // of that cluster
    float mass;             // with which the light is selected where the cluster is given
  };
  // Calls visit(number, parts) for each numbered node on the way down to the cluster, the root included; `parts`, an
  // array: the importances of its children over its own.
  template <class Visit>
  Descent descend(LightId light, Vec3f p, Vec3f n, Visit visit) const;

 private:
  // A point that receives light, and the side of it that matters.
  template <class F>
  struct Receiver {
    Vec3<F> p, n;
    Mask<F> one_sided;
    MONTELUX_INLINE Receiver(Vec3<F> point, Vec3<F> normal)
        : p(point), n(normal), one_sided(length_squared(normal) > F(0.5f)) {}
  };
  // A light or a cluster of them, in every lane.
  template <class F>
  struct Bounds {
    Vec3<F> centre;
    F radius;
    Vec3<F> axis;
    F intensity;     // negative if the lights emit both ways
    F spread;        // the sine of the largest angle between the axis and a normal; 2 if that exceeds a right angle
    F narrowness;    // 1 minus the cosine of the largest angle between a normal and a direction of emission
    Uint<F> link;    // of a leaf, which the top bit marks, its light; else the WideNode of its children
    Uint<F> number;  // among clusters
  };
  static constexpr std::uint32_t leaf_bit = 0x80000000u;

  // As the builder has it: exact.
  struct alignas(64) Node {
    float v[words_of_row] = {};
  };
  enum Slot { centre = 0, radius = 3, axis = 4, intensity = 7, spread, narrowness, link, number };
  // Two of the children of a node, in one line of the cache. Except for the centres each number has 16 bits, the
  // upper half of a float: in the upper half of a word that of the first child, in the lower that of the second.
  // Rounding never makes a bound tighter.
  struct alignas(64) Pair {
    float v[words_of_row] = {};
  };
  enum PairSlot {
    first_centre = 0,
    second_centre = 3,
    radii = 6,
    axes = 7,
    intensities = 10,
    spreads,
    narrownesses,
    first_link,
    second_link,
    first_number  // the second's is the next one; 0: both have the number 0
  };
  // All of them. Those that do not exist have no intensity. A node has the lights of so many levels of a binary tree:
  // more children are more work, and a choice that knows the lights better.
  static constexpr int levels_joined = 3;
  static constexpr std::size_t fan = std::size_t(1) << levels_joined;
  struct WideNode {
    Pair pairs[fan / 2];
  };

  struct Item {
    std::uint32_t light;
    Vec3f middle, axis;
  };
  struct Builder;

  // The same in all lanes, exact: 0 is the root; 1 and the following are the leaves, in the order of the tree, if they
  // are scanned.
  template <class F>
  MONTELUX_INLINE Bounds<F> single(std::size_t i) const {
    const auto v = row_in_all_lanes<F>(singles_.data()->v, std::uint32_t(i));
    return {{v[centre], v[centre + 1], v[centre + 2]},
            v[radius],
            {v[axis], v[axis + 1], v[axis + 2]},
            v[intensity],
            v[spread],
            v[narrowness],
            float_bits(v[link]),
            float_bits(v[number])};
  }
  template <class F>
  struct BoundsOfPair {
    Bounds<F> first, second;
  };
  template <class F>
  MONTELUX_INLINE BoundsOfPair<F> bounds_of_pair(Uint<F> node, std::uint32_t pair) const {
    const auto v = gather_rows<F>(wide_nodes_.data()->pairs->v, Uint<F>(node * std::uint32_t(fan / 2)) + Uint<F>(pair));
    const auto upper = [&](int slot) { return float_from_bits(float_bits(v[std::size_t(slot)]) & 0xffff0000u); };
    const auto lower = [&](int slot) { return float_from_bits(float_bits(v[std::size_t(slot)]) << 16); };
    const auto child = [&](std::size_t at, auto half, int link_slot, Uint<F> its_number) {
      return Bounds<F>{{v[at], v[at + 1], v[at + 2]},
                       half(radii),
                       {half(axes), half(axes + 1), half(axes + 2)},
                       half(intensities),
                       half(spreads),
                       half(narrownesses),
                       float_bits(v[std::size_t(link_slot)]),
                       its_number};
    };
    const Uint<F> of_first = float_bits(v[first_number]);
    const Uint<F> of_second = select(of_first == Uint<F>(0u), of_first, Uint<F>(of_first + 1u));
    return {child(first_centre, upper, first_link, of_first), child(second_centre, lower, second_link, of_second)};
  }
  template <class F>
  static MONTELUX_INLINE Mask<F> is_inner(Uint<F> link_bits) {
    return (link_bits & Uint<F>(leaf_bit)) == Uint<F>(0u);
  }
  template <class F>
  static MONTELUX_INLINE F importance(const Bounds<F>& lights, const Receiver<F>& at);
  template <class F>
  static MONTELUX_INLINE F importance(const Bounds<F>& lights, const Receiver<F>& at, const NoFactors&) {
    return importance<F>(lights, at);
  }
  template <class F>
  static MONTELUX_INLINE F importance(const Bounds<F>& lights, const Receiver<F>& at,
                                      const ClusterFactors<F>& factors) {
    return importance<F>(lights, at) * gather(factors.values, Uint<F>(factors.first + lights.number));
  }
  // Sets of few lights are scanned instead of descended: the choice is then exactly proportional to each light's
  // importance.
  static constexpr std::size_t max_scanned = 16;
  bool is_scanned() const { return wide_nodes_.empty(); }
  // The importances of all leaves, by their index in singles_, summed in this order.
  template <class F>
  struct Scan {
    F importance[1 + max_scanned];
    F sum;
  };
  template <class F, class Factors>
  MONTELUX_INLINE Scan<F> scan(const Receiver<F>& at, const Factors& factors) const {
    Scan<F> s;
    s.sum = F(0.0f);
    for (std::size_t i = 1; i < singles_.size(); ++i) {
      s.importance[i] = importance<F>(single<F>(i), at, factors);
      s.sum = s.sum + s.importance[i];
    }
    return s;
  }
  template <class F, class Factors>
  LightChoice<F> choose_by_scan(const Receiver<F>& at, F u, Mask<F> on, const Factors& factors) const;
  // The children of a node: their importances, and in proportion to what they are chosen.
  template <class F>
  struct Fork {
    F importances[fan];
    F weights[fan];
    F sum;  // of the weights; 0: none of them sends light to p
    Uint<F> links[fan];
  };
  template <class F, class Factors>
  MONTELUX_INLINE Fork<F> fork(Uint<F> node, const Receiver<F>& at, const Factors& factors) const {
    Fork<F> f;
    for (std::size_t k = 0; k < fan; k += 2) {
      const BoundsOfPair<F> both = bounds_of_pair<F>(node, std::uint32_t(k / 2));
      f.importances[k] = importance<F>(both.first, at, factors), f.links[k] = both.first.link;
      f.importances[k + 1] = importance<F>(both.second, at, factors), f.links[k + 1] = both.second.link;
    }
    // A child that can send light keeps a share that u can hit, however large the others' importances are.
    F total = f.importances[0];
    for (std::size_t k = 1; k < fan; ++k) total = total + f.importances[k];
    const F least = total * light_bvh::min_share;
    for (std::size_t k = 0; k < fan; ++k)
      f.weights[k] = select(f.importances[k] > F(0.0f), max(f.importances[k], least), F(0.0f));
    f.sum = f.weights[0];
    for (std::size_t k = 1; k < fan; ++k) f.sum = f.sum + f.weights[k];
    return f;
  }

  std::vector<WideNode> wide_nodes_;  // none if the leaves are scanned; the first is that of the root
  std::vector<Node> singles_;         // the root, and the leaves if they are scanned
  // By light: its path from the root, levels_joined bits for each child that is taken, from the lowest bits up.
  std::vector<std::uint32_t> turns_;
  std::vector<std::uint32_t> places_;  // by light: its index in singles_, if the leaves are scanned
  std::vector<NumberedNode> numbered_nodes_;
};

template <class F>
MONTELUX_INLINE F LightBvh::importance(const Bounds<F>& lights, const Receiver<F>& at) {
  using namespace light_bvh;
  const F one(1.0f);
  const Vec3<F> from = at.p - lights.centre;
  const F d2 = length_squared(from), r2 = lights.radius * lights.radius;
  const Mask<F> inside = d2 <= r2;
  // Over the distance, but at least the radius.
  const F over_d = one / sqrt(clamp(max(d2, r2), F(1e-18f), F(1e36f)));
  const F sin_b = lights.radius * over_d;  // of the angular radius of the bounding ball

  // The smallest angle between a normal of the cluster and a direction to p; from inside, any.
  const F strength = lights.intensity, along = dot(lights.axis, from) * over_d;
  const F cos_w = select(strength < F(0.0f), abs(along), along);
  const F cos_p = select(inside, one, min(cos_w + lights.spread + sin_b, one));
  F result = abs(strength) * max(cos_p, F(slack)) * (over_d * over_d);
  result = select(cos_p > F(1.0f - slack) - lights.narrowness, result, F(0.0f));

  // The smallest angle between n and a direction to the cluster.
  const F cos_q = select(inside, one, min(sin_b - dot(at.n, from) * over_d, one));
  const F facing = select(cos_q > F(-slack), max(cos_q, F(slack)), F(0.0f));
  return result * select(at.one_sided, facing, one);
}

template <class F, class Factors>
LightChoice<F> LightBvh::choose_by_scan(const Receiver<F>& at, F u, Mask<F> on, const Factors& factors) const {
  const Scan<F> s = scan<F>(at, factors);
  const F target = u * s.sum;
  // The first light at which the running sum exceeds the target; if rounding prevents that, the last valid one.
  F running(0.0f), chosen(0.0f);
  Uint<F> light(0u);
  Mask<F> open = on & (s.sum > F(0.0f));
  const Mask<F> valid = open;
  for (std::size_t i = 1; i < singles_.size(); ++i) {
    running = running + s.importance[i];
    const Mask<F> takes = open & (s.importance[i] > F(0.0f));
    chosen = select(takes, s.importance[i], chosen);
    light = select(takes, Uint<F>(float_bits(singles_[i].v[link]) & ~leaf_bit), light);
    open = open & !Mask<F>(running > target);
  }
  return {light, {select(valid, chosen / max(s.sum, F(1e-37f)), F(0.0f))}, valid};
}

template <class F, class Factors>
LightChoice<F> LightBvh::choose(Vec3<F> p, Vec3<F> n, F u, Mask<F> on, const Factors& factors) const {
  const Receiver<F> at(p, n);
  if (is_scanned()) return choose_by_scan<F>(at, u, on, factors);
  F mass(1.0f);
  Mask<F> valid = on, inner = on;
  Uint<F> below(0u);
  while (any(inner)) {
    const Fork<F> f = fork<F>(select(inner, below, Uint<F>(0u)), at, factors);
    const F target = u * f.sum;
    F chosen = f.weights[0], before(0.0f), running = f.weights[0];
    Uint<F> next = f.links[0];
    for (std::size_t k = 1; k < fan; ++k) {
      const Mask<F> later = target >= running;
      chosen = select(later, f.weights[k], chosen);
      before = select(later, running, before);
      next = select(later, f.links[k], next);
      running = running + f.weights[k];
    }
    const F share = chosen / max(f.sum, F(1e-37f));
    // The rescaled remainder of u decides further down.
    const F rest = min((target - before) / max(chosen, F(1e-37f)), F(one_minus_epsilon));
    u = select(inner, rest, u);
    mass = select(inner, mass * share, mass);
    below = select(inner, next, below);
    const Mask<F> any_light = f.sum > F(0.0f);
    valid = valid & (any_light | !inner);
    inner = inner & any_light & is_inner<F>(below);
  }
  const Uint<F> light = select(valid, Uint<F>(below & Uint<F>(~leaf_bit)), Uint<F>(0u));
  return {light, {select(valid, mass, F(0.0f))}, valid};
}

template <class F, class Factors>
Mass<F> LightBvh::mass(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on, const Factors& factors) const {
  if (!any(on) || empty()) return {F(0.0f)};
  const Receiver<F> at(p, n);
  if (is_scanned()) {
    const Scan<F> all = scan<F>(at, factors);
    const Uint<F> place = gather(places_.data(), select(on, light, Uint<F>(0u)));
    F own(0.0f);
    for (std::size_t i = 1; i < singles_.size(); ++i)
      own = select(place == Uint<F>(std::uint32_t(i)), all.importance[i], own);
    return {select(on & (all.sum > F(0.0f)), own / max(all.sum, F(1e-37f)), F(0.0f))};
  }
  Uint<F> below(0u), turns = gather(turns_.data(), select(on, light, Uint<F>(0u)));
  F mass(1.0f);
  Mask<F> inner = on;
  while (any(inner)) {
    const Fork<F> f = fork<F>(select(inner, below, Uint<F>(0u)), at, factors);
    const Uint<F> turn = turns & Uint<F>(std::uint32_t(fan - 1));
    F chosen = f.weights[0];
    Uint<F> next = f.links[0];
    for (std::size_t k = 1; k < fan; ++k) {
      const Mask<F> is_this = turn == Uint<F>(std::uint32_t(k));
      chosen = select(is_this, f.weights[k], chosen);
      next = select(is_this, f.links[k], next);
    }
    mass = select(inner, mass * (chosen / max(f.sum, F(1e-37f))), mass);
    below = select(inner, next, below);
    turns = select(inner, Uint<F>(turns >> levels_joined), turns);
    inner = inner & is_inner<F>(below);
  }
  return {select(on, mass, F(0.0f))};
}

template <class Visit>
LightBvh::Descent LightBvh::descend(LightId light, Vec3f p, Vec3f n, Visit visit) const {
  const Receiver<float> at(p, n);
  const Bounds<float> start = single<float>(is_scanned() ? places_[std::uint32_t(light)] : 0u);
  Descent down{start.number, importance<float>(start, at), 1};
  std::uint32_t turns = turns_[std::uint32_t(light)];
  for (std::uint32_t below = start.link; is_inner<float>(below); turns >>= levels_joined) {
    const Fork<float> f = fork<float>(below, at, NoFactors{});
    const std::uint32_t turn = turns & std::uint32_t(fan - 1);
    below = f.links[turn];
    const NumberedNode& node = numbered_nodes_[down.cluster];
    if (node.child_count == 0) {
      down.mass *= f.weights[turn] / std::max(f.sum, 1e-37f);
      continue;
    }
    std::array<float, fan> parts{};
    for (std::size_t k = 0; k < fan; ++k) parts[k] = f.importances[k] / std::max(down.importance, 1e-37f);
    visit(down.cluster, parts);
    down.cluster = node.first_child + turn, down.importance = f.importances[turn];
  }
  return down;
}

}  // namespace montelux
