// How much of what clusters of lights can send arrives at each place, as a render has learned it.
#pragma once
#include <vector>

#include "light/bvh.h"
#include "light/direction_field.h"

namespace montelux {

// For every leaf of a PlaceTree a factor of the importance of each cluster of a LightBvh: small where what is expected
// of its lights is hidden. Immutable.
class ClusterField {
 public:
  // `factors`: positive; for each leaf of the tree as many as LightBvh::cluster_links has entries, of which the first
  // must be 1.
  ClusterField(PlaceTree tree, std::uint32_t clusters, std::vector<float> factors)
      : tree_(std::move(tree)), clusters_(clusters), factors_(std::move(factors)) {}

  // Those of the place, for LightBvh; p and n as PlaceTree::leaf_at takes them.
  template <class F>
  ClusterFactors<F> at(const Vec3<F>& p, const Vec3<F>& n, Mask<F> on) const {
    return {factors_.data(), tree_.leaf_at<F>(p, n, on) * Uint<F>(clusters_)};
  }
  std::size_t bytes() const { return 4 * (tree_.nodes.size() + factors_.size()); }

 private:
  PlaceTree tree_;
  std::uint32_t clusters_;
  std::vector<float> factors_;
};

}  // namespace montelux
