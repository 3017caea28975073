// Intervals found by way of an index, against the standard library's search.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mc/discrete.h"
#include "mc/random.h"

namespace montelux {
namespace {

// The last i in [0, n) with sums[i] <= x.
std::uint32_t last_not_above(std::span<const float> sums, float x) {
  const auto end = sums.begin() + std::ptrdiff_t(sums.size()) - 1;
  return std::uint32_t(std::upper_bound(sums.begin(), end, x) - sums.begin() - 1);
}

// Weights that are nearly all zero, all alike, or of very different sizes.
std::vector<double> weights_of(std::uint32_t n, int kind, RandomStream<float>& random) {
  std::vector<double> weights;
  for (std::uint32_t i = 0; i < n; ++i) {
    const float u = random.next();
    weights.push_back(kind == 0 ? double(u < 0.05f) : kind == 1 ? 1.0 : std::exp(20.0 * double(u)));
  }
  return weights;
}

TEST(IntervalIndex, finds_what_a_search_finds) {
  RandomStream<float> random(5u, 9u);
  for (std::uint32_t n : {1u, 2u, 3u, 4u, 7u, 8u, 31u, 64u, 100u, 1000u}) {
    constexpr std::uint32_t rows = 3;  // of every kind
    std::vector<float> sums;
    for (std::uint32_t row = 0; row < rows; ++row)
      std::ranges::copy(cumulative_sums(weights_of(n, int(row), random)), std::back_inserter(sums));
    const IntervalIndex index(sums, n);
    for (std::uint32_t row = 0; row < rows; ++row) {
      const auto own = std::span(sums).subspan(row * (n + 1), n + 1);
      std::vector<float> queries{0.0f, 0x1p-24f, 0.5f, 1 - 0x1p-24f};
      for (int i = 0; i < 200; ++i) queries.push_back(random.next());
      for (float edge : own)  // on the edge, and next to it
        for (float x : {edge, std::nextafter(edge, 0.0f), std::nextafter(edge, 1.0f)})
          if (x < 1) queries.push_back(x);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const std::uint32_t expected = last_not_above(own, queries[i]);
        ASSERT_EQ(index.find(sums.data(), row, queries[i]), expected) << n << ", row " << row << ", " << queries[i];
        // In a pack every lane has its own row and number; some are idle and contain anything.
        using F = NativeFloats;
        F x(std::nanf(""));
        Uint<F> rows_of_lanes(0u);
        for (int k = 0; k < lanes_of<F>; k += 2) {
          set_lane(x, k, queries[(i + std::size_t(k)) % queries.size()]);
          set_lane(rows_of_lanes, k, row);
        }
        const Uint<F> found = index.find(sums.data(), rows_of_lanes, x);
        for (int k = 0; k < lanes_of<F>; k += 2) ASSERT_EQ(lane(found, k), last_not_above(own, lane(x, k)));
      }
    }
  }
}

}  // namespace
}  // namespace montelux
