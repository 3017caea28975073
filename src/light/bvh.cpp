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

// Builds the nodes from the top down, and their bounds from the bottom up.
struct LightBvh::Builder {
  std::span<const std::optional<LightBounds>> bounds;
  std::vector<Item> items;
  LightBvh& bvh;

  void write(std::uint32_t node, const LightBounds& b, std::uint32_t link_bits, bool is_leaf) {
    float* v = bvh.nodes_[node].v;
    Vec3f middle = (b.low + b.high) * 0.5f, half = max(b.high - middle, middle - b.low);
    v[centre] = middle.x, v[centre + 1] = middle.y, v[centre + 2] = middle.z;
    v[radius] = length(half) * 1.00001f;
    v[axis] = b.axis.x, v[axis + 1] = b.axis.y, v[axis + 2] = b.axis.z;
    v[intensity] = b.two_sided ? -b.intensity : b.intensity;
    v[spread] = b.cos_spread < 0 ? 2.0f : std::sqrt(std::max(0.0f, 1 - b.cos_spread * b.cos_spread));
    v[cos_emission] = b.cos_emission;
    v[inverse_radius_squared] = std::min(1 / std::max(v[radius] * v[radius], 1e-37f), 1e18f);
    v[link] = std::bit_cast<float>(is_leaf ? link_bits | leaf_bit : link_bits);
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
    bool room = depth + int(std::bit_width(end - begin)) < 31;
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

  LightBounds build(std::uint32_t node, std::size_t begin, std::size_t end, int depth, std::uint32_t turns) {
    if (end - begin == 1) {
      std::uint32_t light = items[begin].light;
      write(node, *bounds[light], light, true);
      bvh.turns_[light] = turns;
      bvh.places_[light] = std::uint32_t(bvh.leaves_.size());
      bvh.leaves_.push_back(node);
      return *bounds[light];
    }
    std::size_t middle = split(begin, end, depth);
    auto child = std::uint32_t(bvh.nodes_.size());
    bvh.nodes_.resize(bvh.nodes_.size() + 2);
    LightBounds a = build(child, begin, middle, depth + 1, turns);
    LightBounds b = build(child + 1, middle, end, depth + 1, turns | (1u << depth));
    LightBounds both = unite(a, b);
    write(node, both, child, false);
    return both;
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
  nodes_.reserve(2 * builder.items.size());
  nodes_.resize(1);
  builder.build(0, 0, builder.items.size(), 0, 0);
  number_clusters();
}

// From the root down, always the brightest one that has not been divided.
void LightBvh::number_clusters() {
  struct Open {
    float intensity;
    std::uint32_t node;
    bool operator<(const Open& other) const {
      return intensity != other.intensity ? intensity < other.intensity : node > other.node;
    }
  };
  std::priority_queue<Open> open;
  open.push({0, 0});
  cluster_links_ = {0};
  while (!open.empty() && cluster_links_.size() < 2 * max_clusters) {
    const std::uint32_t node = open.top().node, below = float_bits(nodes_[node].v[link]);
    open.pop();
    if ((below & leaf_bit) != 0) continue;
    cluster_links_[float_bits(nodes_[node].v[number])] = std::uint32_t(cluster_links_.size());
    for (std::uint32_t child : {below, below + 1}) {
      nodes_[child].v[number] = std::bit_cast<float>(std::uint32_t(cluster_links_.size()));
      cluster_links_.push_back(0);
      open.push({std::abs(nodes_[child].v[intensity]), child});
    }
  }
}

}  // namespace montelux
