#include "integrator/guiding/cluster_learner.h"

#include <cmath>

namespace montelux {

namespace {

// So many records of what surrounds a leaf count in it, for each node.
constexpr float prior_records = 4;
// The factor of a cluster that no ray has reached is not smaller than this, as a part of what is expected of it where
// nothing is in the way.
constexpr float min_factor = 0.4f;

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

ClusterLearner::ClusterLearner(std::span<const Vec3f> places, const LightBvh& lights)
    : lights_(lights),
      sums_(places, {0, std::vector<NodeSums>(lights.cluster_links().size())}),
      all_(lights.cluster_links().size()) {}

void ClusterLearner::add(const ClusterRecord& r) {
  Sums& sums = sums_.at(r.p, r.n);
  sums.records += 1;
  const LightBvh::Descent down = lights_.descend(r.light, r.p, r.n, [&](std::uint32_t node, float first, float second) {
    for (NodeSums* s : {&sums.nodes[node], &all_[node]}) s->count += 1, s->first += first, s->second += second;
  });
  const float ratio = r.contribution / (down.mass * down.importance), square = ratio * ratio;
  if (!is_finite(square)) return;
  NodeSums& own = sums.nodes[down.cluster];
  own.count += 1, own.first += r.arrives ? square : 0.0f;
  all_[down.cluster].count += 1, all_[down.cluster].first += square;
}

ClusterLearner::Sums ClusterLearner::unoccluded() const {
  const std::span<const std::uint32_t> links = lights_.cluster_links();
  NodeSums clusters;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i] == 0) clusters.count += all_[i].count, clusters.first += all_[i].first;
  const float usual = clusters.first > 0 ? clusters.first / clusters.count : 1.0f;
  Sums expected{1, std::vector<NodeSums>(links.size())};
  for (std::size_t i = 0; i < links.size(); ++i) {
    const NodeSums& a = all_[i];
    const float count = a.count + 1;
    expected.nodes[i] = links[i] == 0 ? NodeSums{1, (a.first + usual) / count, 0}
                                      : NodeSums{1, (a.first + 0.5f) / count, (a.second + 0.5f) / count};
  }
  return expected;
}

ClusterField ClusterLearner::field() const {
  const std::span<const std::uint32_t> links = lights_.cluster_links();
  const Sums expected = unoccluded();
  std::vector<float> factors(sums_.leaves() * links.size());
  sums_.for_each_leaf(expected, [&](std::uint32_t leaf, const Sums& sums) {
    float* of_leaf = factors.data() + leaf * links.size();
    for (std::size_t i = links.size(); i-- > 1;) {
      const NodeSums& s = sums.nodes[i];
      of_leaf[i] = links[i] == 0
                       ? std::max(std::sqrt(s.first / s.count), min_factor * std::sqrt(expected.nodes[i].first))
                       : (s.first * of_leaf[links[i]] + s.second * of_leaf[links[i] + 1]) / s.count;
    }
    of_leaf[0] = 1;
  });
  return {sums_.tree(), std::uint32_t(links.size()), std::move(factors)};
}

}  // namespace montelux
