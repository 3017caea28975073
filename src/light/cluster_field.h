// How much of what clusters of lights can send arrives at each place, as a render has learned it.
#pragma once
#include <vector>

#include "light/bvh.h"
#include "light/direction_field.h"

namespace montelux {

// For every leaf of a PlaceTree a factor of the importance of each cluster of a LightBvh: small where what is expected
// of its lights is hidden; and factors of the irradiance that is expected from the whole hierarchy, and from each light
// without a place. Immutable.
class ClusterField {
 public:
  // `factors`: positive; for each leaf of the tree as many as LightBvh::numbered_nodes has entries, of which the first
  // must be 1; then one for LightBvh::irradiance, and one for each light of LightSet::beyond, of which there are so
  // many.
  ClusterField(PlaceTree tree, std::uint32_t clusters, std::uint32_t beyond, std::vector<float> factors)
      : tree_(std::move(tree)), clusters_(clusters), columns_(clusters + 1 + beyond), factors_(std::move(factors)) {}

  // Those of the place, for LightBvh; p and n as PlaceTree::leaf_at takes them.
  template <class F>
  ClusterFactors<F> at(const Vec3<F>& p, const Vec3<F>& n, Mask<F> on) const {
    const Uint<F> first = tree_.leaf_at<F>(p, n, on) * Uint<F>(columns_);
    return {factors_.data(), first, first + Uint<F>(clusters_)};
  }
  std::size_t bytes() const { return 4 * (tree_.nodes.size() + factors_.size()); }

 private:
  PlaceTree tree_;
  std::uint32_t clusters_, columns_;
  std::vector<float> factors_;
};

}  // namespace montelux
