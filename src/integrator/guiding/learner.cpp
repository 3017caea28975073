#include "integrator/guiding/learner.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

// As many records of what surrounds a leaf count in it as its own.
constexpr double prior_records = 64;
// A guide that lowers the mean square by less is not used: it costs time.
constexpr double min_gain = 0.1;

}  // namespace

template <class Field>
DirectionLearner<Field>::DirectionLearner(std::span<const Vec3f> places) : sums_(places, {}) {
  constexpr auto side = std::uint32_t(Field::side);
  const auto inside = [](std::size_t padded) { return (float(padded) - 0.5f) / float(side); };
  const auto part = [](float t) { return std::min(std::uint32_t(t * float(side)), side - 1); };
  for (std::size_t y = 0; y < padded_side; ++y)
    for (std::size_t x = 0; x < padded_side; ++x) {
      const Vec2f at = wrap_sphere_square(Vec2f{inside(x), inside(y)});
      padded_cells_[y * padded_side + x] = part(at.y) * side + part(at.x);
    }
}

template <class Field>
void DirectionLearner<Field>::Sums::add(const Sums& other, double scale) {
  for (std::size_t c = 0; c < squares.size(); ++c) squares[c] += float(scale) * other.squares[c];
  for (std::size_t k = 0; k < by_share.size(); ++k) by_share[k] += scale * other.by_share[k];
  records += scale * other.records, guided += scale * other.guided;
}

template <class Field>
void DirectionLearner<Field>::Sums::shrink_toward(const Sums& above) {
  if (above.records > 0) add(above, prior_records / above.records);
}

template <class Field>
void DirectionLearner<Field>::add(const GuideRecord& r) {
  Sums& sums = sums_.at(r.p, r.n);
  sums.records += 1;
  if (r.share > 0) sums.guided += 1;
  const float drawn = r.mixture(), square = r.light * r.light * drawn;
  if (!(square > 0) || !is_finite(square)) return;
  sums.squares[Field::cell_of(r.wi)] += square;
  for (std::size_t k = 0; k < shares.size(); ++k)
    sums.by_share[k] += double(square) / double((1 - shares[k]) * r.bsdf + shares[k] * r.guide);
}

template <class Field>
typename Field::Table DirectionLearner<Field>::table_of(const Sums& sums) const {
  constexpr std::size_t side = Field::side;
  typename Field::Table table;
  std::array<float, padded_side * padded_side> squares;
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = sums.squares[padded_cells_[i]];
  // Cells pass some of their squares to their neighbours: light that comes through the border of a cell comes through
  // the next one elsewhere in the leaf.
  constexpr float weights[] = {0.125f, 0.75f, 0.125f};
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x) {
      float square = 0;
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) square += weights[i] * weights[j] * squares[(y + j) * padded_side + x + i];
      table.weights[y * side + x] = std::sqrt(square);
    }
  const double best = *std::ranges::min_element(sums.by_share);
  if (sums.guided == 0) {
    table.share = best > 0 || sums.by_share[0] > 0 ? 0.5f : 0.0f;
  } else if (best < (1 - min_gain) * sums.by_share[0]) {
    table.share = shares[std::size_t(std::ranges::min_element(sums.by_share) - sums.by_share.begin())];
  }
  return table;
}

template <class Field>
std::vector<typename Field::Table> DirectionLearner<Field>::tables() const {
  std::vector<typename Field::Table> tables(sums_.leaves());
  sums_.for_each_leaf({}, [&](std::uint32_t leaf, const Sums& sums) { tables[leaf] = table_of(sums); });
  return tables;
}

template class DirectionLearner<GuideField>;
template class DirectionLearner<SkyDirections>;

}  // namespace montelux
