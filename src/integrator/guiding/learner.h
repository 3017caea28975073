// Learns a field of directions from records of paths, or of shadow rays.
#pragma once
#include "integrator/guiding/place_sums.h"
#include "integrator/guiding/records.h"

namespace montelux {

template <class Field>
class DirectionLearner {
 public:
  // `places`: as PlaceSums takes them.
  explicit DirectionLearner(std::span<const Vec3f> places);

  void add(const GuideRecord& record);
  // What the records so far teach. The density of a cell is in proportion to the root of the mean square of what
  // records would have contributed through it (Rath et al. 2020, "Variance-Aware Path Guiding", eq. 10). The share of
  // the guide is that for which the records, weighed by importance, have the least mean square; they were drawn by
  // another guide than the one that they teach, but by one that is hardly better. Leaves with few records are shrunk
  // toward those that contain them.
  Field field() const { return Field(tree(), tables()); }
  const PlaceTree& tree() const { return sums_.tree(); }
  std::vector<typename Field::Table> tables() const;  // by leaf
  void refine(double records) { sums_.refine(records); }

 private:
  // At most a half: what only the BSDF finds then weighs twice as much as without a guide, not more.
  static constexpr std::array<float, 6> shares{0.0f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f};
  struct Sums {
    std::array<float, Field::cells> squares{};     // by cell
    std::array<double, shares.size()> by_share{};  // mean squares under each of these shares, times the records
    double records = 0, guided = 0;                // guided: of those drawn where there was a guide

    std::size_t bytes() const { return sizeof(Sums); }
    void add(const Sums& other, double scale);
    void shrink_toward(const Sums& above);
  };
  typename Field::Table table_of(const Sums& sums) const;

  // A cell more on every side of the square, which is the one that lies there on the sphere.
  static constexpr std::size_t padded_side = Field::side + 2;
  std::array<std::uint32_t, padded_side * padded_side> padded_cells_;
  PlaceSums<Sums> sums_;
};

using GuideLearner = DirectionLearner<GuideField>;
using SkyLearner = DirectionLearner<SkyDirections>;
extern template class DirectionLearner<GuideField>;
extern template class DirectionLearner<SkyDirections>;

}  // namespace montelux
