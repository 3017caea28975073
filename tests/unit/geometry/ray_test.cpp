#include "geometry/ray.h"

#include <gtest/gtest.h>

#include "geometry_samples.h"
#include "mc/random.h"

namespace montelux::test {
namespace {

// A shadow ray to a point of a plane, from a surface whose point is known to `error`.
struct ToPlane {
  Vec3f p, error, ng, target, normal;
  Vec3f way() const { return target - p; }
  Ray<float> shadow() const {
    const float distance = length(way());
    return shadow_ray<float>(p, error, ng, way() / distance, distance, 0.0f);
  }
  // The ray in the direction from p itself, without regard to where it leaves.
  Ray<float> parallel() const {
    const float distance = length(way());
    const Vec3f w = way() / distance;
    return {offset_origin<float>(p, error, ng, w), w, distance * (1.0f - shadow_shortening)};
  }
  bool ends_before(const Ray<float>& ray) const {
    const auto height = [&](const Vec3f& at) { return dot(at - target, normal); };
    return height(ray.o) * height(ray.o + ray.d * ray.t_max) > 0;
  }
};

TEST(ShadowRay, ends_before_the_surface_that_it_aims_at_however_far_its_origin_was_moved) {
  RandomStream<float> random(17, 0);
  int parallel_ends_behind = 0, requested = 0;
  for (int i = 0; i < 20000; ++i) {
    ToPlane c;
    c.p = {random.next(), random.next(), random.next()};
    c.target = c.p + random_direction(random) * (0.5f + random.next());
    c.ng = random_direction(random), c.normal = random_direction(random);
    const float error = 0.05f * random.next();  // curves state their width
    c.error = {error, error, error};
    // Not along the plane, where rounding decides.
    if (std::abs(dot(c.way(), c.normal)) < 0.3f) continue;
    ++requested;
    EXPECT_TRUE(c.ends_before(c.shadow())) << i;
    parallel_ends_behind += !c.ends_before(c.parallel());
  }
  EXPECT_GT(requested, 10000);
  EXPECT_GT(parallel_ends_behind, requested / 4);
}

TEST(ShadowRay, toward_what_is_beyond_the_scene_keeps_its_direction) {
  const Vec3f w = normalize(Vec3f{1, 2, -3}), error{0.5f, 0.5f, 0.5f};
  const Ray<float> ray = shadow_ray<float>({1, 2, 3}, error, {0, 0, 1}, w, ray_infinity, 0.25f);
  EXPECT_EQ(ray.d.x, w.x);
  EXPECT_EQ(ray.d.y, w.y);
  EXPECT_EQ(ray.d.z, w.z);
  EXPECT_EQ(ray.time, 0.25f);
}

}  // namespace
}  // namespace montelux::test
