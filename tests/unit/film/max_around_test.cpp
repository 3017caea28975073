#include "film/max_around.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mc/random.h"

namespace montelux {

TEST(MaxAround, is_the_largest_of_the_pixels_that_exist) {
  const RandomStream<float> random(1, 2);
  for (const auto& [width, height, reach] : {std::array{9, 7, 2}, {1, 5, 3}, {4, 1, 1}, {3, 3, 0}}) {
    Plane plane(std::size_t(width * height));
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = random.at(std::uint32_t(i)) - 0.5f;
    const Plane largest = max_around(plane, width, reach);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        float expected = -1;
        for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
          for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u)
            expected = std::max(expected, plane[std::size_t(v * width + u)]);
        EXPECT_EQ(largest[std::size_t(y * width + x)], expected);
      }
  }
  EXPECT_TRUE(max_around({}, 0, 1).empty());
}

}  // namespace montelux
