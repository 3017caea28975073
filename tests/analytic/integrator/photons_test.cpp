// Photon maps find closed forms, their bias among them: how much of a kernel lies within a wall is known.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "colour_means.h"
#include "integrator/photons/sppm.h"

namespace montelux::test {
namespace {

constexpr double emission[] = {0.6, 0.3, 0.5}, reflectance[] = {0.5, 0.75, 0.2};

// The inside of a coloured box of side 2 that glows; the picture is exactly one of its walls.
const char* const wall = R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
LookAt 0 0 0   0 0 1   0 1 0
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
WorldBegin
AreaLightSource "diffuse" "rgb L" [ 0.6 0.3 0.5 ] "bool twosided" true
Material "diffuse" "rgb reflectance" [ 0.5 0.75 0.2 ]
Shape "bilinearmesh" "integer indices" [ 0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7 ]
    "point3 P" [ -1 -1 -1   1 -1 -1   -1 1 -1   1 1 -1   -1 -1 1   1 -1 1   -1 1 1   1 1 1 ]
)";

// A kernel with the mean distance of its photons and that of their squares, for the radius 1.
struct Kernel {
  const char* name;
  double distance, squared;
};
constexpr Kernel constant{"constant", 2.0 / 3, 1.0 / 2}, epanechnikov{"epanechnikov", 8.0 / 15, 1.0 / 3},
    cone{"cone", 1.0 / 2, 3.0 / 10};
std::string setting(const Kernel& kernel) { return std::string(",kernel=") + kernel.name; }

// The mean share of a kernel of radius r that lies within a square of side 2 around whose points it is laid: the mean
// of (1 - |x| / 2) (1 - |y| / 2) over the kernel.
double share_within(double r, const Kernel& kernel) {
  return 1 - kernel.distance * r * 2 / std::numbers::pi + kernel.squared * r * r / std::numbers::pi / 4;
}
// Radiance of the wall where photons bring `share` of what they should: of all reflected light, or of what has been
// reflected more than once.
double radiance(std::size_t c, double share, bool nee) {
  const double once = emission[c] * reflectance[c], all = once / (1 - reflectance[c]);
  return emission[c] + (nee ? once + share * (all - once) : share * all);
}
double level(std::size_t tests) { return sidak_level(family_level, double(tests)); }

TEST(PhotonBias, is_that_of_the_kernel_at_the_edges_of_a_wall) {
  const TestScene scene(wall);
  struct Case {
    double radius;
    Kernel kernel, other;
    bool nee;
  };
  const Case cases[] = {{0.4, epanechnikov, constant, true},  {0.2, epanechnikov, constant, true},
                        {0.1, epanechnikov, constant, true},  {0.05, epanechnikov, constant, true},
                        {0.4, constant, epanechnikov, true},  {0.2, constant, epanechnikov, true},
                        {0.1, constant, epanechnikov, true},  {0.2, epanechnikov, constant, false},
                        {0.2, constant, epanechnikov, false}, {0.4, cone, constant, true}};
  const double own = level(3 * std::size(cases));
  for (const Case& c : cases) {
    const std::string way =
        "sppm:alpha=1,radius=" + std::to_string(c.radius) + setting(c.kernel) + ",nee=" + (c.nee ? "on" : "off");
    const Mean m = measure(scene, way, 4, 5);
    const double share = share_within(c.radius, c.kernel);
    for (std::size_t i = 0; i < 3; ++i) {
      const double truth = radiance(i, share, c.nee), se = m.standard_error[i];
      EXPECT_GE(p_value(m.mean[i], se, truth), own)
          << way << ", component " << i << ": " << m.mean[i] << " +- " << se << " where " << truth << " is right";
      // The light without bias, and the bias of the other kernel.
      if (i == 2) continue;
      EXPECT_TRUE(c.radius < 0.1 || p_value(m.mean[i], se, radiance(i, 1, c.nee)) < own) << way;
      const double other = radiance(i, share_within(c.radius, c.other), c.nee);
      EXPECT_TRUE(c.radius < (i == 1 ? 0.2 : 0.4) || p_value(m.mean[i], se, other) < own) << way;
    }
  }
}

// The mean over frames is that of their radii.
TEST(PhotonBias, falls_from_frame_to_frame_as_the_radii_say) {
  const TestScene scene(wall);
  const double own = level(9);
  for (const int frames : {1, 4, 32}) {
    const Mean m = measure(scene, "sppm:radius=0.4,alpha=0.4", frames, 7);
    double share = 0, squared = 0.4 * 0.4;
    for (int i = 1; i <= frames; ++i) {
      share += share_within(std::sqrt(squared), epanechnikov) / frames;
      squared *= (i + 0.4) / (i + 1);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const double truth = radiance(i, share, true);
      EXPECT_GE(p_value(m.mean[i], m.standard_error[i], truth), own)
          << frames << " frames: " << m.mean[i] << " +- " << m.standard_error[i] << " where " << truth << " is right";
      const double at_first = radiance(i, share_within(0.4, epanechnikov), true);
      EXPECT_TRUE(frames == 1 || i == 2 || p_value(m.mean[i], m.standard_error[i], at_first) < own);
    }
  }
}

// A sphere's cap within the distance r has the area of a disk of this radius (Archimedes), so that a kernel over
// distances in space collects all the flux. But of a photon at the distance d from the point that gathers, the share
// (1 - cos a) / 2 of uniform light comes from below the horizon there; a is the angle between the normals, and
// 1 - cos a = d^2 / (2 R^2).
TEST(PhotonBias, is_that_of_the_horizon_within_a_sphere_of_uniform_light) {
  const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
  const TestScene scene(read_text(folder / "closed-furnace-sphere.pbrt"), folder.string());
  constexpr double glow = 0.5, albedo = 0.6, radius = 1, r = 0.5;
  for (const Kernel& kernel : {epanechnikov, constant, cone})
    for (const bool nee : {true, false}) {
      const std::string way =
          std::string("sppm:radius=0.5,alpha=1,photons=16384") + setting(kernel) + ",nee=" + (nee ? "on" : "off");
      const Mean m = measure(scene, way, 2, 3);
      const double share = 1 - kernel.squared * r * r / (4 * radius * radius);
      const double all = glow * albedo / (1 - albedo), once = nee ? glow * albedo : 0;
      const double value = glow + once + share * (all - once);
      EXPECT_GE(p_value(m.mean[0], m.standard_error[0], value), level(6))
          << way << ": " << m.mean[0] << " +- " << m.standard_error[0] << ", " << value;
      EXPECT_LT(p_value(m.mean[0], m.standard_error[0], glow + all), level(6)) << way;
    }
}

// Within the same sphere the surfaces at the ends of gather rays show the horizon's bias, and so the light that they
// send, which is scattered once more, in full. Direct light is without bias.
TEST(PhotonBias, is_seen_by_way_of_gather_rays_within_a_sphere_of_uniform_light) {
  const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
  const TestScene scene(read_text(folder / "closed-furnace-sphere.pbrt"), folder.string());
  constexpr double glow = 0.5, albedo = 0.6, radius = 1, r = 0.5;
  for (const Kernel& kernel : {epanechnikov, constant, cone})
    for (const int rays : {1, 3}) {
      const std::string way =
          "photonmap:radius=0.5,photons=16384,caustic-radius=0.5,gather-rays=" + std::to_string(rays) + setting(kernel);
      const Mean m = measure(scene, way, 2, 3);
      const double share = 1 - kernel.squared * r * r / (4 * radius * radius);
      const auto light = [&](double of_photons) {
        return glow + albedo * (glow + of_photons * glow * albedo / (1 - albedo));
      };
      EXPECT_GE(p_value(m.mean[0], m.standard_error[0], light(share)), level(6))
          << way << ": " << m.mean[0] << " +- " << m.standard_error[0] << ", " << light(share);
      EXPECT_LT(p_value(m.mean[0], m.standard_error[0], light(1)), level(6)) << way;
      // Photons that are looked up at the surface in view have the bias without the albedo.
      EXPECT_LT(p_value(m.mean[0], m.standard_error[0], glow / (1 - albedo) * share), level(6)) << way;
    }
}

// The global map at the surface in view is what sppm gathers in its first frame.
TEST(PhotonBias, of_the_global_map_in_view_is_that_of_the_kernel_at_the_edges_of_a_wall) {
  const TestScene scene(wall);
  for (const bool nee : {true, false}) {
    const std::string way = std::string("photonmap:gather-rays=0,radius=0.4,nee=") + (nee ? "on" : "off");
    const Mean m = measure(scene, way, 4, 5);
    const double share = share_within(0.4, epanechnikov);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_GE(p_value(m.mean[i], m.standard_error[i], radiance(i, share, nee)), level(4)) << way << ", " << i;
      EXPECT_LT(p_value(m.mean[i], m.standard_error[i], radiance(i, 1, nee)), level(4)) << way << ", " << i;
    }
  }
}

