// What it takes to finish a picture, which a render within a time sets aside.
#include <gtest/gtest.h>

#include "api/render.h"

namespace montelux {

TEST(SecondsToFinish, grow_with_the_picture_and_with_its_files) {
  const PixelBounds small{0, 0, 64, 64}, large{0, 0, 1024, 1024};
  EXPECT_GT(seconds_to_finish(small, {}), 0);
  EXPECT_GT(seconds_to_finish(large, {}), 4 * seconds_to_finish(small, {}));
  EXPECT_GT(seconds_to_finish(large, {{"a.exr", "b.exr", "c.exr"}, false}), 2 * seconds_to_finish(large, {}));
}

// A picture that cannot be encoded is the writer's matter.
TEST(SecondsToFinish, of_an_unknown_format_are_none) {
  EXPECT_EQ(seconds_to_finish({0, 0, 64, 64}, {{"a.xyz"}, false}), 0);
}

}  // namespace montelux
