#include "integrator/guiding/cluster_learner.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

// So many records of what surrounds a leaf count in it, for each node.
constexpr float prior_records = 4;
// The factor of a cluster that no ray has reached is not smaller than this, as a part of what is expected of it where
// nothing is in the way.
constexpr float min_factor = 0.4f;

std::size_t columns_of(const LightSet& lights) {
  return lights.hierarchy().numbered_nodes().size() + 1 + lights.beyond().size();
}

}  // namespace

void ClusterLearner::Sums::add(const Sums& other, double scale) {
  const auto by = float(scale);
  records += scale * other.records;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].square.add(other.nodes[i].square, by);
    nodes[i].part.add(other.nodes[i].part, by);
  }
}

void ClusterLearner::Sums::shrink_toward(const Sums& above) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].square.shrink_toward(above.nodes[i].square.mean(), prior_records);
    nodes[i].part.shrink_toward(above.nodes[i].part.mean(), prior_records);
  }
}

ClusterLearner::ClusterLearner(std::span<const Vec3f> places, const LightSet& lights)
    : lights_(lights), sums_(places, {0, std::vector<NodeSums>(columns_of(lights))}), all_(columns_of(lights)) {}

void ClusterLearner::add_square(Sums& sums, std::size_t node, float ratio, bool arrives) {
  const float square = ratio * ratio;
  if (!is_finite(square)) return;
  sums.nodes[node].square.add(arrives ? square : 0.0f);
  all_[node].square.add(square);
}

void ClusterLearner::add(const ClusterRecord& r) {
  const LightBvh& bvh = lights_.hierarchy();
  const std::span<const LightBvh::NumberedNode> tree = bvh.numbered_nodes();
  const std::size_t of_whole = tree.size();
  Sums& sums = sums_.at(r.p, r.n);
  sums.records += 1;
  if (lights_.is_beyond<float>(std::uint32_t(r.light), true)) {
    const auto j = std::size_t(std::ranges::find(lights_.beyond(), std::uint32_t(r.light)) - lights_.beyond().begin());
    add_square(sums, of_whole + 1 + j, r.contribution / (r.mass * lights_.beyond_irradiances()[j]), r.arrives);
    return;
  }
  add_square(sums, of_whole, r.contribution / (r.mass * bvh.irradiance<float>(r.p, r.n)), r.arrives);
  const auto visit = [&](std::uint32_t node, const auto& parts) {
    for (std::uint32_t k = 0; k < tree[node].child_count; ++k)
      for (std::vector<NodeSums>* s : {&sums.nodes, &all_}) (*s)[tree[node].first_child + k].part.add(parts[k]);
  };
  const LightBvh::Descent down = bvh.descend(r.light, r.p, r.n, visit);
  add_square(sums, down.cluster, r.contribution / (down.mass * down.importance), r.arrives);
}

ClusterLearner::Sums ClusterLearner::unoccluded() const {
  const std::span<const LightBvh::NumberedNode> tree = lights_.hierarchy().numbered_nodes();
  Sum clusters;
  for (const NodeSums& a : std::span(all_).first(tree.size())) clusters.add(a.square, 1);
  const float usual = clusters.sum > 0 ? clusters.mean() : 1.0f;
  Sums expected{1, all_};
  for (std::size_t i = 0; i < all_.size(); ++i) {
    NodeSums& e = expected.nodes[i];
    const bool is_node = i < tree.size(), is_child = is_node && i > 0;
    e.square.shrink_toward(is_node ? usual : 1.0f, 1);
    e.part.shrink_toward(is_child ? 1 / float(tree[tree[i].parent].child_count) : 1.0f, 1);
    e = {{1, e.square.mean()}, {1, e.part.mean()}};
  }
  return expected;
}

ClusterField ClusterLearner::field() const {
  const std::span<const LightBvh::NumberedNode> tree = lights_.hierarchy().numbered_nodes();
  const Sums expected = unoccluded();
  std::vector<float> factors(sums_.leaves() * all_.size());
  sums_.for_each_leaf(expected, [&](std::uint32_t leaf, const Sums& sums) {
    float* of_leaf = factors.data() + leaf * all_.size();
    for (std::size_t i = tree.size(); i-- > 1;) {
      const LightBvh::NumberedNode& node = tree[i];
      if (node.child_count == 0)
        of_leaf[i] =
            std::max(std::sqrt(sums.nodes[i].square.mean()), min_factor * std::sqrt(expected.nodes[i].square.mean()));
      for (std::size_t child = node.first_child; child < node.first_child + node.child_count; ++child)
        of_leaf[i] += sums.nodes[child].part.mean() * of_leaf[child];
    }
    if (!tree.empty()) of_leaf[0] = 1;
    for (std::size_t i = tree.size(); i < all_.size(); ++i) of_leaf[i] = std::sqrt(sums.nodes[i].square.mean());
  });
  return {sums_.tree(), std::uint32_t(tree.size()), std::uint32_t(lights_.beyond().size()), std::move(factors)};
}

}  // namespace montelux
