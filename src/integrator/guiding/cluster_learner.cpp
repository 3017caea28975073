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
  return lights.hierarchy().cluster_links().size() + 1 + lights.beyond().size();
}

}  // namespace

void ClusterLearner::Sums::add(const Sums& other, double scale) {
  const auto by = float(scale);
  records += scale * other.records;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].count += by * other.nodes[i].count;
    nodes[i].first += by * other.nodes[i].first, nodes[i].second += by * other.nodes[i].second;
  }
}

void ClusterLearner::Sums::shrink_toward(const Sums& above) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const NodeSums& from = above.nodes[i];
    const float scale = prior_records / from.count;
    nodes[i].count += prior_records;
    nodes[i].first += scale * from.first, nodes[i].second += scale * from.second;
  }
}

ClusterLearner::ClusterLearner(std::span<const Vec3f> places, const LightSet& lights)
    : lights_(lights), sums_(places, {0, std::vector<NodeSums>(columns_of(lights))}), all_(columns_of(lights)) {}

void ClusterLearner::add_square(Sums& sums, std::size_t node, float ratio, bool arrives) {
  const float square = ratio * ratio;
  if (!is_finite(square)) return;
  sums.nodes[node].count += 1, sums.nodes[node].first += arrives ? square : 0.0f;
  all_[node].count += 1, all_[node].first += square;
}

void ClusterLearner::add(const ClusterRecord& r) {
  const LightBvh& bvh = lights_.hierarchy();
  const std::size_t of_whole = bvh.cluster_links().size();
  Sums& sums = sums_.at(r.p, r.n);
  sums.records += 1;
  if (lights_.is_beyond<float>(std::uint32_t(r.light), true)) {
    const auto j = std::size_t(std::ranges::find(lights_.beyond(), std::uint32_t(r.light)) - lights_.beyond().begin());
    add_square(sums, of_whole + 1 + j, r.contribution / (r.mass * lights_.beyond_irradiances()[j]), r.arrives);
    return;
  }
  add_square(sums, of_whole, r.contribution / (r.mass * bvh.irradiance<float>(r.p, r.n)), r.arrives);
  const LightBvh::Descent down = bvh.descend(r.light, r.p, r.n, [&](std::uint32_t node, float first, float second) {
    for (NodeSums* s : {&sums.nodes[node], &all_[node]}) s->count += 1, s->first += first, s->second += second;
  });
  add_square(sums, down.cluster, r.contribution / (down.mass * down.importance), r.arrives);
}

ClusterLearner::Sums ClusterLearner::unoccluded() const {
  const std::span<const std::uint32_t> links = lights_.hierarchy().cluster_links();
  NodeSums clusters;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i] == 0) clusters.count += all_[i].count, clusters.first += all_[i].first;
  const float usual = clusters.first > 0 ? clusters.first / clusters.count : 1.0f;
  Sums expected{1, std::vector<NodeSums>(all_.size())};
  for (std::size_t i = links.size(); i < all_.size(); ++i)
    expected.nodes[i] = {1, (all_[i].first + 1) / (all_[i].count + 1), 0};
  for (std::size_t i = 0; i < links.size(); ++i) {
    const NodeSums& a = all_[i];
    const float count = a.count + 1;
    expected.nodes[i] = links[i] == 0 ? NodeSums{1, (a.first + usual) / count, 0}
                                      : NodeSums{1, (a.first + 0.5f) / count, (a.second + 0.5f) / count};
  }
  return expected;
}

ClusterField ClusterLearner::field() const {
  const std::span<const std::uint32_t> links = lights_.hierarchy().cluster_links();
  const Sums expected = unoccluded();
  std::vector<float> factors(sums_.leaves() * all_.size());
  sums_.for_each_leaf(expected, [&](std::uint32_t leaf, const Sums& sums) {
    float* of_leaf = factors.data() + leaf * all_.size();
    for (std::size_t i = links.size(); i-- > 1;) {
      const NodeSums& s = sums.nodes[i];
      of_leaf[i] = links[i] == 0
                       ? std::max(std::sqrt(s.first / s.count), min_factor * std::sqrt(expected.nodes[i].first))
                       : (s.first * of_leaf[links[i]] + s.second * of_leaf[links[i] + 1]) / s.count;
    }
    if (!links.empty()) of_leaf[0] = 1;
    for (std::size_t i = links.size(); i < all_.size(); ++i)
      of_leaf[i] = std::sqrt(sums.nodes[i].first / sums.nodes[i].count);
  });
  return {sums_.tree(), std::uint32_t(links.size()), std::uint32_t(lights_.beyond().size()), std::move(factors)};
}

}  // namespace montelux
