// The equal-area map between the square and the sphere on which images of directions rest.
#include <gtest/gtest.h>

#include "math/square_maps.h"
#include "statistics.h"

namespace montelux::test {
namespace {

Vec3f through(Vec2f uv, float bend) { return sphere_from_square(Vec2f{uv.x, pow(uv.y, bend)}); }

TEST(SphereMap, gives_equal_areas_and_a_bent_one_is_found) {
  LocalFrame<float> frame = LocalFrame<float>::from_normal(normalize(Vec3f{1, 2, 3}));
  auto uniform = [](Vec3f) { return inv_four_pi; };
  double level = sidak_level(family_level, 2);
  EXPECT_GT(
      chi_square_sample_density([](RandomStream<float>& r) { return through(r.next2(), 1); }, uniform, 400000, 3, frame)
          .p_value,
      level);
  EXPECT_LT(chi_square_sample_density([](RandomStream<float>& r) { return through(r.next2(), 1.02f); }, uniform, 400000,
                                      3, frame)
                .p_value,
            level);
}

TEST(SphereMap, comes_back_to_the_same_place) {
  RandomStream<float> r(1, 1);
  for (int i = 0; i < 20000; ++i) {
    Vec2f uv = r.next2(), back = square_from_sphere(sphere_from_square(uv));
    EXPECT_NEAR(uv.x, back.x, 3e-4f);
    EXPECT_NEAR(uv.y, back.y, 3e-4f);
  }
}

}  // namespace
}  // namespace montelux::test
