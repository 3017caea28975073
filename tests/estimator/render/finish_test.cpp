// What it takes to finish a picture, which a render within a time sets aside.
#include <gtest/gtest.h>

#include "api/render.h"

namespace montelux {

TEST(SecondsToFinish, grow_with_the_picture_and_with_its_files) {
  const PixelBounds small{0, 0, 64, 64}, large{0, 0, 1024, 1024};
  EXPECT_GT(seconds_to_finish(small, {}).error, 0);
  EXPECT_GT(seconds_to_finish(large, {}).error, 4 * seconds_to_finish(small, {}).error);
  EXPECT_LT(seconds_to_finish(large, {}).encoding, 0.1 * seconds_to_finish(large, {}).error);
  const double one = seconds_to_finish(large, {{"a.exr"}, false}).encoding;
  EXPECT_GT(one, 0);
  EXPECT_GT(seconds_to_finish(large, {{"a.exr", "b.exr", "c.exr", "d.exr"}, false}).encoding, one);
}

// A picture that cannot be encoded is the writer's matter.
TEST(SecondsToFinish, of_an_unknown_format_are_those_of_its_error_alone) {
  const FinishTime time = seconds_to_finish({0, 0, 64, 64}, {{"a.xyz"}, false});
  EXPECT_GT(time.error, 0);
  EXPECT_EQ(time.encoding, 0);
}

}  // namespace montelux
