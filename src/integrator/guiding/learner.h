// Learns a field for path guiding from records of paths.
#pragma once
#include "integrator/guiding/records.h"

namespace montelux {

// Sums over records, in the leaves of a tree that grows where many of them are.
template <class Field>
class DirectionLearner {
 public:
  // The cube holds most of the places; those beyond it belong to its border.
  explicit DirectionLearner(std::span<const Vec3f> places);

  void add(const GuideRecord& record);
  // What the records so far teach. The density of a cell is in proportion to the root of the mean square of what
  // records would have contributed through it (Rath et al. 2020, "Variance-Aware Path Guiding", eq. 10). The share of
  // the guide is that for which the records, weighed by importance, have the least mean square; they were drawn by
  // another guide than the one that they teach, but by one that is hardly better. Leaves with few records are shrunk
  // toward those that contain them.
  Field field() const { return Field(tree_, tables()); }
  const PlaceTree& tree() const { return tree_; }
  std::vector<typename Field::Table> tables() const;  // by leaf
  // Leaves are halved until each has `records` records or fewer. The halves inherit half of the sums each: what
  // was learned of a leaf still counts, the less the more records follow.
  void refine(double records);

 private:
  // At most a half: what only the BSDF finds then weighs twice as much as without a guide, not more.
  static constexpr std::array<float, 6> shares{0.0f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f};
  struct Sums {
    std::array<float, Field::cells> squares{};     // by cell
    std::array<double, shares.size()> by_share{};  // mean squares under each of these shares, times the records
    double records = 0, guided = 0;                // guided: of those drawn where there was a guide

    void add(const Sums& other, double scale = 1);
  };
  Sums total(std::uint32_t node, std::vector<Sums>& of_nodes) const;
  void make_tables(std::uint32_t node, const Sums& above, const std::vector<Sums>& of_nodes,
                   std::vector<typename Field::Table>& tables) const;
  static typename Field::Table table_of(const Sums& sums);
  void split(std::uint32_t node, int depth, double having, double records);

  PlaceTree tree_;
  std::vector<Sums> sums_;  // of the leaves
};

using GuideLearner = DirectionLearner<GuideField>;
using SkyLearner = DirectionLearner<SkyDirections>;
extern template class DirectionLearner<GuideField>;
extern template class DirectionLearner<SkyDirections>;

}  // namespace montelux
