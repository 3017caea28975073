// The irradiance cache finds closed forms, and errs as theory says where irradiance changes.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "colour_means.h"

namespace montelux::test {
namespace {

constexpr double pi_ = std::numbers::pi;
double level(std::size_t tests) { return sidak_level(family_level, double(tests)); }

// With the same irradiance everywhere no spacing and no gradient does harm: each component of a coloured box that glows
// has the radiance L / (1 - reflectance), and each of a white one that is an integrating sphere has what its lamp
// sends.
TEST(IrradianceCache, finds_the_light_of_a_closed_coloured_box_with_records_far_apart) {
  constexpr double emission[] = {0.6, 0.3, 0.5}, reflectance[] = {0.5, 0.75, 0.2};
  const TestScene scene(R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
LookAt 0.3 0.2 0.1   1 0 0   0 1 0
Camera "spherical" "string mapping" [ "equalarea" ]
WorldBegin
AreaLightSource "diffuse" "rgb L" [ 0.6 0.3 0.5 ] "bool twosided" true
Material "diffuse" "rgb reflectance" [ 0.5 0.75 0.2 ]
Shape "bilinearmesh" "integer indices" [ 0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7 ]
    "point3 P" [ -1 -1 -1   1 -1 -1   -1 1 -1   1 1 -1   -1 -1 1   1 -1 1   -1 1 1   1 1 1 ]
)");
  for (const char* way : {"irradiance-cache:accuracy=0.9,max-spacing=2", "irradiance-cache:accuracy=0.3,samples=64",
                          "irradiance-cache:accuracy=0.9,min-spacing=1,max-spacing=2,gradients=off"}) {
    const Mean m = measure(scene, way, 4, 5);
    for (std::size_t c = 0; c < 3; ++c) {
      const double truth = emission[c] / (1 - reflectance[c]), se = m.standard_error[c];
      EXPECT_GE(p_value(m.mean[c], se, truth), level(9))
          << way << ", component " << c << ": " << m.mean[c] << " +- " << se << " where " << truth << " is right";
      // Light of another component; irradiance that is not divided by pi.
      const double once = emission[c] * (1 + reflectance[c]), indirect = truth - once;
      const std::size_t other = (c + 1) % 3;
      const double swapped = emission[other] * reflectance[other] * reflectance[other] / (1 - reflectance[other]);
      EXPECT_LT(p_value(m.mean[c], se, once + pi_ * indirect), level(9));
      EXPECT_LT(p_value(m.mean[c], se, truth - indirect + 0.9 * indirect), level(9));
      EXPECT_LT(p_value(m.mean[c], se, once + swapped), level(9));
    }
  }
}

// Indirect irradiance within a sphere of reflectance r around a lamp of the power P is the same everywhere,
// P / A * r / (1 - r), wherever the lamp is.
TEST(IrradianceCache, finds_the_light_within_a_coloured_integrating_sphere) {
  constexpr double reflectance[] = {0.5, 0.8, 0.2}, intensity[] = {1, 2, 4}, area = 4 * pi_ * 4;
  const TestScene scene(R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
LookAt 0 0 0   1 0 0   0 1 0
Camera "spherical" "string mapping" [ "equalarea" ]
WorldBegin
LightSource "point" "rgb I" [ 1 2 4 ] "point3 from" [ 0.5 0.3 -0.2 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.8 0.2 ]
Shape "sphere" "float radius" [ 2 ]
)");
  for (const char* way : {"irradiance-cache:samples=64", "irradiance-cache:gradients=off,samples=64"}) {
    const Mean m = measure(scene, way, 4, 5);
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean_irradiance = 4 * pi_ * intensity[c] / area;
      const double truth = reflectance[c] / pi_ * mean_irradiance / (1 - reflectance[c]), se = m.standard_error[c];
      EXPECT_GE(p_value(m.mean[c], se, truth), level(6))
          << way << ", component " << c << ": " << m.mean[c] << " +- " << se << " where " << truth << " is right";
      EXPECT_LT(p_value(m.mean[c], se, 0.97 * truth), level(6));
    }
  }
}

// A floor that is lit by a long wall alone: a distant light shines along the floor at the wall, and light of more than
// two events is left out. At the distance d from a wall of height H and radiance L the irradiance is
// pi / 2 L (1 - d / sqrt(d^2 + H^2)).
constexpr const char* wall_and_floor = R"(Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
LookAt 0.8 2 0   0.8 0 0   0 0 1
Camera "orthographic" "float screenwindow" [ -0.5 0.5 -0.5 0.5 ]
Integrator "path" "integer maxdepth" 2
WorldBegin
LightSource "distant" "rgb L" [ 1 2 3 ] "point3 from" [ 1 0 0 ] "point3 to" [ 0 0 0 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ 0 0 -100  2 0 -100  0 0 100  2 0 100 ]
Shape "bilinearmesh" "point3 P" [ 0 0 -100  0 1 -100  0 0 100  0 1 100 ]
)";
// Mean square error of the pixels of single passes, relative to the middle of the picture.
SampleSummary squared_errors(const TestScene& scene, const std::string& way) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  std::vector<double> all;
  const auto truth = [](double d, double light) {
    return 0.5 / pi_ * pi_ / 2 * (0.5 / pi_ * light) * (1 - d / std::sqrt(d * d + 1));
  };
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Film film = render(chosen.any(), scene.settings(PointSetKind::independent, {1, 1}, i), silent).film;
    double sum = 0;
    for (int y = 4; y < 28; ++y)
      for (int x = 4; x < 28; ++x)
        for (int c = 0; c < 3; ++c) {
          // The picture's x may run either way: what is on the left is found by its brightness.
          const bool turned = film.pixel(0, y).mean[c] < film.pixel(31, y).mean[c];
          const double d = 0.3 + (turned ? 31.5 - x : x + 0.5) / 32, right = truth(d, 1.0 + c);
          const double error = (film.pixel(x, y).mean[c] - right) / truth(0.8, 1.0 + c);
          sum += error * error / (24 * 24 * 3);
        }
    all.push_back(sum);
  }
  return summarize(all);
}
std::string spaced(double spacing, const char* more) {
  const std::string s = std::to_string(spacing);
  return "irradiance-cache:samples=3000,accuracy=0.3,min-spacing=" + s + ",max-spacing=" + s + more;
}

