// Parts of the filters of pixels.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "filter/filter.h"
#include "math/lanes.h"
#include "math/vec.h"

namespace montelux {

// A rectangle of a picture, in pixels.
struct RasterBox {
  Vec2f low, high;
  Vec2f size() const { return high - low; }
};

// The part of a pixel's filter whose points the numbers low + size u make, with u in [0, 1)^2: a rectangle. Points are
// in proportion to the filter there as well, and have `mass` times its weight.
template <class F>
struct FilterPart {
  Vec2<F> low{F(0.0f), F(0.0f)}, size{F(1.0f), F(1.0f)};
  F mass() const { return size.x * size.y; }
};

// For each pixel, a part of its filter that contains all boxes that it meets.
class FilterParts {
 public:
  // Of a picture of this size. As long as no box is added, the part of each pixel is all of its filter.
  FilterParts(const Filter& filter, std::uint32_t width, std::uint32_t height);

  // Pixels whose filters are within the box are left out: make_whole(). Returns the number of the others, to which the
  // time is in proportion.
  std::size_t add(const RasterBox& box);
  // The part of this pixel is all of its filter.
  void make_whole(std::size_t pixel) {
    if (!parts_.empty()) parts_[pixel] = {{0, last}, {0, last}};
  }

  // Lanes that are off, and pixels that no box meets, have some part.
  template <class F>
  FilterPart<F> of(const Uint<F>& x, const Uint<F>& y, Mask<F> on) const;

 private:
  using Number = std::uint16_t;
  static constexpr Number last = 0xffff;  // stands for 1
  struct Range {
    Number low = last, high = 0;
    void extend(const Range& other) { low = std::min(low, other.low), high = std::max(high, other.high); }
  };
  struct Part {
    Range x, y;
  };

  // The numbers along an axis that make points from `low` to `high`, from the pixel's centre.
  Range range(int axis, float low, float high) const;

  std::uint32_t width_, height_;
  Vec2f radius_;
  std::array<std::vector<float>, 2> offsets_;  // along x and y: the filter's point of each of equidistant numbers
  std::vector<Part> parts_;
};

template <class F>
FilterPart<F> FilterParts::of(const Uint<F>& x, const Uint<F>& y, Mask<F> on) const {
  FilterPart<F> part;
  if (parts_.empty()) return part;
  for_each_lane(on, [&](int k) {
    const Part& p = parts_[std::size_t(lane(y, k)) * width_ + lane(x, k)];
    constexpr float scale = 1.0f / float(last);
    set_lane(part.low.x, k, float(p.x.low) * scale), set_lane(part.low.y, k, float(p.y.low) * scale);
    set_lane(part.size.x, k, float(p.x.high - p.x.low) * scale);
    set_lane(part.size.y, k, float(p.y.high - p.y.low) * scale);
  });
  return part;
}

}  // namespace montelux