// Where photons are uniform the estimate by the nearest ones has the right mean, however few they are: the distance of
// the next one is that of a disk whose area is right for those within. Only the horizon biases it, in proportion to the
// area that holds so many photons, and so to one over the number of light paths.
TEST(PhotonBias, by_the_nearest_photons_is_that_of_the_area_that_holds_them) {
  const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
  const TestScene scene(read_text(folder / "closed-furnace-sphere.pbrt"), folder.string());
  constexpr double glow = 0.5, albedo = 0.6, light = glow / (1 - albedo);
  const auto by_nearest = [&](int nearest, int photons, const char* kernel) {
    const std::string way = "photonmap:gather-rays=0,nee=off,radius=2,nearest=" + std::to_string(nearest) +
                            ",photons=" + std::to_string(photons) + ",kernel=" + kernel;
    return measure(scene, way, 4, 3);
  };
  for (const char* kernel : {"constant", "epanechnikov"}) {
    const Mean few = by_nearest(2, 16384, kernel);
    EXPECT_GE(p_value(few.mean[0], few.standard_error[0], light), level(6)) << few.mean[0];
    // A disk of the second photon itself, which counts it, too.
    EXPECT_LT(p_value(few.mean[0], few.standard_error[0], glow + 2 * (light - glow)), level(6))
        << few.standard_error[0];
  }
  const Mean coarse = by_nearest(2048, 16384, "constant"), fine = by_nearest(2048, 4 * 16384, "constant");
  const double bias = light - coarse.mean[0], of_fine = light - fine.mean[0];
  const double error = std::hypot(coarse.standard_error[0], 4 * fine.standard_error[0]);
  EXPECT_GT(bias, 10 * coarse.standard_error[0]);
  EXPECT_GE(2 * student_t_cdf(-std::abs(bias - 4 * of_fine) / error, passes - 1), level(6)) << bias << ", " << of_fine;
  EXPECT_LT(2 * student_t_cdf(-std::abs(bias - of_fine) / error, passes - 1), level(6)) << bias << ", " << of_fine;
}

