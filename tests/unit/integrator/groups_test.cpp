// How an image is split into groups of pixels.
#include "integrator/restir/groups.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "render/watch.h"

namespace montelux::test {
namespace {

const PixelBounds picture{3, 2, 40, 29};
constexpr std::size_t size = 6;

// An order that mixes; every seventh pixel has no vertex.
void put_in_order(std::span<PlacedPixel> pixels) {
  for (PlacedPixel& p : pixels) p.place = p.pixel * std::uint64_t(7919) % 1009;
}
bool exists(std::size_t pixel) { return pixel % 7 != 0; }

using Groups = std::set<std::set<std::uint32_t>>;
Groups all_groups(const ReuseBlocks& blocks, const std::vector<PixelBounds>& tiles) {
  Groups all;
  for (const PixelBounds& tile : tiles) {
    const PixelGroups groups = groups_of(blocks, picture, tile, size, exists, put_in_order);
    for (std::size_t i = 0; i < groups.count(); ++i)
      EXPECT_TRUE(all.insert({groups.group(i).begin(), groups.group(i).end()}).second);
  }
  return all;
}

TEST(PixelGroups, hold_every_pixel_with_a_vertex_once) {
  for (const ReuseBlocks& blocks :
       {ReuseBlocks(4, 0, {0, 0}), ReuseBlocks(5, 1.1, {0.3, 0.9}), ReuseBlocks(40, 4, {0.2, 0.7})}) {
    std::map<std::uint32_t, int> times;
    for (const auto& group : all_groups(blocks, tiles_of(picture, 16)))
      for (std::uint32_t pixel : group) ++times[pixel];
    for (std::uint32_t pixel = 0; pixel < std::uint32_t(picture.area()); ++pixel)
      EXPECT_EQ(times[pixel], exists(pixel) ? 1 : 0) << pixel;
  }
}

TEST(PixelGroups, are_the_same_whatever_the_tiles) {
  for (const ReuseBlocks& blocks : {ReuseBlocks(4, 0.4, {0.5, 0.8}), ReuseBlocks(7, 5.5, {0, 0.3})})
    EXPECT_EQ(all_groups(blocks, tiles_of(picture, 16)), all_groups(blocks, {picture}));
}

TEST(PixelGroups, lie_within_one_block_and_are_even) {
  const ReuseBlocks blocks(4, 0.9, {0.25, 0.5});
  std::map<std::pair<int, int>, std::set<std::size_t>> sizes;
  for (const auto& group : all_groups(blocks, tiles_of(picture, 16))) {
    std::set<std::pair<int, int>> places;
    for (std::uint32_t pixel : group) {
      const int x = picture.x0 + int(pixel) % picture.width(), y = picture.y0 + int(pixel) / picture.width();
      places.insert(blocks.block_of(x + 0.5, y + 0.5));
    }
    ASSERT_EQ(places.size(), 1u);
    EXPECT_LE(group.size(), size);
    sizes[*places.begin()].insert(group.size());
  }
  for (const auto& [block, of_block] : sizes) EXPECT_LE(*of_block.rbegin() - *of_block.begin(), 1u);
}

}  // namespace
}  // namespace montelux::test
