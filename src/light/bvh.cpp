#include "light/bvh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>

namespace montelux {

namespace {

// What is learned of clusters needs memory for each place, and rays for each cluster.
constexpr std::size_t max_clusters = 512;

struct Cone {
  Vec3f axis;
  float cos_angle;
};

// The smallest cone around both, slightly too wide rather than too narrow.
Cone unite(const Cone& a, const Cone& b) {
  const Cone everything{{0, 0, 1}, -1};
  float angle_a = std::acos(std::clamp(a.cos_angle, -1.0f, 1.0f)),
        angle_b = std::acos(std::clamp(b.cos_angle, -1.0f, 1.0f));
  float between = angle_between(a.axis, b.axis);
  if (between + angle_b <= angle_a) return a;
  if (between + angle_a <= angle_b) return b;
  float angle = 0.5f * (angle_a + angle_b + between) + 1e-5f;
  Vec3f side = b.axis - a.axis * dot(a.axis, b.axis);
  float side_length = length(side);
  if (angle >= pi) return everything;
  // If the axes are nearly parallel, the axis stays unchanged.
  if (side_length < 1e-6f)
    return between < 1.0f ? Cone{a.axis, std::cos(std::max(angle_a, angle_b + between) + 1e-5f)} : everything;
  float turn = angle - angle_a;
  return {normalize(a.axis * std::cos(turn) + side * (std::sin(turn) / side_length)), std::cos(angle)};
}

// Which of two opposite axes represents a light that emits both ways: any fixed rule is valid.
Vec3f one_of_both(Vec3f axis) { return dot(axis, {0.87f, 0.41f, 0.27f}) < 0 ? -axis : axis; }

struct Box {
  Vec3f low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  void add(Vec3f l, Vec3f h) { low = min(l, low), high = max(h, high); }
  Vec3f size() const { return high - low; }
};

float component(Vec3f a, int i) { return i == 0 ? a.x : i == 1 ? a.y : a.z; }

// Sums over a set of lights, from which the cost of a cluster follows without iterating over its cones.
struct Cluster {
  Box box;
  Vec3f axes{0, 0, 0};  // weighted by intensity
  float intensity = 0, spread = 0, emission = 0;
  int count = 0;

  void add(const LightBounds& b, Vec3f axis) {
    box.add(b.low, b.high);
    axes += axis * b.intensity;
    intensity += b.intensity;
    spread = std::min(spread, b.cos_spread - 1);
    emission = std::min(emission, b.cos_emission - 1);
    ++count;
  }
  void add(const Cluster& c) {
    box.add(c.box.low, c.box.high);
    axes += c.axes;
    intensity += c.intensity;
    spread = std::min(spread, c.spread), emission = std::min(emission, c.emission);
    count += c.count;
  }
  // Intensity times the measure of the surface-area-orientation heuristic (Conty Estevez and Kulla 2018, eq. 1). The
  // spread of the normals is that of the cap over which uniform normals have the same mean: |mean| = (1 + cos) / 2.
  float cost() const {
    if (count == 0 || !(intensity > 0)) return 0;
    float cap = std::clamp(2 * length(axes) / intensity - 1, -1.0f, 1.0f);
    float theta_o = std::min(std::acos(cap) + std::acos(std::clamp(1 + spread, -1.0f, 1.0f)), pi);
    float theta_w = std::min(theta_o + std::acos(std::clamp(1 + emission, -1.0f, 1.0f)), pi);
    float sin_o = std::sin(theta_o), cos_o = std::cos(theta_o);
    float orientation =
        two_pi * (1 - cos_o) +
        0.5f * pi * (2 * theta_w * sin_o - std::cos(theta_o - 2 * theta_w) - 2 * theta_o * sin_o + cos_o);
    Vec3f d = box.size();
    float area = 2 * (d.x * d.y + d.y * d.z + d.z * d.x) + 1e-3f * dot(d, d);
    return intensity * orientation * area;
  }
};

}  // namespace

LightBounds unite(const LightBounds& a, const LightBounds& b) {
  LightBounds r;
  r.low = min(a.low, b.low), r.high = max(a.high, b.high);
  r.two_sided = a.two_sided || b.two_sided;
  Vec3f other = r.two_sided && dot(a.axis, b.axis) < 0 ? -b.axis : b.axis;
  Cone cone = unite(Cone{a.axis, a.cos_spread}, Cone{other, b.cos_spread});
  r.axis = cone.axis, r.cos_spread = cone.cos_angle;
  r.cos_emission = std::min(a.cos_emission, b.cos_emission);
  r.intensity = a.intensity + b.intensity;
  return r;
}

namespace {

// The upper half of a float, whose magnitude is that of x or slightly more.
std::uint32_t half_not_below(float x) {
  return std::min((float_bits(x) & 0x7fffffffu) + 0xffffu, 0x7f7fffffu) >> 16 | (std::signbit(x) ? 0x8000u : 0u);
}
// The nearest one.
std::uint32_t nearest_half(float x) { return (float_bits(x) + 0x8000u) >> 16; }
// The length of what rounding its components to the nearest half adds to a unit vector, at most.
constexpr float axis_error = 0x1p-9f;

float both_halves(std::uint32_t upper, std::uint32_t lower) { return std::bit_cast<float>(upper << 16 | lower); }

}  // namespace

// Builds a binary tree from the top down, and its bounds from the bottom up; then joins levels of it.
struct LightBvh::Builder {
  std::span<const std::optional<LightBounds>> bounds;
  std::vector<Item> items;
  LightBvh& bvh;
  std::vector<Node> nodes{};            // the root, then the two children of a node side by side
  std::vector<std::uint32_t> leaves{};  // in the order of the tree

