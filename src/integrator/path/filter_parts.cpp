#include "integrator/path/filter_parts.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

// Of the numbers of a filter, for which points are tabulated.
constexpr std::uint32_t steps = 4096;
// Boxes have the error of their projection.
constexpr float rounding = 0.01f;

}  // namespace

FilterParts::FilterParts(const Filter& filter, std::uint32_t width, std::uint32_t height)
    : width_(width), height_(height), radius_(filter.radius()) {
  for (std::uint32_t i = 0; i < steps; ++i) {
    const float u = float(i) / float(steps);
    const Vec2f at = filter.sample(Vec2<float>{u, u}).offset;
    offsets_[0].push_back(at.x), offsets_[1].push_back(at.y);
  }
  offsets_[0].front() = -radius_.x, offsets_[1].front() = -radius_.y;
  offsets_[0].push_back(radius_.x), offsets_[1].push_back(radius_.y);
}

FilterParts::Range FilterParts::range(int axis, float low, float high) const {
  const std::vector<float>& offsets = offsets_[std::size_t(axis)];
  const auto first = std::upper_bound(offsets.begin(), offsets.end() - 1, low - rounding);
  const auto end = std::lower_bound(offsets.begin() + 1, offsets.end() - 1, high + rounding);
  const auto number = [&](std::ptrdiff_t i) { return float(std::max<std::ptrdiff_t>(i, 0)) / float(steps); };
  return {Number(std::floor(number(first - offsets.begin() - 1) * float(last))),
          Number(std::ceil(number(end - offsets.begin()) * float(last)))};
}

std::size_t FilterParts::add(const RasterBox& box) {
  if (parts_.empty()) parts_.resize(std::size_t(width_) * height_);
  // Along one axis: the pixels whose filters meet the box, the part of each, and those whose filters reach beyond it.
  // What is left out is within the box itself: a part that is all of a filter by the steps of the table may not be.
  struct Span {
    std::uint32_t first, end;
    std::vector<Range> ranges{};
    std::vector<std::uint32_t> all{}, beyond{};
    bool reaches_beyond(std::uint32_t i) const { return std::ranges::binary_search(beyond, i); }
  };
  const auto span_of = [&](int axis, float low, float high, float radius, std::uint32_t count) {
    const auto pixel = [&](float x) { return std::uint32_t(std::clamp(x, 0.0f, float(count))); };
    Span span{pixel(std::ceil(low - radius - rounding - 0.5f)), pixel(std::floor(high + radius + rounding + 0.5f))};
    for (std::uint32_t i = span.first; i < span.end; ++i) {
      const float centre = float(i) + 0.5f;
      span.ranges.push_back(range(axis, low - centre, high - centre)), span.all.push_back(i);
      if (centre - radius < low || centre + radius > high) span.beyond.push_back(i);
    }
    return span;
  };
  const Span columns = span_of(0, box.low.x, box.high.x, radius_.x, width_),
             rows = span_of(1, box.low.y, box.high.y, radius_.y, height_);
  std::size_t count = 0;
  for (std::uint32_t y = rows.first; y < rows.end; ++y) {
    const Range& row = rows.ranges[y - rows.first];
    const std::vector<std::uint32_t>& pixels = rows.reaches_beyond(y) ? columns.all : columns.beyond;
    for (const std::uint32_t x : pixels) {
      Part& part = parts_[std::size_t(y) * width_ + x];
      part.x.extend(columns.ranges[x - columns.first]), part.y.extend(row);
    }
    count += pixels.size();
  }
  return count;
}

}  // namespace montelux
