// Parts of filters: they contain all of a filter's points in the boxes, and little else.
#include "integrator/path/filter_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace montelux {
namespace {

constexpr std::uint32_t width = 24, height = 18;

Filter filter_of(FilterKind kind) { return Filter::build(FilterDesc::usual(kind)); }

RasterBox random_box(std::mt19937& numbers, float largest) {
  std::uniform_real_distribution<float> uniform;
  const Vec2f low{uniform(numbers) * 28 - 2, uniform(numbers) * 22 - 2};
  return {low, {low.x + uniform(numbers) * largest, low.y + uniform(numbers) * largest}};
}

FilterPart<float> part_of(const FilterParts& parts, std::uint32_t x, std::uint32_t y) {
  return parts.of<float>(Uint<float>(x), Uint<float>(y), Mask<float>(true));
}

// The integral of a filter's weight over the part of a box that a pixel has, by its values.
double integral(const Filter& filter, const RasterBox& box, std::uint32_t x, std::uint32_t y) {
  const Vec2f centre{float(x) + 0.5f, float(y) + 0.5f}, radius = filter.radius();
  const double x0 = std::max(box.low.x - centre.x, -radius.x), x1 = std::min(box.high.x - centre.x, radius.x),
               y0 = std::max(box.low.y - centre.y, -radius.y), y1 = std::min(box.high.y - centre.y, radius.y);
  if (x0 >= x1 || y0 >= y1) return 0;
  constexpr int points = 60;
  double sum = 0;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j)
      sum += double(filter.evaluate(
          Vec2<float>{float(x0 + (x1 - x0) * (i + 0.5) / points), float(y0 + (y1 - y0) * (j + 0.5) / points)}));
  return sum * (x1 - x0) * (y1 - y0) / (points * points);
}

constexpr int grid = 300;  // points along both axes of a part

// How far by_part() may be off. Each of the four edges of a box may be half a row of its points off. The sum of
// integral() has an error of its own, of 60 points along an axis; and where a filter changes its sign the weight of its
// points jumps from cell to cell of its table of 1024, of which a grid sees a part.
double rounding(FilterKind kind, const Filter& filter, double expected, const FilterPart<float>& part) {
  const bool is_signed = kind == FilterKind::mitchell || kind == FilterKind::sinc;
  const double weight = std::abs(double(filter.sample(Vec2<float>{0.5f, 0.5f}).weight));  // the largest
  return 4 * 0.5 / grid * weight * double(part.mass()) + (is_signed ? 0.02 : 0.002) * std::abs(expected);
}

// The same by points of a part of the filter, as rays for lamps take them. `shrunk`: the part is so much smaller.
double by_part(const Filter& filter, FilterPart<float> part, const RasterBox& box, std::uint32_t x, std::uint32_t y,
               float shrunk = 1) {
  part.size = part.size * shrunk;
  double sum = 0;
  for (int i = 0; i < grid; ++i)
    for (int j = 0; j < grid; ++j) {
      const Vec2<float> u{part.low.x + part.size.x * (float(i) + 0.5f) / grid,
                          part.low.y + part.size.y * (float(j) + 0.5f) / grid};
      const FilterSample<float> s = filter.sample(u);
      const float at_x = float(x) + 0.5f + s.offset.x, at_y = float(y) + 0.5f + s.offset.y;
      if (at_x >= box.low.x && at_x < box.high.x && at_y >= box.low.y && at_y < box.high.y) sum += double(s.weight);
    }
  return sum * double(part.mass()) / (grid * grid);
}

TEST(FilterParts, have_the_light_of_a_box) {
  std::mt19937 numbers(5);
  std::uniform_int_distribution<std::uint32_t> columns(0, width - 1), rows(0, height - 1);
  int found = 0, lost = 0;
  for (const FilterKind kind :
       {FilterKind::box, FilterKind::gaussian, FilterKind::mitchell, FilterKind::sinc, FilterKind::triangle}) {
    const Filter filter = filter_of(kind);
    for (int test = 0; test < 30; ++test) {
      const RasterBox box = random_box(numbers, 6), other = random_box(numbers, 2);
      FilterParts parts(filter, width, height);
      parts.add(box), parts.add(other);
      for (int pixel = 0; pixel < 40; ++pixel) {
        const std::uint32_t x = columns(numbers), y = rows(numbers);
        const double expected = integral(filter, box, x, y);
        if (std::abs(expected) < 1e-3) continue;
        const FilterPart<float> part = part_of(parts, x, y);
        const double near = rounding(kind, filter, expected, part);
        EXPECT_NEAR(by_part(filter, part, box, x, y), expected, near);
        lost += std::abs(by_part(filter, part, box, x, y, 0.8f) - expected) > near;
        ++found;
      }
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(lost, found / 4);  // of a smaller part
}

// A small lamp before a large one: all pixels have the light of the large one, also those just within its edges.
TEST(FilterParts, have_the_light_of_a_box_around_another) {
  for (const FilterKind kind : {FilterKind::box, FilterKind::gaussian, FilterKind::triangle}) {
    const Filter filter = filter_of(kind);
    const Vec2f radius = filter.radius();
    for (const float shift : {0.0f, 0.02f, 0.1f, 0.3f, 0.5f, 0.8f}) {
      const RasterBox large{{4 + shift, 4 + shift}, {15 + shift, 13 + shift}};
      FilterParts parts(filter, width, height);
      parts.add(large);
      for (std::uint32_t y = 2; y < 16; ++y)
        for (std::uint32_t x = 2; x < 18; ++x)
          parts.add({{float(x) + 0.45f, float(y) + 0.45f}, {float(x) + 0.5f, float(y) + 0.5f}});
      for (std::uint32_t y = 2; y < 16; ++y)
        for (std::uint32_t x = 2; x < 18; ++x) {
          const float px = float(x) + 0.5f, py = float(y) + 0.5f;
          if (px - radius.x >= large.low.x && px + radius.x <= large.high.x && py - radius.y >= large.low.y &&
              py + radius.y <= large.high.y)
            parts.make_whole(y * width + x);
          const double expected = integral(filter, large, x, y);
          if (expected < 1e-2) continue;
          const FilterPart<float> part = part_of(parts, x, y);
          EXPECT_NEAR(by_part(filter, part, large, x, y), expected, rounding(kind, filter, expected, part));
        }
    }
  }
}

TEST(FilterParts, are_small_where_little_of_a_filter_meets_a_box) {
  const Filter filter = filter_of(FilterKind::gaussian);
  FilterParts parts(filter, width, height);
  parts.add({{10.4f, 8.4f}, {10.6f, 8.6f}});
  EXPECT_LT(part_of(parts, 10, 8).mass(), 0.05f);   // a fifth of a pixel wide, at the centre
  EXPECT_LT(part_of(parts, 11, 9).mass(), 0.005f);  // beside it
  EXPECT_LT(part_of(parts, 11, 8).mass(), 0.015f);
}

TEST(FilterParts, are_whole_within_a_box_and_where_there_is_none) {
  const Filter filter = filter_of(FilterKind::triangle);
  FilterParts parts(filter, width, height);
  EXPECT_EQ(part_of(parts, 3, 4).mass(), 1.0f);
  // Pixels whose filters are within the box are left to make_whole().
  const std::size_t at_rim = parts.add({{4, 4}, {20, 14}});
  EXPECT_EQ(at_rim, 20u * 14u - 12u * 6u);
  parts.make_whole(9 * width + 12);
  EXPECT_EQ(part_of(parts, 12, 9).mass(), 1.0f);
}

}  // namespace
}  // namespace montelux