  // The children of a node of the joined tree, which are nodes of the binary one.
  struct Children {
    std::array<std::uint32_t, fan> nodes;
    std::uint32_t count = 0;
    std::uint32_t first_number = 0;
  };
  std::vector<Children> joined{};  // as wide_nodes_

  void write(std::uint32_t node, const LightBounds& b, std::uint32_t link_bits) {
    float* v = nodes[node].v;
    Vec3f middle = (b.low + b.high) * 0.5f, half = max(b.high - middle, middle - b.low);
    v[centre] = middle.x, v[centre + 1] = middle.y, v[centre + 2] = middle.z;
    v[radius] = length(half) * 1.00001f;
    v[axis] = b.axis.x, v[axis + 1] = b.axis.y, v[axis + 2] = b.axis.z;
    v[intensity] = b.two_sided ? -b.intensity : b.intensity;
    v[spread] = b.cos_spread < 0 ? 2.0f : std::sqrt(std::max(0.0f, 1 - b.cos_spread * b.cos_spread));
    v[narrowness] = 1 - b.cos_emission;
    v[link] = std::bit_cast<float>(link_bits);
  }

  // Where to split items [begin, end): by the cheapest of up to twelve slices along each axis, or in the middle.
  std::size_t split(std::size_t begin, std::size_t end, int depth) {
    if (end - begin == 2) return begin + 1;
    constexpr int max_slices = 12;
    const int slices = int(std::min<std::size_t>(max_slices, end - begin));
    Box middles, box;
    for (std::size_t i = begin; i < end; ++i) {
      middles.add(items[i].middle, items[i].middle);
      box.add(bounds[items[i].light]->low, bounds[items[i].light]->high);
    }
    Vec3f extent = middles.size(), size = box.size();
    auto slice_of = [&](const Item& item, int dim) {
      float t = (component(item.middle, dim) - component(middles.low, dim)) / component(extent, dim);
      return std::clamp(int(float(slices) * t), 0, slices - 1);
    };
    float best = INFINITY;
    int best_dim = -1, best_slice = 0;
    // The turns of a path have 32 bits: deep in the tree, splitting in the middle limits the depth.
    constexpr int max_depth = 32 / levels_joined * levels_joined;
    bool room = depth + int(std::bit_width(end - begin)) < max_depth;
    for (int dim = 0; dim < 3 && room; ++dim) {
      if (!(component(extent, dim) > 0)) continue;
      Cluster slice[max_slices], above[max_slices];
      for (std::size_t i = begin; i < end; ++i)
        slice[slice_of(items[i], dim)].add(*bounds[items[i].light], items[i].axis);
      above[slices - 1] = slice[slices - 1];
      for (int s = slices - 2; s > 0; --s) above[s] = slice[s], above[s].add(above[s + 1]);
      float stretch = max_component(size) / std::max(component(size, dim), 1e-30f);
      Cluster below;
      for (int s = 0; s + 1 < slices; ++s) {
        below.add(slice[s]);
        if (below.count == 0 || above[s + 1].count == 0) continue;
        float cost = stretch * (below.cost() + above[s + 1].cost());
        if (cost < best) best = cost, best_dim = dim, best_slice = s;
      }
    }
    auto first = items.begin() + std::ptrdiff_t(begin), last = items.begin() + std::ptrdiff_t(end);
    if (best_dim >= 0)
      return std::size_t(
          std::partition(first, last, [&](const Item& i) { return slice_of(i, best_dim) <= best_slice; }) -
          items.begin());
    int dim = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    std::size_t half = (end - begin) / 2;
    std::nth_element(first, first + std::ptrdiff_t(half), last,
                     [&](const Item& a, const Item& b) { return component(a.middle, dim) < component(b.middle, dim); });
    return begin + half;
  }

