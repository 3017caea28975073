// Things that move, and the shape of the aperture, where a mean alone would not tell: pixel by pixel, and against
// faults.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

constexpr int passes = 32;
const double level = sidak_level(family_level, 12);

std::string picture(const std::string& size) {
  return "Film \"rgb\" \"integer xresolution\" [ " + size + " ] \"integer yresolution\" [ " + size +
         " ]\nPixelFilter \"box\"\nIntegrator \"path\" \"integer maxdepth\" 5\n";
}

// A room corner with a lamp and something glossy; `camera` and `world` say what moves.
std::string corner(const std::string& camera, const std::string& world) {
  return picture("12") + camera + "Camera \"perspective\" \"float fov\" 40\nWorldBegin\n" + world +
         R"(AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 4 4 4 ]
  Translate 2 4 -3
  Shape "sphere" "float radius" 0.5
AttributeEnd
LightSource "infinite" "rgb L" [ 0.2 0.2 0.2 ]
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
)";
}
const std::string things = R"(Shape "sphere" "float radius" 0.6
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point3 P" [ -2 -0.6 -1   2 -0.6 -1   0 1.5 2 ]
)";

RenderResult rendered(const TestScene& scene, std::uint32_t seed, std::optional<Shutter> shutter = {}) {
  const PathTracer tracer = scene.tracer();
  RenderSettings settings = scene.settings(PointSetKind::independent, {32, passes}, seed);
  settings.image.shutter = shutter;
  RenderObserver silent;
  return render(tracer, settings, silent);
}

// The least p-value of Welch's tests of all pixels, times their number (Bonferroni).
double min_p_value(const Film& a, const Film& b) {
  double smallest = 1;
  int pixels = 0;
  const PixelBounds& all = a.bounds();
  for (int y = all.y0; y < all.y1; ++y)
    for (int x = all.x0; x < all.x1; ++x, ++pixels) {
      const PixelEstimate &p = a.pixel(x, y), &q = b.pixel(x, y);
      const double v = p.variance_of_mean(0), w = q.variance_of_mean(0);
      if (v + w == 0) {
        if (std::abs(p.mean[0] - q.mean[0]) > 1e-5 * std::abs(p.mean[0])) return 0;
        continue;
      }
      const double degrees = (v + w) * (v + w) / (v * v + w * w) * (passes - 1);
      smallest = std::min(smallest, 2 * student_t_cdf(-std::abs(p.mean[0] - q.mean[0]) / std::sqrt(v + w), degrees));
    }
  return std::min(1.0, smallest * pixels);
}

// The whole world, its lamp left out, which may not move: it lights from the camera's side.
std::string dim(const std::string& camera, const std::string& world) {
  std::string text = corner(camera, world);
  const std::size_t lamp = text.find("AttributeBegin\n  AreaLightSource");
  const std::size_t end = text.find("AttributeEnd\n", lamp);
  return text.erase(lamp, end + 13 - lamp);
}

TEST(Motion, of_the_camera_is_the_opposite_motion_of_everything_else) {
  const std::string look = "LookAt 0 1 -5  0 0 0  0 1 0\n";
  // World to camera is look * M at the end: the same as everything else moved by M.
  const std::string move = "Translate 0.5 0.1 -0.6\nRotate 25 0 1 0.3\n";
  const TestScene camera(dim(look + "ActiveTransform EndTime\n" + move + "ActiveTransform All\n", "") + things);
  const TestScene world(dim(look, "") + "ActiveTransform EndTime\n" + move + "ActiveTransform All\n" + things);
  const Film by_camera = rendered(camera, 1).film, by_world = rendered(world, 2).film;
  EXPECT_GT(min_p_value(by_camera, by_world), level);
  // A motion that is a little shorter is another one.
  const TestScene shorter(dim(look, "") + "ActiveTransform EndTime\nTranslate 0.4 0.1 -0.6\nRotate 25 0 1 0.3\n" +
                          "ActiveTransform All\n" + things);
  EXPECT_LT(min_p_value(by_camera, rendered(shorter, 3).film), level);
}

