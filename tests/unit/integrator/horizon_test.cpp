#include "integrator/tracepath/horizon.h"

#include <gtest/gtest.h>

#include "mc/hemisphere.h"
#include "mc/random.h"
#include "statistics.h"

namespace montelux::test {
namespace {

// An octant of the sphere: pi / 2.
const SeenPolygon octant{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 3};

TEST(Horizon, solid_angle_of_an_octant) { EXPECT_NEAR(solid_angle(octant), pi / 2, 1e-6); }

TEST(Horizon, solid_angle_of_a_face_of_a_cube) {
  const SeenPolygon face{{{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}}, 4};
  EXPECT_NEAR(solid_angle(face), 4 * pi / 6, 1e-6);
}

TEST(Horizon, a_tilted_plane_halves_the_face_of_a_cube) {
  const SeenPolygon face{{{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}}, 4};
  EXPECT_NEAR(solid_angle(above_horizon(face, {1, 0, 0})), pi / 3, 1e-6);
  EXPECT_NEAR(solid_angle(above_horizon(face, {0, 0, 1})), 2 * pi / 3, 1e-6);
  EXPECT_EQ(above_horizon(face, {0, 0, -1}).count, 0);
}

TEST(Horizon, covers_as_many_directions_as_its_solid_angle_says) {
  const SeenPolygon polygon{{{{-1, -1, 0.5f}, {2, -1, 0.25f}, {0.5f, 2, 1}}}, 3};
  RandomStream<float> random(1u, 2u);
  const int n = 200000;
  int hits = 0;
  for (int i = 0; i < n; ++i) hits += covers(polygon, sample_sphere(random.next2())) ? 1 : 0;
  const double share = double(solid_angle(polygon)) / (4 * double(pi));
  const double z = (hits - n * share) / std::sqrt(n * share * (1 - share));
  EXPECT_LT(std::abs(z), 4);
  // A polygon 5 % larger would be noticed.
  EXPECT_GT(std::abs(hits - n * share * 1.05) / std::sqrt(n * share * (1 - share)), 4);
}

}  // namespace
}  // namespace montelux::test
