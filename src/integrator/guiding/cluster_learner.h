// Learns a field of clusters of lights from shadow rays.
#pragma once
#include "integrator/guiding/place_sums.h"
#include "light/cluster_field.h"
#include "light/light_set.h"

namespace montelux {

// A light that was chosen at a place by the hierarchy, or among the lights without a place, and a direction toward it.
struct ClusterRecord {
  Vec3f p, n;  // as PlaceTree::leaf_at takes them
  LightId light{};
  float mass;          // of its choice there: by the hierarchy; 1 for a light without a place
  float contribution;  // if nothing is in the way: irradiance over the density of the direction, the light being given
  bool arrives;        // nothing is
};

// What a cluster contributes at places of a leaf varies with visibility, and with how well its importance estimates it.
// Its factor is the root of the mean square of contribution over importance, with which probabilities give the least
// variance; so are the factors of the whole hierarchy and of each light without a place. Where few rays were traced to
// it, leaves are shrunk toward those that contain them, and these toward what is expected where nothing is in the way.
// A node with children has the factor with which its importance is the sum of theirs.
class ClusterLearner {
 public:
  // `places`: as PlaceSums takes them. The lights are chosen by a hierarchy, and must outlive this.
  ClusterLearner(std::span<const Vec3f> places, const LightSet& lights);

  void add(const ClusterRecord& record);
  void refine(double records) { sums_.refine(records); }
  ClusterField field() const;

 private:
  struct Sum {
    float count = 0, sum = 0;
    float mean() const { return sum / count; }
    void add(float x) { count += 1, sum += x; }
    void add(const Sum& other, float scale) { count += scale * other.count, sum += scale * other.sum; }
    void shrink_toward(float value, float records) { count += records, sum += records * value; }
  };
  // Of one node, by its number; and, after all numbers, of the whole hierarchy and of each light without a place.
  struct NodeSums {
    Sum square;  // of contribution over importance, of what is not divided
    Sum part;    // of a child: its importance over that of its parent, whenever that was passed
  };
  struct Sums {
    double records = 0;
    std::vector<NodeSums> nodes;

    std::size_t bytes() const { return sizeof(Sums) + nodes.size() * sizeof(NodeSums); }
    void add(const Sums& other, double scale);
    void shrink_toward(const Sums& above);
  };
  // What is expected of one record of each node where nothing is in the way.
  Sums unoccluded() const;
  void add_square(Sums& sums, std::size_t node, float ratio, bool arrives);

  const LightSet& lights_;
  PlaceSums<Sums> sums_;
  std::vector<NodeSums> all_;  // of all places, as if nothing were in the way
};

}  // namespace montelux