TEST(Motion, that_does_not_take_place_is_the_scene_at_rest) {
  const std::string look = "LookAt 0 1 -5  0 0 0  0 1 0\n";
  const std::string move = "Translate 0.5 0.3 -0.6\nRotate 50 0 1 0.3\n";
  const TestScene moving(corner(look, "") + "ActiveTransform EndTime\n" + move + "ActiveTransform All\n" + things);
  const TestScene start(corner(look, "") + things), end(corner(look, "") + move + things);
  const Film at_start = rendered(moving, 1, Shutter{0, 0}).film, at_end = rendered(moving, 1, Shutter{1, 1}).film;
  EXPECT_GT(min_p_value(at_start, rendered(start, 2).film), level);
  EXPECT_GT(min_p_value(at_end, rendered(end, 3).film), level);
  EXPECT_LT(min_p_value(at_start, at_end), level);
  // A shutter that closes as it opens is not the one that the scene states.
  EXPECT_LT(min_p_value(at_start, rendered(moving, 4).film), level);
}

TEST(Motion, of_vertices_is_that_of_the_transform_that_moves_them) {
  const std::string look = "LookAt 0 1 -5  0 0 0  0 1 0\n";
  const std::string triangle =
      "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ] "
      "\"point3 P\" [ -2 -0.6 -1   2 -0.6 -1   0 1.5 2 ] ";
  const TestScene vertices(corner(look, "") + triangle + "\"point3 P1\" [ -1.3 -0.6 -1   2.7 -0.6 -1   0.7 1.5 2 ]\n");
  const TestScene whole(corner(look, "") + "ActiveTransform EndTime Translate 0.7 0 0 ActiveTransform All\n" +
                        triangle);
  const Film a = rendered(vertices, 1).film;
  EXPECT_GT(min_p_value(a, rendered(whole, 2).film), level);
  const TestScene first(corner(look, "") + triangle);
  EXPECT_LT(min_p_value(a, rendered(first, 3).film), level);
}

// A small ball far out of focus makes an image of the aperture, upside down, with the light of the ball spread evenly
// over it.
TEST(Aperture, shows_in_the_image_of_a_small_ball) {
  constexpr int n = 5, size = 24;
  constexpr double radius = 0.8, ball = 0.05, radiance = 50, turn = 20 * std::numbers::pi / 180;
  const TestScene scene(picture("24") + R"(LookAt 0 0 -5  0 0 0  0 1 0
Camera "orthographic" "float lensradius" 0.8 "float focaldistance" 1e6 "integer apertureblades" 5
  "float aperturerotation" 20
WorldBegin
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
AreaLightSource "diffuse" "rgb L" [ 50 50 50 ]
Shape "sphere" "float radius" 0.05
)");
  const PathTracer tracer = scene.tracer();
  RenderObserver silent;
  const Film film = render(tracer, scene.settings(PointSetKind::independent, {512, passes}, 5), silent).film;
  const double disk = std::numbers::pi * ball * ball;
  const double inside = radiance * disk / (n * radius * radius * std::sin(2 * std::numbers::pi / n) / 2);
  // How far a place is inside of the polygon's image, at least; negative outside.
  const auto depth = [&](double x, double y) {
    double smallest = 9;
    for (int side = 0; side < n; ++side) {
      const double middle = turn + 2 * std::numbers::pi * (side + 0.5) / n;
      smallest =
          std::min(smallest, radius * std::cos(std::numbers::pi / n) + x * std::cos(middle) + y * std::sin(middle));
    }
    return smallest;
  };
  double sum = 0, variance = 0;
  int pixels = 0, dark = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double at = depth((x + 0.5) * 2 / size - 1, 1 - (y + 0.5) * 2 / size), half_pixel = std::sqrt(2.0) / size;
      const PixelEstimate& p = film.pixel(x, y);
      if (at > half_pixel + ball) sum += p.mean[0], variance += p.variance_of_mean(0), ++pixels;
      if (at < -half_pixel - ball) {
        EXPECT_EQ(p.mean[0], 0) << x << ", " << y;
        ++dark;
      }
    }
  ASSERT_GT(pixels, 60);
  ASSERT_GT(dark, 100);
  const double mean = sum / pixels, error = std::sqrt(variance) / pixels;
  EXPECT_GT(z_test(mean, error, inside).p_value, level) << mean << " +- " << error << ", " << inside;
  EXPECT_LT(z_test(mean, error, radiance * disk / (std::numbers::pi * radius * radius)).p_value, level);
  // All of the light, whatever the shape.
  const ImageEstimate image = film.image();
  EXPECT_GT(z_test(image.mean[0], image.standard_error[0], radiance * disk / 4).p_value, level);
}

}  // namespace

}  // namespace montelux::test
