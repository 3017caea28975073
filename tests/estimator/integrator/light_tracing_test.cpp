// Light tracing shows what path tracing shows, of whatever the lens sees without a mirror in between.
#include <gtest/gtest.h>

#include <numbers>

#include "integrator/light_tracing/loop.h"
#include "light_room.h"

namespace montelux::test {
namespace {

// One pass as `light` makes it, by another correction for shading normals.
template <class Correction>
PassMeans by_hand(const TestScene& scene, int per_pass, int passes, std::uint32_t seed) {
  PassMeans means;
  const AliasTable by_power = scene.scene().lights.by_power();
  const RenderSettings s = scene.settings(PointSetKind::blue_noise, {per_pass, 1}, seed);
  const LightTracingSettings settings;
  for (int number = 0; number < passes; ++number) {
    const SeriesPass pass{s.image.bounds, s.image.points(number, per_pass), {}};
    SplatPlane plane(s.image.bounds, scene.scene().filter);
    Film film(s.image.bounds);
    std::vector<PixelPass> pixels(std::size_t(s.image.bounds.area()));
    for (int frame = 0; frame < per_pass; ++frame) {
      const LightTracingScene<Accel> shared{scene.scene(), scene.accel(),        settings, by_power,
                                            pass,          std::uint32_t(frame), false,    plane};
      LightTracingLoop<NativeFloats, Accel, Correction>(shared).run(s.image.bounds);
      for (int y = 0, i = 0; y < s.image.height; ++y)
        for (int x = 0; x < s.image.width; ++x, ++i) pixels[std::size_t(i)].add({plane.take(x, y), {}});
    }
    film.add_pass(s.image.bounds, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
}
struct NoCorrection {
  template <class F>
  F operator()(const Vec3<F>&, F, const Vec3<F>&, F) const {
    return F(1.0f);
  }
};
// The cosine at the vertex before the lens twice, or that of the other side of it.
struct WrongCosine {
  template <class F>
  F operator()(const Vec3<F>& in, F ng_in, const Vec3<F>& out, F ng_out) const {
    return AdjointCorrection()(in, ng_in, out, ng_out) * abs(ng_out) * 1.5f;
  }
};

TEST(LightTracing, agrees_with_path_in_a_coloured_room_and_planted_faults_are_found) {
  const TestScene scene(room(lens, gaussian));
  const PassMeans path = measured(scene, "path", 16, 40, 1), light = measured(scene, "light", 16, 100, 2);
  const Comparison c = compared(light, path);
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
  EXPECT_FALSE(compared(by_hand<AdjointCorrection>(scene, 16, 60, 3), path).differ());
  EXPECT_TRUE(compared(by_hand<NoCorrection>(scene, 16, 60, 3), path).differ());
  EXPECT_TRUE(compared(by_hand<WrongCosine>(scene, 16, 60, 3), path).differ());
}

TEST(LightTracing, agrees_with_path_for_every_camera_and_filter) {
  const std::pair<std::string, std::string> pairs[] = {
      {"Camera \"orthographic\" \"float screenwindow\" [ -0.9 0.9 -0.6 0.6 ]", "\"box\""},
      {"Camera \"orthographic\" \"float screenwindow\" [ -0.9 0.9 -0.6 0.6 ] \"float lensradius\" 0.1 \"float "
       "focaldistance\" 2",
       "\"mitchell\""},
      {"Camera \"spherical\" \"string mapping\" \"equirectangular\"", "\"gaussian\""},
      {"Camera \"spherical\" \"string mapping\" \"equalarea\"", "\"triangle\""},
      {"Camera \"perspective\" \"float fov\" 90", "\"sinc\""}};
  for (const auto& [camera, filter] : pairs) {
    SCOPED_TRACE(camera);
    std::string text = room(camera, filter);
    // What is seen through the glass ball has no place here.
    text.resize(text.find("Material \"dielectric\""));
    const TestScene scene(text);
    const PassMeans path = measured(scene, "path", 16, 80, 1), light = measured(scene, "light", 16, 200, 2);
    const Comparison c = compared(light, path);
    EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
    PassMeans more = light;
    for (auto& values : more.values)
      for (double& x : values) x *= 1.05;
    EXPECT_TRUE(compared(more, path).differ());
  }
}

TEST(LightTracing, agrees_with_path_where_things_move) {
  std::string text = room(lens, gaussian);
  text.insert(text.find("LookAt"), "ActiveTransform EndTime\nTranslate 0.3 0 0\nActiveTransform All\n");
  text.resize(text.find("Material \"dielectric\""));
  text +=
      "AttributeBegin\nActiveTransform EndTime\nTranslate 0 0.8 0\nActiveTransform All\nMaterial \"diffuse\"\n"
      "Translate 0.4 0.2 -0.4\nShape \"sphere\" \"float radius\" 0.2\nAttributeEnd\n";
  const TestScene scene(text);
  ASSERT_TRUE(scene.scene().moves());
  const Comparison c = compared(measured(scene, "light", 16, 60, 2), measured(scene, "path", 16, 40, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

TEST(LightTracing, agrees_with_path_and_bdpt_in_media) {
  const TestScene scene(fog_with_cloud);
  const PassMeans bdpt = measured(scene, "bdpt", 16, 60, 1), light = measured(scene, "light", 16, 100, 2);
  for (const auto& [way, means] : {std::pair("path", measured(scene, "path", 16, 100, 3)), std::pair("light", light)}) {
    const Comparison c = compared(means, bdpt);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
  // The lamps' own media matter.
  std::string clear = fog_with_cloud;
  clear.replace(clear.find("MediumInterface \"cloud\" \"fog\""), 31, "MediumInterface \"cloud\" \"\"");
  EXPECT_TRUE(compared(measured(TestScene(clear), "light", 16, 100, 2), bdpt).differ());
}

TEST(LightTracing, ends_where_maxdepth_says) {
  const TestScene scene(room(lens, gaussian));
  for (const int depth : {0, 1, 2}) {
    const std::string largest = ":maxdepth=" + std::to_string(depth);
    const Comparison c =
        compared(measured(scene, "light" + largest, 16, 40, 2), measured(scene, "path" + largest, 16, 40, 1));
    EXPECT_FALSE(c.differ()) << depth << ": " << c.smallest << " of " << c.tests;
  }
  EXPECT_TRUE(
      compared(measured(scene, "light:maxdepth=1", 16, 40, 2), measured(scene, "path:maxdepth=2", 16, 40, 1)).differ());
}

TEST(LightTracing, has_the_same_bits_for_any_number_of_threads_and_lanes) {
  const TestScene scene(room(lens, gaussian));
  const auto film = [&](const char* way, int threads) {
    RenderObserver silent;
    const ChosenIntegrator chosen = scene.integrator(way);
    return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {4, 3}, 5, threads), silent).film;
  };
  const Film one = film("light", 1);
  for (const auto& [way, threads] : {std::pair("light", 2), std::pair("light", 5), std::pair("light:lanes=one", 1)}) {
    const Film other = film(way, threads);
    for (int y = 0; y < one.bounds().y1; ++y)
      for (int x = 0; x < one.bounds().x1; ++x)
        for (int c = 0; c < rgb_size; ++c) ASSERT_EQ(one.pixel(x, y).mean[c], other.pixel(x, y).mean[c]) << way;
  }
}

TEST(LightTracing, refuses_scenes_without_a_pixel_filter) {
  const TestScene scene("Option \"bool disablepixeljitter\" true\n" + room(lens, gaussian));
  EXPECT_THROW(scene.integrator("light"), std::runtime_error);
}

}  // namespace
}  // namespace montelux::test
