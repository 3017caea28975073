// Lights that no ray meets, against their definitions; images on lights; lanes against floats.
#include <gtest/gtest.h>

#include "light_cases.h"
#include "mc/random.h"

namespace montelux::test {
namespace {

using P = NativeFloats;

LightSample<float> from(const LightSet& lights, Vec3f p) {
  return lights.sample<float>(p, {0, 0, 0}, 0.5f, Vec2f{0.3f, 0.6f}, true);
}

TEST(PointLight, falls_with_the_square_of_the_distance) {
  LightSetBuilder b;
  b.add_point({1, 2, 3}, {8, 4, 2});
  LightSample<float> s = from(alone(std::move(b)), {1, 2, 1});
  EXPECT_TRUE(s.valid);
  EXPECT_TRUE(s.delta);
  EXPECT_FLOAT_EQ(s.distance, 2);
  EXPECT_FLOAT_EQ(s.wi.z, 1);
  EXPECT_FLOAT_EQ(s.density.value, 1);
  EXPECT_FLOAT_EQ(s.radiance[0], 2);
  EXPECT_FLOAT_EQ(s.radiance[2], 0.5f);
}

TEST(SpotLight, falls_off_by_a_smooth_step_in_the_cosine) {
  LightSetBuilder b;
  b.add_spot({0, 0, 0}, {0, 0, 2}, {30, 20}, gray_rgb(1.0f));
  LightSet lights = alone(std::move(b));
  auto at = [&](double degrees) {
    double a = degrees * std::numbers::pi / 180;
    LightSample<float> s = from(lights, {float(2 * std::sin(a)), 0, float(2 * std::cos(a))});
    return s.valid ? s.radiance[0] * 4 : 0;
  };
  EXPECT_FLOAT_EQ(at(0), 1);
  EXPECT_FLOAT_EQ(at(19.9), 1);
  EXPECT_EQ(at(30.1), 0);
  double low = std::cos(std::numbers::pi / 6), high = std::cos(std::numbers::pi / 9);
  double t = (std::cos(25 * std::numbers::pi / 180) - low) / (high - low);
  EXPECT_NEAR(at(25), t * t * (3 - 2 * t), 1e-5);
}

TEST(DistantLight, shines_along_one_direction_from_beyond_the_scene) {
  LightSetBuilder b;
  b.add_distant({0, 3, 4}, gray_rgb(2.5f));
  LightSample<float> s = from(alone(std::move(b)), {5, 5, 5});
  EXPECT_FLOAT_EQ(s.wi.y, 0.6f);
  EXPECT_FLOAT_EQ(s.wi.z, 0.8f);
  EXPECT_FLOAT_EQ(s.radiance[1], 2.5f);
  EXPECT_GE(s.distance, 20);
}

TEST(GoniometricLight, has_the_pole_of_its_image_along_y) {
  // Only directions in the map's inner half shine: those within a quarter turn of the pole.
  auto image = std::make_shared<LightImage>(LightImage{2, 2, {}});
  image->texels = {gray_rgb(1.0f), gray_rgb(2.0f), gray_rgb(3.0f), gray_rgb(4.0f)};
  LightSetBuilder b;
  b.add_goniometric({}, gray_rgb(1.0f), image);
  LightSet lights = alone(std::move(b));
  // In the light's space x is the map's u and z its v.
  EXPECT_FLOAT_EQ(from(lights, {-1, 0.1f, -1}).radiance[0] * 2.01f, 1);
  EXPECT_FLOAT_EQ(from(lights, {1, 0.1f, -1}).radiance[0] * 2.01f, 2);
  EXPECT_FLOAT_EQ(from(lights, {-1, 0.1f, 1}).radiance[0] * 2.01f, 3);
  EXPECT_FLOAT_EQ(from(lights, {1, 0.1f, 1}).radiance[0] * 2.01f, 4);
}

TEST(ProjectionLight, throws_the_slide_upright_within_its_field_of_view) {
  auto image = std::make_shared<LightImage>(LightImage{4, 2, {}});
  for (int i = 0; i < 8; ++i) image->texels.push_back(gray_rgb(float(i + 1)));
  LightSetBuilder b;
  b.add_projection({}, 90, gray_rgb(1.0f), image);
  LightSet lights = alone(std::move(b));
  auto at = [&](float x, float y) {
    LightSample<float> s = from(lights, {x, y, 1});
    return s.valid ? s.radiance[0] * (1 + x * x + y * y) : 0;
  };
  EXPECT_FLOAT_EQ(at(-1.9f, 0.9f), 1);  // the first row is the upper one, on the plane z = 1 two units wide a side
  EXPECT_FLOAT_EQ(at(1.9f, 0.9f), 4);
  EXPECT_FLOAT_EQ(at(-1.9f, -0.9f), 5);
  EXPECT_FLOAT_EQ(at(1.9f, -0.9f), 8);
  EXPECT_EQ(at(2.1f, 0), 0);
  EXPECT_EQ(at(0, 1.1f), 0);
  EXPECT_FALSE(from(lights, {0, 0, -1}).valid);
}

TEST(ImageOnSurface, is_looked_up_by_uv_with_v_upward) {
  auto image =
      std::make_shared<LightImage>(LightImage{2, 2, {gray_rgb(1.0f), gray_rgb(2.0f), gray_rgb(3.0f), gray_rgb(4.0f)}});
  LightSetBuilder b;
  b.add(PatchShape{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}}, {.scale = 10, .image = image});
  LightSet lights = alone(std::move(b));
  auto at = [&](Vec2f uv) { return lights.hit_radiance<float>(0, {0, 0, 1}, uv, {0, 0, -1}, true)[0]; };
  EXPECT_FLOAT_EQ(at({0.1f, 0.9f}), 10);
  EXPECT_FLOAT_EQ(at({0.9f, 0.9f}), 20);
  EXPECT_FLOAT_EQ(at({0.1f, 0.1f}), 30);
  EXPECT_FLOAT_EQ(at({0.9f, 0.1f}), 40);
  EXPECT_FLOAT_EQ(at({0.5f, 0.5f}), 25);
}

// One of each kind in one set.
LightSet one_of_each(LightSelection selection) {
  LightSetBuilder b;
  Emission e{.radiance = {1, 2, 3}}, picture{.two_sided = true, .image = test_image()};
  b.add(TriangleShape{{0, 0, 3}, {1, 0, 3}, {0, 1, 3}}, picture);
  b.add(PatchShape{{0, 0, -3}, {1, 0, -3}, {0, 1, -3}, {1, 1, -3}}, e);
  b.add(PatchShape{{2, 0, -3}, {3, 0, -3}, {2, 1, -3}, {3, 1.5f, -2.5f}}, picture);
  b.add(DiskShape{translate(-3, 0, 0) * rotate(90, 0, 1, 0), 0.7f}, picture);
  b.add(SphereShape{translate(-3, 3, 0), 0.7f}, picture);
  b.add(CylinderShape{translate(0, -3, 0), 0.3f}, picture);
  b.add_point({0, 4, 0}, gray_rgb(2.0f));
  b.add_spot({4, 4, 0}, {-1, -1, 0}, {60, 20}, gray_rgb(2.0f));
  b.add_goniometric(translate(4, 0, 0), gray_rgb(1.0f), test_image());
  b.add_projection(translate(0, 0, -5), 90, gray_rgb(1.0f), test_image());
  b.add_distant({1, 1, 1}, gray_rgb(1.0f));
  b.add_uniform_infinite(gray_rgb(0.3f));
  b.add_image_infinite(rotate(30, 1, 0, 0), gray_rgb(0.3f), test_image());
  return std::move(b).build({selection}, {0, 0, 0}, 8);
}

void expect_same(const Spectrum<P>& pack, const Spectrum<float>& one, int k) {
  for (int i = 0; i < spectrum_size; ++i) EXPECT_EQ(lane(pack[i], k), one[i]);
}

TEST(LightSet, gives_each_lane_the_bits_of_a_float) {
  for (LightSelection selection : {LightSelection::uniform, LightSelection::power, LightSelection::bvh}) {
    LightSet lights = one_of_each(selection);
    ASSERT_EQ(lights.count(), light_kind_names.size());
    RandomStream<P> r(lane_index<P>(), Uint<P>(9u));
    for (int i = 0; i < 200; ++i) {
      Vec3<P> p{4.0f * r.next() - 2.0f, 4.0f * r.next() - 2.0f, 4.0f * r.next() - 2.0f};
      Vec3<P> n = i % 2 ? Vec3<P>{P(0.0f), P(0.0f), P(1.0f)} : Vec3<P>{P(0.0f), P(0.0f), P(0.0f)};
      P choice = r.next();
      Vec2<P> u = r.next2();
      Uint<P> light = to_uint(r.next() * 12.999f);
      Mask<P> on = r.next() < P(0.8f);
      LightSample<P> s = lights.sample(p, n, choice, u, on);
      LightSample<P> given = lights.sample_light(light, p, n, u, on);
      Mask<P> surface = on & given.valid & (light < Uint<P>(6u));
      Vec3<P> q = p + given.wi * given.distance;
      LightHit<P> hit = lights.hit(light, p, n, q, -given.wi, u, given.wi, surface);
      LightHit<P> sky = lights.escaped(1, p, n, s.wi, on);
      Spectrum<P> all_sky = lights.escaped_radiance(s.wi, on);
      for (int k = 0; k < native_lanes; ++k) {
        if (!lane(on, k)) {
          EXPECT_FALSE(lane(s.valid, k));
          continue;
        }
        LightSample<float> one = lights.sample(lane(p, k), lane(n, k), lane(choice, k), lane(u, k), true);
        ASSERT_EQ(lane(s.valid, k), one.valid);
        if (one.valid) {
          EXPECT_EQ(lane(s.wi, k).x, one.wi.x);
          EXPECT_EQ(lane(s.distance, k), one.distance);
          EXPECT_EQ(lane(s.density.value, k), one.density.value);
          EXPECT_EQ(lane(s.delta, k), one.delta);
          expect_same(s.radiance, one.radiance, k);
        }
        if (lane(surface, k)) {
          Vec3f w = lane(given.wi, k);
          LightHit<float> h =
              lights.hit<float>(lane(light, k), lane(p, k), lane(n, k), lane(q, k), -w, lane(u, k), w, true);
          EXPECT_EQ(lane(hit.density.value, k), h.density.value) << lane(light, k);
          expect_same(hit.radiance, h.radiance, k);
        }
        LightHit<float> e = lights.escaped<float>(1, lane(p, k), lane(n, k), lane(s.wi, k), true);
        EXPECT_EQ(lane(sky.density.value, k), e.density.value);
        expect_same(sky.radiance, e.radiance, k);
        expect_same(all_sky, lights.escaped_radiance<float>(lane(s.wi, k), true), k);
      }
    }
  }
}

TEST(LightSet, without_lights_samples_nothing) {
  LightSet none;
  EXPECT_FALSE(from(none, {0, 0, 0}).valid);
  EXPECT_EQ(none.infinite_count(), 0);
  EXPECT_TRUE(is_black(none.escaped_radiance<float>({0, 0, 1}, true)));
}

}  // namespace
}  // namespace montelux::test
