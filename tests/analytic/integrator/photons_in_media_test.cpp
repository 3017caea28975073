// Photons of events in media find closed forms, their bias among them: how much of a kernel's ball lies within a medium
// is known.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "colour_means.h"

namespace montelux::test {
namespace {

using std::numbers::pi;
constexpr double glow[] = {1, 0.5, 2}, scattering[] = {0.5, 2, 4};

// A white medium within a black sphere of radius 1 that glows: the same radiance everywhere, seen from its centre.
const char* const furnace = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
Integrator "volpath" "integer maxdepth" 100000
MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 0.5 2 4 ] "float g" 0.6
MediumInterface "" "m"
Camera "perspective" "float fov" 40
WorldBegin
AreaLightSource "diffuse" "rgb L" [ 1 0.5 2 ]
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
ReverseOrientation
Shape "sphere" "float radius" 1
)";

enum class Kernel { constant, epanechnikov };
// The share of the kernel of radius r around a point at that distance from the centre that lies within the sphere: of
// the points at the distance d from it, (1 - (t - d)^2) / (4 t d) are within where t + d > 1.
double share_within(double t, double r, Kernel kernel) {
  constexpr int steps = 400;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double d = (i + 0.5) / steps * r, x = d / r;
    const double density = kernel == Kernel::constant ? 3 * x * x : 7.5 * x * x * (1 - x * x);
    sum += density / steps * (t + d <= 1 ? 1 : (1 - (t - d) * (t - d)) / (4 * t * d));
  }
  return sum;
}
// What the camera sees where photons are all the scattered light: the wall, attenuated, and photons on the way.
double radiance(std::size_t c, double r, Kernel kernel, double of_photons = 1) {
  constexpr int steps = 400;
  double scattered = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps;
    scattered += scattering[c] * std::exp(-scattering[c] * t) / steps * share_within(t, r, kernel);
  }
  return glow[c] * (std::exp(-scattering[c]) + of_photons * scattered);
}
double own_level() { return sidak_level(family_level, 24); }

TEST(PhotonsInAWhiteFurnace, have_the_bias_of_the_ball_at_the_wall) {
  const TestScene scene(furnace);
  constexpr double r = 0.6;
  for (const auto& [name, kernel] :
       {std::pair("constant", Kernel::constant), std::pair("epanechnikov", Kernel::epanechnikov)})
    for (const char* way : {"sppm:alpha=1", "photonmap:gather-rays=0"}) {
      const std::string own = std::string(way) + ",photons=4096,nee=off,medium-radius=0.6,radius=0.1,kernel=" + name;
      const Mean m = measure(scene, own, 8, 3);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto p = [&](double truth) { return p_value(m.mean[c], m.standard_error[c], truth); };
        const double truth = radiance(c, r, kernel);
        EXPECT_GE(p(truth), own_level()) << own << ", component " << c << ": " << m.mean[c] << " +- "
                                         << m.standard_error[c] << " for " << truth;
        // Flux that is not divided by the scattering coefficient, or twice; light without bias.
        EXPECT_LT(p(radiance(c, r, kernel, scattering[c])), own_level()) << own;
        EXPECT_LT(p(radiance(c, r, kernel, 1 / scattering[c])), own_level()) << own;
        if (c == 1 && kernel == Kernel::constant) {
          EXPECT_LT(p(glow[c]), own_level()) << own;
        }
      }
    }
}

// The mean over frames is that of their radii, whose cubes shrink as the squares do on surfaces.
TEST(PhotonsInAWhiteFurnace, lose_their_bias_from_frame_to_frame_as_the_radii_say) {
  const TestScene scene(furnace);
  constexpr int frames = 64;
  constexpr double alpha = 0.3, first = 0.8;
  const Mean m =
      measure(scene, "sppm:nee=off,kernel=constant,photons=4096,radius=0.1,alpha=0.3,medium-radius=0.8", frames, 7);
  const auto mean_radiance = [&](std::size_t c, double power) {
    double sum = 0, content = 1;
    for (int i = 1; i <= frames; ++i)
      sum += radiance(c, first * std::pow(content, 1 / power), Kernel::constant) / frames,
          content *= (i + alpha) / (i + 1);
    return sum;
  };
  for (std::size_t c = 0; c < 3; ++c) {
    const auto p = [&](double truth) { return p_value(m.mean[c], m.standard_error[c], truth); };
    EXPECT_GE(p(mean_radiance(c, 3)), own_level())
        << m.mean[c] << " +- " << m.standard_error[c] << " for " << mean_radiance(c, 3);
    if (c != 1) continue;
    EXPECT_LT(p(mean_radiance(c, 2)), own_level()) << "the exponent of surfaces, component " << c;
    EXPECT_LT(p(radiance(c, first, Kernel::constant)), own_level()) << "a radius that does not shrink";
  }
}

// What a fog scatters once, of a point light at (1, 0, 0), toward a camera at (0, 0, 5): photons straight from the
// light are all that is seen. The phase function depends on the way that each of them came.
TEST(PhotonsInFog, scatter_the_light_of_a_point_once) {
  constexpr double intensity[] = {1, 2, 3}, absorption[] = {0.1, 0.2, 0}, sigma[] = {0.2, 0.3, 0.5};
  const auto seen = [&](std::size_t c, double g, double power) {
    constexpr int steps = 20000;
    const double from = std::atan(-5.0), to = pi / 2;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double z = std::tan(from + (to - from) * (i + 0.5) / steps), t = 5 + z, r = std::sqrt(1 + z * z);
      const double d = 1 + g * g + 2 * g * z / r;
      sum += (1 - g * g) / (4 * pi * d * std::sqrt(d)) * std::exp(-(absorption[c] + sigma[c]) * (t + r));
    }
    return std::pow(sigma[c], power) * intensity[c] * sum * (to - from) / steps;
  };
  const TestScene scene(R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
Integrator "volpath" "integer maxdepth" 1
MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [ .1 .2 0 ] "rgb sigma_s" [ .2 .3 .5 ] "float g" 0.5
MediumInterface "" "m"
LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
WorldBegin
LightSource "point" "rgb I" [ 1 2 3 ] "point3 from" [ 1 0 0 ]
)");
  const Mean m = measure(scene, "sppm:alpha=1,nee=off,photons=16384,medium-radius=0.05", 64, 11);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto p = [&](double truth) { return p_value(m.mean[c], m.standard_error[c], truth); };
    EXPECT_GE(p(seen(c, 0.5, 1)), own_level())
        << m.mean[c] << " +- " << m.standard_error[c] << " for " << seen(c, 0.5, 1);
    EXPECT_LT(p(seen(c, 0, 1)), own_level()) << "without the phase function";
    EXPECT_LT(p(seen(c, -0.5, 1)), own_level()) << "with directions reversed";
    EXPECT_LT(p(seen(c, 0.5, 2)), own_level()) << "with the square of the coefficient";
  }
}

}  // namespace
}  // namespace montelux::test