  // The link of an inner node is the first of its children, until join() replaces it.
  LightBounds build(std::uint32_t node, std::size_t begin, std::size_t end, int depth) {
    if (end - begin == 1) {
      std::uint32_t light = items[begin].light;
      write(node, *bounds[light], light | leaf_bit);
      leaves.push_back(node);
      bvh.places_[light] = std::uint32_t(leaves.size());
      return *bounds[light];
    }
    std::size_t middle = split(begin, end, depth);
    auto child = std::uint32_t(nodes.size());
    nodes.resize(nodes.size() + 2);
    LightBounds a = build(child, begin, middle, depth + 1);
    LightBounds b = build(child + 1, middle, end, depth + 1);
    LightBounds both = unite(a, b);
    write(node, both, child);
    return both;
  }

  std::uint32_t link_of(std::uint32_t node) const { return float_bits(nodes[node].v[link]); }
  bool is_leaf(std::uint32_t node) const { return (link_of(node) & leaf_bit) != 0; }
  float brightness(std::uint32_t node) const { return std::abs(nodes[node].v[intensity]); }

  // Replaces an inner node by its two children, of which the first takes its place.
  void divide(Children& c, std::size_t i) const {
    const std::uint32_t first = link_of(c.nodes[i]);
    c.nodes[i] = first, c.nodes[c.count++] = first + 1;
  }
  // The children of a node become its descendants some levels down, and the leaves above them; where there is room, the
  // brightest are divided again.
  void join(std::uint32_t node, int depth, std::uint32_t turns) {
    if (is_leaf(node)) {
      bvh.turns_[link_of(node) & ~leaf_bit] = turns;
      return;
    }
    Children c{{node}, 1};
    for (int level = 0; level < levels_joined; ++level)
      for (std::size_t i = 0, count = c.count; i < count; ++i)
        if (!is_leaf(c.nodes[i])) divide(c, i);
    while (c.count < fan) {
      std::size_t brightest = fan;
      for (std::size_t i = 0; i < c.count; ++i)
        if (!is_leaf(c.nodes[i]) && (brightest == fan || brightness(c.nodes[i]) > brightness(c.nodes[brightest])))
          brightest = i;
      if (brightest == fan) break;
      divide(c, brightest);
    }
    nodes[node].v[link] = std::bit_cast<float>(std::uint32_t(joined.size()));
    joined.push_back(c);
    for (std::uint32_t k = 0; k < c.count; ++k) join(c.nodes[k], depth + 1, turns | k << (levels_joined * depth));
  }

