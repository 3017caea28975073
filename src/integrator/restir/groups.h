// Which pixels share all of their samples: each round splits the image into square blocks in a new way, and the
// pixels of each block into groups at random.
#pragma once
#include <algorithm>
#include <cmath>
#include <compare>
#include <span>
#include <utility>
#include <vector>

#include "integrator/restir/pixels.h"

namespace montelux {

// Numbers of pixels in the picture, group by group.
struct PixelGroups {
  std::size_t size;  // most pixels of a group
  std::vector<std::uint32_t> members;
  std::vector<std::uint32_t> begins;  // of each group in `members`, and at last the end

  std::size_t count() const { return begins.size() - 1; }
  std::span<const std::uint32_t> group(std::size_t i) const {
    return std::span(members).subspan(begins[i], begins[i + 1] - begins[i]);
  }
};

// The blocks of one round: squares of `side` pixels, at any angle, so that what the pixels of a block have in common
// draws no pattern.
class ReuseBlocks {
 public:
  using Block = std::pair<int, int>;
  // `shift` in blocks, `angle` in radians.
  ReuseBlocks(double side, double angle, Vec2<double> shift)
      : side_(side), cosine_(std::cos(angle)), sine_(std::sin(angle)), shift_(shift) {}

  Block block_of(double x, double y) const {
    return {int(std::floor((cosine_ * x + sine_ * y) / side_ + shift_.x)),
            int(std::floor((cosine_ * y - sine_ * x) / side_ + shift_.y))};
  }
  Vec2<double> centre(const Block& block) const {
    const double u = (block.first + 0.5 - shift_.x) * side_, v = (block.second + 0.5 - shift_.y) * side_;
    return {cosine_ * u - sine_ * v, sine_ * u + cosine_ * v};
  }
  // A block lies within this distance of its centre, along either axis.
  double reach() const { return 0.7072 * side_; }

 private:
  double side_, cosine_, sine_;
  Vec2<double> shift_;
};

// Calls f(block) for every block whose centre, moved into the picture, lies in `tile`: each block with pixels of the
// picture belongs to one tile.
template <class Function>
void for_each_block(const ReuseBlocks& blocks, const PixelBounds& picture, const PixelBounds& tile, Function f) {
  const double reach = blocks.reach();
  ReuseBlocks::Block low{1 << 30, 1 << 30}, high{-(1 << 30), -(1 << 30)};
  for (double x : {tile.x0 - reach, tile.x1 + reach})
    for (double y : {tile.y0 - reach, tile.y1 + reach}) {
      const ReuseBlocks::Block corner = blocks.block_of(x, y);
      low = {std::min(low.first, corner.first), std::min(low.second, corner.second)};
      high = {std::max(high.first, corner.first), std::max(high.second, corner.second)};
    }
  for (int i = low.first; i <= high.first; ++i)
    for (int j = low.second; j <= high.second; ++j) {
      const Vec2<double> centre = blocks.centre({i, j});
      const int x = std::clamp(int(std::floor(centre.x)), picture.x0, picture.x1 - 1);
      const int y = std::clamp(int(std::floor(centre.y)), picture.y0, picture.y1 - 1);
      if (x >= tile.x0 && x < tile.x1 && y >= tile.y0 && y < tile.y1) f(ReuseBlocks::Block{i, j});
    }
}

// A pixel of a block: its number in the picture, and its place in the order of the block.
struct PlacedPixel {
  std::uint64_t place;
  std::uint32_t pixel;
  auto operator<=>(const PlacedPixel&) const = default;
};

// The groups of the blocks that belong to `tile`, of pixels for which has_vertex(pixel) holds. put_in_order(pixels)
// states the place of each: any number that does not depend on what was found there.
template <class HasVertex, class PutInOrder>
PixelGroups groups_of(const ReuseBlocks& blocks, const PixelBounds& picture, const PixelBounds& tile, std::size_t size,
                      HasVertex has_vertex, PutInOrder put_in_order) {
  PixelGroups groups{size, {}, {0}};
  std::vector<PlacedPixel> pixels;
  for_each_block(blocks, picture, tile, [&](const ReuseBlocks::Block& block) {
    const Vec2<double> centre = blocks.centre(block);
    const double reach = blocks.reach();
    const auto first = [&](double c, int low) { return std::max(int(std::floor(c - reach)), low); };
    const auto last = [&](double c, int high) { return std::min(int(std::ceil(c + reach)), high); };
    pixels.clear();
    for (int y = first(centre.y, picture.y0); y < last(centre.y, picture.y1); ++y)
      for (int x = first(centre.x, picture.x0); x < last(centre.x, picture.x1); ++x) {
        const std::size_t pixel = pixel_number(picture, x, y);
        if (has_vertex(pixel) && blocks.block_of(x + 0.5, y + 0.5) == block)
          pixels.push_back({0, std::uint32_t(pixel)});
      }
    put_in_order(std::span(pixels));
    std::sort(pixels.begin(), pixels.end());
    // As even as can be.
    const std::size_t parts = (pixels.size() + size - 1) / size;
    for (std::size_t part = 0, begin = 0; part < parts; ++part) {
      const std::size_t end = pixels.size() * (part + 1) / parts;
      for (; begin < end; ++begin) groups.members.push_back(pixels[begin].pixel);
      groups.begins.push_back(std::uint32_t(groups.members.size()));
    }
  });
  return groups;
}

}  // namespace montelux
