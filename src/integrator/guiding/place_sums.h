// Sums over what was learned at places, in the leaves of a tree that grows where much is learned.
#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "light/direction_field.h"

namespace montelux {

// Sums has `double records`, how many it is of; `std::size_t bytes()`, the memory it takes;
// `void add(const Sums&, double scale)`; and `void shrink_toward(const Sums& above)`, which adds what counts in it of
// the sums of what surrounds it.
template <class Sums>
class PlaceSums {
 public:
  // The cube of the tree holds most of the places; those beyond it belong to its border. `none`: of no records.
  PlaceSums(std::span<const Vec3f> places, Sums none);

  // Those of the leaf, as PlaceTree::leaf_at takes it.
  Sums& at(const Vec3f& p, const Vec3f& n) { return sums_[tree_.leaf_at<float>(p, n, true)]; }
  const PlaceTree& tree() const { return tree_; }
  std::size_t leaves() const { return sums_.size(); }
  // Leaves are halved until each has `records` records or fewer. The halves inherit half of the sums each: what
  // was learned of a leaf still counts, the less the more records follow. Where the leaves would need too much memory
  // they are halved at more records.
  void refine(double records);
  // Calls take(leaf, sums) for each leaf, whose sums are shrunk toward those that contain it, and these toward `above`.
  template <class Take>
  void for_each_leaf(const Sums& above, Take take) const;

 private:
  // Those of the leaves in each inner node, in `of_nodes`.
  const Sums& total(std::uint32_t node, std::vector<Sums>& of_nodes) const;
  template <class Take>
  void shrink(std::uint32_t node, const Sums& above, const std::vector<Sums>& of_nodes, Take& take) const;
  void split(std::uint32_t node, int depth, double having, double records);
  std::size_t max_leaves() const { return (std::size_t(1) << 28) / none_.bytes(); }

  PlaceTree tree_;
  Sums none_;
  std::vector<Sums> sums_;  // of the leaves
};

template <class Sums>
PlaceSums<Sums>::PlaceSums(std::span<const Vec3f> places, Sums none) : none_(std::move(none)) {
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
  sums_.assign(PlaceTree::classes, none_);
}

template <class Sums>
const Sums& PlaceSums<Sums>::total(std::uint32_t node, std::vector<Sums>& of_nodes) const {
  const std::uint32_t word = tree_.nodes[node];
  if (word >= PlaceTree::leaf) return sums_[word & ~PlaceTree::leaf];
  of_nodes[node] = none_;
  for (std::uint32_t k : {0u, 1u}) of_nodes[node].add(total(word + k, of_nodes), 1);
  return of_nodes[node];
}

template <class Sums>
template <class Take>
void PlaceSums<Sums>::shrink(std::uint32_t node, const Sums& above, const std::vector<Sums>& of_nodes,
                             Take& take) const {
  const std::uint32_t word = tree_.nodes[node];
  const bool is_leaf = word >= PlaceTree::leaf;
  Sums sums = is_leaf ? sums_[word & ~PlaceTree::leaf] : of_nodes[node];
  sums.shrink_toward(above);
  if (is_leaf) {
    take(word & ~PlaceTree::leaf, sums);
    return;
  }
  shrink(word, sums, of_nodes, take), shrink(word + 1, sums, of_nodes, take);
}

template <class Sums>
template <class Take>
void PlaceSums<Sums>::for_each_leaf(const Sums& above, Take take) const {
  std::vector<Sums> of_nodes(tree_.nodes.size());
  for (std::uint32_t root = 0; root < PlaceTree::classes; ++root) {
    total(root, of_nodes);
    shrink(root, above, of_nodes, take);
  }
}

template <class Sums>
void PlaceSums<Sums>::split(std::uint32_t node, int depth, double having, double records) {
  if (having <= records || depth == PlaceTree::max_depth || sums_.size() >= max_leaves()) return;
  const auto first = std::uint32_t(tree_.nodes.size());
  tree_.nodes.push_back(tree_.nodes[node]);
  tree_.nodes.push_back(PlaceTree::leaf | std::uint32_t(sums_.size()));
  sums_.push_back(none_);
  Sums& inherited = sums_[tree_.nodes[first] & ~PlaceTree::leaf];
  Sums half = none_;
  half.add(inherited, 0.5);
  inherited = sums_.back() = half;
  tree_.nodes[node] = first;
  for (std::uint32_t k : {0u, 1u}) split(first + k, depth + 1, having / 2, records);
}

template <class Sums>
void PlaceSums<Sums>::refine(double records) {
  double all = 0;
  for (const Sums& sums : sums_) all += sums.records;
  // Most leaves have more than a quarter of these.
  records = std::max(records, 4 * all / double(max_leaves()));
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

}  // namespace montelux
