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
void DirectionLearner<Field>::Sums::add(const Sums& other, double scale) {
  for (std::size_t c = 0; c < squares.size(); ++c) squares[c] += float(scale) * other.squares[c];
  for (std::size_t k = 0; k < by_share.size(); ++k) by_share[k] += scale * other.by_share[k];
  records += scale * other.records, guided += scale * other.guided;
}

template <class Field>
DirectionLearner<Field>::DirectionLearner(std::span<const Vec3f> places) {
  std::array<float Vec3f::*, 3> axes{&Vec3f::x, &Vec3f::y, &Vec3f::z};
  Vec3f high{1, 1, 1};
  std::vector<float> along(places.size());
  tree_.size = 0;
  for (float Vec3f::*axis : axes) {
    if (places.empty()) break;
    for (std::size_t i = 0; i < places.size(); ++i) along[i] = places[i].*axis;
    std::ranges::sort(along);
    // Without the two ends, where a few places may be far away.
    const std::size_t cut = along.size() / 200;
    tree_.low.*axis = along[cut], high.*axis = along[along.size() - 1 - cut];
    tree_.size = std::max(tree_.size, high.*axis - tree_.low.*axis);
  }
  // A little more, so that the faces of the cube are no surfaces.
  tree_.size = std::max(tree_.size * 1.0371f, 1e-6f);
  for (float Vec3f::*axis : axes) tree_.low.*axis -= 0.0173f * tree_.size;
  for (std::uint32_t c = 0; c < PlaceTree::classes; ++c) tree_.nodes[c] = PlaceTree::leaf | c;
  sums_.resize(PlaceTree::classes);
}

template <class Field>
void DirectionLearner<Field>::add(const GuideRecord& r) {
  Sums& sums = sums_[tree_.leaf_at<float>(r.p, r.n, true)];
  sums.records += 1;
  if (r.share > 0) sums.guided += 1;
  const float drawn = r.mixture(), square = r.light * r.light * drawn;
  if (!(square > 0) || !is_finite(square)) return;
  sums.squares[Field::cell_of(r.wi)] += square;
  for (std::size_t k = 0; k < shares.size(); ++k)
    sums.by_share[k] += double(square) / double((1 - shares[k]) * r.bsdf + shares[k] * r.guide);
}

template <class Field>
typename DirectionLearner<Field>::Sums DirectionLearner<Field>::total(std::uint32_t node,
                                                                      std::vector<Sums>& of_nodes) const {
  const std::uint32_t word = tree_.nodes[node];
  Sums sums;
  if (word >= PlaceTree::leaf) {
    sums = sums_[word & ~PlaceTree::leaf];
  } else {
    sums.add(total(word, of_nodes)), sums.add(total(word + 1, of_nodes));
  }
  return of_nodes[node] = sums;
}

template <class Field>
typename Field::Table DirectionLearner<Field>::table_of(const Sums& sums) {
  constexpr auto side = int(Field::side);
  typename Field::Table table;
  // Cells pass some of their squares to their neighbours: light that comes through the border of a cell comes through
  // the next one elsewhere in the leaf.
  const auto from = [&](int x, int y) {
    const Vec2f at = wrap_sphere_square(Vec2f{(float(x) + 0.5f) / float(side), (float(y) + 0.5f) / float(side)});
    const auto part = [&](float t) { return std::min(int(t * float(side)), side - 1); };
    return sums.squares[std::size_t(part(at.y) * side + part(at.x))];
  };
  constexpr float weights[] = {0.125f, 0.75f, 0.125f};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      float square = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) square += weights[i + 1] * weights[j + 1] * from(x + i, y + j);
      table.weights[std::size_t(y * side + x)] = std::sqrt(square);
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
void DirectionLearner<Field>::make_tables(std::uint32_t node, const Sums& above, const std::vector<Sums>& of_nodes,
                                          std::vector<typename Field::Table>& tables) const {
  Sums sums = of_nodes[node];
  if (above.records > 0) sums.add(above, prior_records / above.records);
  const std::uint32_t word = tree_.nodes[node];
  if (word >= PlaceTree::leaf) {
    tables[word & ~PlaceTree::leaf] = table_of(sums);
    return;
  }
  make_tables(word, sums, of_nodes, tables), make_tables(word + 1, sums, of_nodes, tables);
}

template <class Field>
std::vector<typename Field::Table> DirectionLearner<Field>::tables() const {
  std::vector<Sums> of_nodes(tree_.nodes.size());
  std::vector<typename Field::Table> tables(sums_.size());
  for (std::uint32_t root = 0; root < PlaceTree::classes; ++root) {
    total(root, of_nodes);
    make_tables(root, {}, of_nodes, tables);
  }
  return tables;
}

template <class Field>
void DirectionLearner<Field>::split(std::uint32_t node, int depth, double having, double records) {
  if (having <= records || depth == PlaceTree::max_depth) return;
  const auto first = std::uint32_t(tree_.nodes.size());
  tree_.nodes.push_back(tree_.nodes[node]);
  tree_.nodes.push_back(PlaceTree::leaf | std::uint32_t(sums_.size()));
  sums_.emplace_back();
  Sums& inherited = sums_[tree_.nodes[first] & ~PlaceTree::leaf];
  Sums half;
  half.add(inherited, 0.5);
  inherited = sums_.back() = half;
  tree_.nodes[node] = first;
  for (std::uint32_t k : {0u, 1u}) split(first + k, depth + 1, having / 2, records);
}

template <class Field>
void DirectionLearner<Field>::refine(double records) {
  struct Open {
    std::uint32_t node;
    int depth;
  };
  std::vector<Open> open;
  for (std::uint32_t root = 0; root < PlaceTree::classes; ++root) open.push_back({root, 0});
  while (!open.empty()) {
    const auto [node, depth] = open.back();
    open.pop_back();
    const std::uint32_t word = tree_.nodes[node];
    if (word >= PlaceTree::leaf)
      split(node, depth, sums_[word & ~PlaceTree::leaf].records, records);
    else
      for (std::uint32_t k : {0u, 1u}) open.push_back({word + k, depth + 1});
  }
}

template class DirectionLearner<GuideField>;
template class DirectionLearner<SkyDirections>;

}  // namespace montelux