  // From the root down, always the brightest one that has not been divided.
  void number_clusters() {
    struct Open {
      float intensity;
      std::uint32_t node;
      bool operator<(const Open& other) const {
        return intensity != other.intensity ? intensity < other.intensity : node > other.node;
      }
    };
    std::vector<NumberedNode>& numbered = bvh.numbered_nodes_;
    std::priority_queue<Open> open;
    open.push({0, 0});
    numbered = {{}};
    for (std::size_t clusters = 1; !open.empty() && clusters < max_clusters;) {
      const std::uint32_t node = open.top().node, own = float_bits(nodes[node].v[number]);
      open.pop();
      if (is_leaf(node)) continue;
      Children& c = joined[link_of(node)];
      c.first_number = std::uint32_t(numbered.size());
      numbered[own].first_child = c.first_number, numbered[own].child_count = c.count;
      for (std::uint32_t k = 0; k < c.count; ++k) {
        nodes[c.nodes[k]].v[number] = std::bit_cast<float>(c.first_number + k);
        numbered.push_back({.parent = own});
        open.push({brightness(c.nodes[k]), c.nodes[k]});
      }
      clusters += c.count - 1;
    }
  }

  // `number`: of the first of the two, which need not exist.
  static Pair pack(const Node& first, const Node& second, std::uint32_t number) {
    const float *a = first.v, *b = second.v;
    Pair p;
    const auto bound = [&](int slot, float of_first, float of_second) {
      p.v[slot] = both_halves(half_not_below(of_first), half_not_below(of_second));
    };
    std::copy_n(a + centre, 3, p.v + first_centre);
    std::copy_n(b + centre, 3, p.v + second_centre);
    bound(radii, a[radius], b[radius]);
    for (int i = 0; i < 3; ++i) p.v[axes + i] = both_halves(nearest_half(a[axis + i]), nearest_half(b[axis + i]));
    bound(intensities, a[intensity], b[intensity]);
    bound(spreads, a[spread] + axis_error, b[spread] + axis_error);
    bound(narrownesses, a[narrowness], b[narrowness]);
    p.v[first_link] = a[link], p.v[second_link] = b[link];
    p.v[first_number] = std::bit_cast<float>(number);
    return p;
  }

  void finish() {
    bvh.singles_ = {nodes.front()};
    if (leaves.size() <= max_scanned) {
      for (const std::uint32_t leaf : leaves) bvh.singles_.push_back(nodes[leaf]);
      return;
    }
    for (const Children& c : joined) {
      const auto child = [&](std::uint32_t k) { return k < c.count ? nodes[c.nodes[k]] : Node{}; };
      // A second child that does not exist takes the factor after the first one's, which may be that of the whole
      // hierarchy, times an importance of 0.
      const auto number_of = [&](std::uint32_t k) {
        return c.first_number == 0 || k >= c.count ? 0u : c.first_number + k;
      };
      WideNode& wide = bvh.wide_nodes_.emplace_back();
      for (std::uint32_t k = 0; k < fan; k += 2) wide.pairs[k / 2] = pack(child(k), child(k + 1), number_of(k));
    }
  }
};

LightBvh::LightBvh(std::span<const std::optional<LightBounds>> bounds) {
  Builder builder{bounds, {}, *this};
  builder.items.reserve(bounds.size());
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (!bounds[i]) continue;
    const LightBounds& b = *bounds[i];
    builder.items.push_back({std::uint32_t(i), (b.low + b.high) * 0.5f, b.two_sided ? one_of_both(b.axis) : b.axis});
  }
  if (builder.items.empty()) return;
  turns_.resize(bounds.size());
  places_.resize(bounds.size());
  builder.nodes.reserve(2 * builder.items.size());
  builder.nodes.resize(1);
  builder.build(0, 0, builder.items.size(), 0);
  builder.join(0, 0, 0);
  builder.number_clusters();
  builder.finish();
}

}  // namespace montelux
