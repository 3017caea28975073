// Which pixels share all that they have found: the picture is parted into square blocks, at another place in every
// round, and the pixels of each block into groups at random.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "integrator/restir/pixels.h"
#include "integrator/restir/vertex.h"

namespace montelux {

// Numbers of pixels in the picture, group by group.
struct PixelGroups {
  std::size_t size;  // most pixels of a group
  std::vector<std::uint32_t> members;
  std::vector<std::uint32_t> begins;  // of each group in `members`, and at last the end

  std::size_t count() const { return begins.empty() ? 0 : begins.size() - 1; }
  std::span<const std::uint32_t> group(std::size_t i) const {
    return std::span(members).subspan(begins[i], begins[i + 1] - begins[i]);
  }
};

// The blocks of one round: squares of `side` pixels, the first of which begins (x, y) pixels before the origin.
struct ReuseBlocks {
  int side, x, y;
};

// Groups of all blocks whose first pixel inside the picture lies in `tile`: every block belongs to one tile. key(pixel,
// x, y) is the pixel's place in the order of its block: any number that does not depend on what was found there,
// nothing where the pixel has no vertex.
template <class Key>
PixelGroups groups_of(const ReuseBlocks& blocks, const PixelBounds& picture, const PixelBounds& tile, std::size_t size,
                      Key key) {
  PixelGroups groups{size, {}, {0}};
  std::vector<std::pair<std::uint64_t, std::uint32_t>> pixels;
  const auto first_block = [&](int low, int offset) { return (low + offset) / blocks.side * blocks.side - offset; };
  for (int y = first_block(tile.y0, blocks.y); y < tile.y1; y += blocks.side)
    for (int x = first_block(tile.x0, blocks.x); x < tile.x1; x += blocks.side) {
      if (std::max(x, picture.x0) < tile.x0 || std::max(y, picture.y0) < tile.y0) continue;
      pixels.clear();
      for (int at_y = std::max(y, picture.y0); at_y < std::min(y + blocks.side, picture.y1); ++at_y)
        for (int at_x = std::max(x, picture.x0); at_x < std::min(x + blocks.side, picture.x1); ++at_x) {
          const std::size_t pixel = pixel_number(picture, at_x, at_y);
          if (const auto k = key(pixel, at_x, at_y)) pixels.emplace_back(*k, std::uint32_t(pixel));
        }
      std::sort(pixels.begin(), pixels.end());
      // As even as can be.
      const std::size_t parts = (pixels.size() + size - 1) / size;
      for (std::size_t part = 0, begin = 0; part < parts; ++part) {
        const std::size_t end = pixels.size() * (part + 1) / parts;
        for (; begin < end; ++begin) groups.members.push_back(pixels[begin].second);
        groups.begins.push_back(std::uint32_t(groups.members.size()));
      }
    }
  return groups;
}

}  // namespace montelux