TEST(PhotonBias, falls_with_the_number_of_photons) {
  const TestScene scene(wall);
  double before = 1;
  for (const int photons : {2000, 32000}) {
    const std::string number = std::to_string(photons);
    const Mean m = measure(scene, "photonmap:gather-rays=1,photons=" + number + ",caustic-photons=1000", 4, 5);
    const double bias = 1 - m.mean[1] / radiance(1, 1, true), error = m.standard_error[1] / m.mean[1];
    EXPECT_GT(bias, 3 * error);
    // The radius is a quarter, and the share of the light that is lost at edges with it.
    EXPECT_TRUE(photons == 2000 || bias + 3 * error < before / 2) << bias << " after " << before << " +- " << error;
    before = bias;
  }
}

TEST(PhotonBias, is_named_with_its_radius) {
  const TestScene scene(wall);
  EXPECT_EQ(scene.integrator("sppm:radius=0.25").biases, std::vector<std::string>{"radius=0.25"});
  EXPECT_EQ(scene.integrator("sppm:radius=0.25,maxdepth=3").biases,
            (std::vector<std::string>{"radius=0.25", "maxdepth=3"}));
  EXPECT_EQ(scene.integrator("photonmap:radius=0.25,caustic-radius=0.1").biases,
            (std::vector<std::string>{"radius=0.25", "caustic-radius=0.1"}));
  EXPECT_EQ(scene.integrator("photonmap:radius=0.25,gather-rays=0").biases, std::vector<std::string>{"radius=0.25"});
}

}  // namespace
}  // namespace montelux::test
