// Planes of splats: the same sum in any order and from any thread, filtered as camera samples are.
#include "integrator/splats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "math/shared_exact_sum.h"
#include "mc/random.h"

namespace montelux {
namespace {

TEST(SharedExactSum, is_the_exact_sum_of_what_many_threads_add) {
  constexpr int threads = 4, numbers = 20000;
  std::vector<float> all;
  RandomStream<float> r(1, 2);
  ExactSum expected;
  for (int i = 0; i < threads * numbers; ++i) {
    // Of both signs and of all sizes, so that carries go through the words in both directions.
    const float x = (r.next() < 0.5f ? -1.0f : 1.0f) * exp(60 * r.next() - 40);
    all.push_back(x), expected.add(x);
  }
  SharedExactSum sum;
  {
    std::vector<std::jthread> pool;
    for (int t = 0; t < threads; ++t)
      pool.emplace_back([&, t] {
        for (int i = t; i < threads * numbers; i += threads) sum.add(all[std::size_t(i)]);
      });
  }
  EXPECT_TRUE(sum.take() == expected);
  EXPECT_TRUE(sum.take() == ExactSum{});
}

struct Splat {
  Vec2f raster;
  Rgb value;
};
std::vector<Splat> splats(const PixelBounds& b, int count) {
  RandomStream<float> r(3, 4);
  std::vector<Splat> all;
  for (int i = 0; i < count; ++i)
    all.push_back(
        {{float(b.x0) - 3 + float(b.width() + 6) * r.next(), float(b.y0) - 3 + float(b.height() + 6) * r.next()},
         {r.next(), 10 * r.next(), exp(20 * r.next() - 10)}});
  return all;
}

TEST(SplatPlane, gives_each_pixel_its_filtered_share_whatever_the_order) {
  const PixelBounds bounds{2, 1, 9, 7};
  for (const Filter& filter : {Filter(), Filter(BoxFilter{{0.5f, 0.5f}}), Filter(TriangleFilter{{2.0f, 1.5f}}),
                               Filter(MitchellFilter(MitchellProfile{}, MitchellProfile{}))}) {
    std::vector<Splat> all = splats(bounds, 3000);
    SplatPlane forward(bounds, filter), backward(bounds, filter);
    for (const Splat& s : all) forward.add(s.raster, s.value);
    std::reverse(all.begin(), all.end());
    for (const Splat& s : all) backward.add(s.raster, s.value);
    for (int y = bounds.y0; y < bounds.y1; ++y)
      for (int x = bounds.x0; x < bounds.x1; ++x) {
        double expected = 0, wrong = 0, size = 0;
        for (const Splat& s : all) {
          const Vec2f offset{s.raster.x - float(x) - 0.5f, s.raster.y - float(y) - 0.5f};
          const double share = double(filter.evaluate(offset)) * double(s.value[1]);
          expected += share, size += std::abs(share);
          wrong += double(filter.evaluate(Vec2f{offset.x - 0.5f, offset.y})) * double(s.value[1]);
        }
        const Rgb a = forward.take(x, y), b = backward.take(x, y);
        for (int i = 0; i < rgb_size; ++i) EXPECT_EQ(a[i], b[i]);
        EXPECT_NEAR(double(a[1]), expected, 1e-5 * size);
        EXPECT_GT(std::abs(double(a[1]) - wrong), 1e-5 * size);
        EXPECT_EQ(forward.take(x, y)[1], 0);
      }
  }
}

TEST(SplatPlane, has_the_same_sums_whatever_the_threads) {
  constexpr int threads = 4;
  const PixelBounds bounds{2, 1, 39, 35};
  const Filter filter(MitchellFilter(MitchellProfile{}, MitchellProfile{}));
  const std::vector<Splat> all = splats(bounds, 20000);
  SplatPlane one(bounds, filter), shared(bounds, filter);
  const auto add_to = [&](SplatPlane& plane, std::size_t i) {
    plane.add(all[i].raster, all[i].value);
    plane.add_to_pixel(17 + int(i % 3), 16 + int(i % 2), all[i].value);  // all threads at four squares
  };
  for (std::size_t i = 0; i < all.size(); ++i) add_to(one, i);
  {
    std::vector<std::jthread> pool;
    for (std::size_t t = 0; t < threads; ++t)
      pool.emplace_back([&, t] {
        for (std::size_t i = t; i < all.size(); i += threads) add_to(shared, i);
      });
  }
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      const Rgb a = one.take(x, y), b = shared.take(x, y);
      for (int i = 0; i < rgb_size; ++i) ASSERT_EQ(a[i], b[i]) << x << " " << y;
    }
}

TEST(SplatPlane, reaches_exactly_the_places_within_the_filter_of_a_pixel) {
  const PixelBounds bounds{2, 1, 9, 7};
  const Filter filter;
  SplatPlane plane(bounds, filter);
  for (const Splat& s : splats(bounds, 500)) {
    plane.add(s.raster, gray_rgb(1.0f));
    bool any = false;
    for (int y = bounds.y0; y < bounds.y1; ++y)
      for (int x = bounds.x0; x < bounds.x1; ++x) any |= plane.take(x, y)[0] != 0;
    if (any) {
      EXPECT_TRUE(plane.reaches(s.raster));
    }
  }
}

TEST(SplatPlane, shows_what_is_not_finite) {
  const PixelBounds bounds{0, 0, 3, 3};
  const Filter filter(BoxFilter{{0.5f, 0.5f}});
  SplatPlane plane(bounds, filter);
  for (const float broken : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
    plane.add({1.5f, 1.5f}, {1, broken, 1});
    EXPECT_TRUE(std::isnan(plane.take(1, 1)[0]));
    EXPECT_EQ(plane.take(1, 1)[0], 0);
    EXPECT_EQ(plane.take(0, 1)[0], 0);
  }
}

}  // namespace
}  // namespace montelux