TEST(IrradianceCacheError, without_gradients_is_in_proportion_to_the_spacing) {
  const TestScene scene(wall_and_floor);
  const SampleSummary wide = squared_errors(scene, spaced(0.4, ",gradients=off")),
                      narrow = squared_errors(scene, spaced(0.2, ",gradients=off"));
  const Exponent e = measured_exponent(narrow, wide, 2);
  EXPECT_LT(std::abs(e.value - 2), 0.3 + 3.3 * e.standard_error) << e.value << " +- " << e.standard_error;
  EXPECT_LT(e.standard_error, 0.3);
}

TEST(IrradianceCacheError, is_much_smaller_with_gradients) {
  const TestScene scene(wall_and_floor);
  const SampleSummary with = squared_errors(scene, spaced(0.3, "")),
                      without = squared_errors(scene, spaced(0.3, ",gradients=off"));
  std::printf("squared error with gradients %.3g +- %.1g, without %.3g +- %.1g\n", with.mean, with.standard_error(),
              without.mean, without.standard_error());
  EXPECT_LT(welch_test(with, {without.mean / 5, without.variance / 25, without.count}).statistic, -3.3);
}

// One record for the whole floor: what it shows elsewhere is far from right. The passes compare some of their samples
// with paths, and find how far the picture is from the closed form.
TEST(IrradianceCacheBias, is_measured_as_it_is) {
  const TestScene scene(wall_and_floor);
  const ChosenIntegrator chosen =
      scene.integrator("irradiance-cache:samples=256,accuracy=0.5,min-spacing=0.9,max-spacing=0.9,pairs=0.3");
  constexpr int count = 24;
  const auto way = [](double d) { return std::sqrt(d * d + 1); };
  const double share = 1 - (way(1.3) - way(0.3));  // the mean of 1 - d / sqrt(d^2 + 1)
  std::array<std::vector<double>, 3> measured, found, differences;
  for (int pass = 0; pass < count; ++pass) {
    RenderSettings s = scene.settings(PointSetKind::independent, {4, 1}, 7);
    s.plan.first_pass = pass;
    RenderObserver silent;
    const RenderResult result = render(chosen.any(), s, silent);
    ASSERT_EQ(result.bias.size(), 1u);
    EXPECT_EQ(result.bias.begin()->first, pass);
    const ImageEstimate image = result.film.image();
    for (std::size_t c = 0; c < 3; ++c) {
      const double truth = 0.5 / pi_ * pi_ / 2 * (0.5 / pi_ * (1.0 + double(c))) * share;
      found[c].push_back(image.mean[c] - truth), measured[c].push_back(result.bias.begin()->second[c]);
      differences[c].push_back(measured[c].back() - found[c].back());
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const SampleSummary bias = summarize(measured[c]);
    std::printf("bias measured %.4g +- %.1g, of the picture %.4g +- %.1g, relative %.3g\n", bias.mean,
                bias.standard_error(), summarize(found[c]).mean, summarize(found[c]).standard_error(),
                bias.mean / (0.5 / pi_ * pi_ / 2 * (0.5 / pi_ * (1.0 + double(c))) * share));
    EXPECT_GE(t_test(differences[c], 0).p_value, level(3))
        << bias.mean << " +- " << bias.standard_error() << " measured where " << summarize(found[c]).mean
        << " is right";
    // There is a bias, and a half more or less of it would be seen.
    EXPECT_LT(t_test(measured[c], 0).p_value, level(3));
    EXPECT_LT(t_test(differences[c], 0.5 * bias.mean).p_value, level(3));
    EXPECT_LT(t_test(differences[c], -0.5 * bias.mean).p_value, level(3));
  }
}

TEST(IrradianceCacheBias, is_named_with_its_accuracy) {
  const TestScene scene(wall_and_floor);
  EXPECT_EQ(scene.integrator("irradiance-cache:accuracy=0.25,maxdepth=none").biases,
            std::vector<std::string>{"accuracy=0.25"});
  EXPECT_EQ(scene.integrator("irradiance-cache").biases, (std::vector<std::string>{"accuracy=0.4", "maxdepth=2"}));
}

}  // namespace
}  // namespace montelux::test
