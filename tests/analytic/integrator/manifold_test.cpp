// Light through glass balls and off curved mirrors, from lights that no ray hits, against sums over the rays of the
// light: of rotational symmetry, so that one angle decides where a ray meets the floor.
#include <gtest/gtest.h>

#include <complex>
#include <functional>
#include <numbers>

#include "colour_means.h"
#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {
namespace {

using std::numbers::pi;
using Colour = std::array<double, 3>;

constexpr Colour reflectance{0.6, 0.3, 0.15}, intensity{3, 1, 5};

// ---- physics, without anything of the program ----

double fresnel(double cos_i, double eta) {
  const double sin_t = std::sqrt(1 - cos_i * cos_i) / eta;
  if (sin_t >= 1) return 1;
  const double cos_t = std::sqrt(1 - sin_t * sin_t);
  const double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t), p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return (s * s + p * p) / 2;
}
double fresnel_metal(double cos_i, double eta, double k) {
  const std::complex<double> n(eta, k), cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (n * n));
  const auto s = (cos_i - n * cos_t) / (cos_i + n * cos_t), p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
  return (std::norm(s) + std::norm(p)) / 2;
}

// Where a ray of the light meets the floor, and what is left of it; the flux of all rays is that over `share`.
struct Arrival {
  double radius = 0;  // from the axis
  Colour left{1, 1, 1};
  double flux = 0;  // per unit of the parameter and of the azimuth, for a light of intensity (irradiance) 1
};
struct Window {
  double x0, x1, z0, z1;
  std::string text() const {
    std::ostringstream out;
    out << "[ " << x0 << " " << x1 << " " << z0 << " " << z1 << " ]";
    return out.str();
  }
};

// The mean radiance of a diffuse floor over the window: rays between two parameters, at all azimuths.
Colour mean_radiance(const Window& w, double from, double to, const std::function<Arrival(double)>& arrival) {
  constexpr int rays = 20000, azimuths = 720;
  Colour sum{};
  for (int i = 0; i < rays; ++i) {
    const Arrival a = arrival(from + (to - from) * (i + 0.5) / rays);
    int inside = 0;
    for (int j = 0; j < azimuths; ++j) {
      const double phi = 2 * pi * (j + 0.5) / azimuths, x = a.radius * std::cos(phi), z = a.radius * std::sin(phi);
      inside += x > w.x0 && x < w.x1 && z > w.z0 && z < w.z1;
    }
    for (std::size_t c = 0; c < 3; ++c) sum[c] += a.flux * a.left[c] * inside;
  }
  const double scale = (to - from) / rays * (2 * pi / azimuths) / ((w.x1 - w.x0) * (w.z1 - w.z0)) / pi;
  for (std::size_t c = 0; c < 3; ++c) sum[c] *= scale * reflectance[c] * intensity[c];
  return sum;
}

// From the ball of index eta, radius 1, around the origin to the floor at y = -h: a point at polar angle `polar` of the
// sphere, and a direction at the angle `tilt` from the vertical.
double floor_radius(double polar, double tilt, double h) {
  return std::sin(polar) + (std::cos(polar) + h) * std::tan(tilt);
}
// A ray that meets the ball at incidence i, polar angle `polar` and tilt, leaves it by two refractions.
Arrival through_ball(double i, double polar, double tilt, double eta, double h) {
  const double r = std::asin(std::sin(i) / eta), passed = 1 - fresnel(std::cos(i), eta);
  return {floor_radius(polar + pi - 2 * r, tilt - 2 * (i - r), h), {passed * passed, passed * passed, passed * passed}};
}
// A point light on the axis at the height a, a ray at the angle theta from the vertical.
Arrival from_point(double theta, double a, double eta, double h) {
  const double i = std::asin(a * std::sin(theta));
  Arrival r = through_ball(i, i - theta, theta, eta, h);
  r.flux = std::sin(theta);
  return r;
}
// Parallel rays from above, at the distance b from the axis.
Arrival from_sun(double b, double eta, double h) {
  const double i = std::asin(b);
  Arrival r = through_ball(i, i, 0, eta, h);
  r.flux = b;
  return r;
}
// A point light inside the ball, at the height c above its centre.
Arrival from_inside(double theta, double c, double eta, double h) {
  const double i = std::asin(c * std::sin(theta)), t = std::asin(eta * std::sin(i));
  const double passed = 1 - fresnel(std::cos(t), eta);
  return {floor_radius(pi - theta - i, theta + i - t, h), {passed, passed, passed}, std::sin(theta)};
}

// A point light at the height c over the centre of a bowl, the lower part of a metal sphere of radius 1 up to the angle
// pi / 3 from its lowest point; the floor, which looks down, is at the height h.
Arrival in_bowl(double theta, double c, double h) {
  const double i = std::asin(c * std::sin(theta)), polar = theta + i, tilt = polar + i;
  const double left = fresnel_metal(std::cos(i), 0.2, 3.9);
  return {std::sin(polar) - (h + std::cos(polar)) * std::tan(tilt),
          {left, left, left},
          polar < pi / 3 ? std::sin(theta) : 0};
}
// The light of the point in the middle of the window that arrives straight, at the distance d below the floor.
Colour direct_radiance(const Window& w, double d) {
  constexpr int n = 100;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = w.x0 + (w.x1 - w.x0) * (i + 0.5) / n, z = w.z0 + (w.z1 - w.z0) * (j + 0.5) / n;
      sum += d * std::pow(x * x + z * z + d * d, -1.5) / (n * n);
    }
  Colour r;
  for (std::size_t c = 0; c < 3; ++c) r[c] = sum * reflectance[c] / pi * intensity[c];
  return r;
}

// ---- scenes ----

std::string head(const Window& w, const std::string& look) {
  return "Film \"rgb\" \"integer xresolution\" [ 8 ] \"integer yresolution\" [ 8 ]\nPixelFilter \"box\"\n" + look +
         "\nCamera \"orthographic\" \"float screenwindow\" " + w.text() + "\nWorldBegin\n";
}
std::string patch(double side, double y) {
  std::ostringstream p;
  p << "Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.3 0.15 ]\nShape \"trianglemesh\" \"integer indices\" [ 0 1 2  "
       "0 2 3 "
       "]\n    \"point3 P\" [ ";
  for (const auto& [x, z] : {std::pair{-1, -1}, {-1, 1}, {1, 1}, {1, -1}})
    p << x * side << " " << y << " " << z * side << "  ";
  p << "]\n";
  return p.str();
}
const std::string glass = "Material \"dielectric\" \"float eta\" [ 1.5 ]\n";
const std::string metal =
    "Material \"conductor\" \"spectrum eta\" [ 360 0.2 830 0.2 ] \"spectrum k\" [ 360 3.9 830 3.9 ] \"float "
    "roughness\" "
    "[ 0 ]\n";
const std::string ball = "Shape \"sphere\" \"float radius\" [ 1 ]\n";
constexpr double floor_y = -1.8;
const std::string down = "LookAt 0 -1.75 0  0 -1.8 0  0 0 1";

struct Case {
  std::string name, scene, way;
  Colour truth;
  double fault = 1.05;
};
std::vector<Case> cases() {
  std::vector<Case> all;
  const Window centre{-0.1, 0.1, -0.1, 0.1}, aside{0.05, 0.25, -0.1, 0.1};
  const auto add = [&](const std::string& name, const Window& w, const std::string& light, int length, double from,
                       double to, const std::function<Arrival(double)>& arrival) {
    all.push_back({name, head(w, down) + light + patch(0.3, floor_y) + glass + ball,
                   "path:manifold=" + std::to_string(length) + ",maxdepth=" + std::to_string(length + 1),
                   mean_radiance(w, from, to, arrival)});
  };
  const auto at = [](double y) {
    return "LightSource \"point\" \"rgb I\" [ 3 1 5 ] \"point3 from\" [ 0 " + std::to_string(y) + " 0 ]\n";
  };
  for (const auto& [where, w] : {std::pair{"centre", centre}, {"aside", aside}}) {
    add(std::string("point above, ") + where, w, at(3), 2, 0, std::asin(1 / 3.0),
        [](double t) { return from_point(t, 3, 1.5, -floor_y); });
    add(std::string("sun, ") + where, w,
        "LightSource \"distant\" \"rgb L\" [ 3 1 5 ] \"point3 from\" [ 0 1 0 ] \"point3 to\" [ 0 0 0 ]\n", 2, 0, 1,
        [](double b) { return from_sun(b, 1.5, -floor_y); });
    add(std::string("point inside, ") + where, w, at(0.3), 1, 0, pi / 2,
        [](double t) { return from_inside(t, 0.3, 1.5, -floor_y); });
    if (w.x0 > 0) all[all.size() - 3].fault = 1.2;  // the edge of the caustic is in this window
    constexpr double c = 0.2, h = 0.8;
    Colour truth = mean_radiance(w, 0, pi / 3, [](double t) { return in_bowl(t, c, h); });
    const Colour direct = direct_radiance(w, h - c);
    for (std::size_t k = 0; k < 3; ++k) truth[k] += direct[k];
    all.push_back({std::string("bowl, ") + where,
                   head(w, "LookAt 0 0.75 0  0 0.8 0  0 0 1") + at(c) + patch(0.3, h) + metal +
                       "Rotate -90 1 0 0\nShape \"sphere\" \"float radius\" [ 1 ] \"float "
                       "zmin\" [ -1 ] \"float zmax\" [ -0.5 ]\n",
                   "path:manifold=1,maxdepth=2", truth});
  }
  return all;
}

TEST(ManifoldLight, has_the_caustics_of_glass_balls_and_mirrors) {
  const std::vector<Case> all = cases();
  const double own = sidak_level(family_level, 3.0 * double(all.size()));
  for (const Case& c : all) {
    const TestScene scene(c.scene);
    const Mean m = measure(scene, c.way, 128, 7);
    if (std::getenv("MONTELUX_SHOW"))
      for (std::size_t k = 0; k < 3; ++k)
        std::printf("%s %zu: %.6f +- %.6f, %.6f (%+.2f sigma)\n", c.name.c_str(), k, m.mean[k], m.standard_error[k],
                    c.truth[k], (m.mean[k] - c.truth[k]) / m.standard_error[k]);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto p = [&](double truth) { return p_value(m.mean[k], m.standard_error[k], truth); };
      EXPECT_GE(p(c.truth[k]), own) << c.name << ", component " << k << ": " << m.mean[k] << " +- "
                                    << m.standard_error[k] << " where " << c.truth[k] << " is right";
      EXPECT_LT(p(c.fault * c.truth[k]), own) << c.name << " would pass with more: " << m.standard_error[k] / m.mean[k];
    }
  }
}

// A spot whose light comes to a wall by way of two mirrors, `first` and one of metal, each at 45 degrees: 2, 2 and 3
// long.
std::string periscope(const std::string& first) {
  return head({-1e-3, 1e-3, -1e-3, 1e-3}, "LookAt -2.5 3 0  -3 3 0  0 1 0") +
         "LightSource \"spot\" \"rgb I\" [ 3 1 5 ] \"point3 from\" [ -2 1 0 ] \"point3 to\" [ 0 1 0 ] \"float "
         "coneangle\" "
         "[ 5 ] \"float conedeltaangle\" [ 1 ]\n" +
         first +
         "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  0 2 3 ] \"point3 P\" [ -0.5 0.5 -0.5  0.5 1.5 -0.5  0.5 "
         "1.5 "
         "0.5  -0.5 0.5 0.5 ]\n" +
         metal +
         "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  0 2 3 ] \"point3 P\" [ -0.5 3.5 -0.5  0.5 2.5 -0.5  0.5 "
         "2.5 "
         "0.5  -0.5 3.5 0.5 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ 0.6 0.3 0.15 ]\nShape \"trianglemesh\" "
         "\"integer indices\" [ 0 1 2  0 2 3 ] \"point3 P\" [ -3 2 -1  -3 4 -1  -3 4 1  -3 2 1 ]\n";
}
std::vector<std::string> missing(const TestScene& scene, const std::string& way) {
  ChosenIntegrator chosen = scene.integrator(way);
  note_missing_light(chosen, {{}, {}, scene.picture().width, scene.picture().height}, scene.scene(), scene.accel());
  return chosen.missing;
}

TEST(ManifoldLight, finds_chains_of_two_and_names_those_that_are_longer_than_it_was_set_to) {
  const TestScene scene(periscope(metal));
  EXPECT_EQ(measure(scene, "path:manifold=1", 4, 3).mean[0], 0);
  EXPECT_EQ(missing(scene, "path:manifold=1").size(), 1u);
  EXPECT_TRUE(missing(scene, "path:manifold=2").empty());
  const Mean m = measure(scene, "path:manifold=2", 16, 3);
  const double mirrored = fresnel_metal(std::cos(pi / 4), 0.2, 3.9);
  const double own = sidak_level(family_level, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    const double truth = reflectance[k] / pi * intensity[k] * mirrored * mirrored / 49;
    EXPECT_GE(p_value(m.mean[k], m.standard_error[k], truth), own) << m.mean[k] << " +- " << m.standard_error[k];
    EXPECT_LT(p_value(m.mean[k], m.standard_error[k], 1.05 * truth), own) << m.standard_error[k] / m.mean[k];
  }
}

// Every pane is one event; chains with reflections between panes have two more.
TEST(ManifoldLight, goes_through_up_to_four_panes) {
  const Window w{-1e-3, 1e-3, -1e-3, 1e-3};
  const double distance = std::hypot(1, 3 - floor_y), cosine = (3 - floor_y) / distance;
  const double own = sidak_level(family_level, 3 * 4);
  std::string panes;
  double left = 1;
  for (int n = 1; n <= 4; ++n) {
    const std::string y = " " + std::to_string(0.3 * n) + " ";
    panes += "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2  0 2 3 ] \"point3 P\" [ -2" + y + "-2  -2" + y +
             "2  2" + y + "2  2" + y + "-2 ]\n";
    const double r = fresnel(cosine, 1.5);
    left *= 1 - 2 * r / (1 + r);
    const TestScene scene(head(w, down) + "LightSource \"point\" \"rgb I\" [ 3 1 5 ] \"point3 from\" [ 1 3 0 ]\n" +
                          patch(2, floor_y) + "Material \"thindielectric\" \"float eta\" [ 1.5 ]\n" + panes);
    const auto way = [](int k) { return "path:manifold=" + (k == 0 ? "off" : std::to_string(k)); };
    EXPECT_EQ(measure(scene, way(n - 1), 4, 5).mean[0], 0) << n;
    const Mean m = measure(scene, way(n) + ",maxdepth=" + std::to_string(n + 1), 32, 5);
    for (std::size_t k = 0; k < 3; ++k) {
      const double truth = reflectance[k] / pi * intensity[k] * left * cosine / (distance * distance);
      EXPECT_GE(p_value(m.mean[k], m.standard_error[k], truth), own)
          << m.mean[k] << " +- " << m.standard_error[k] << ", " << truth;
      EXPECT_LT(p_value(m.mean[k], m.standard_error[k], 1.05 * truth), own) << m.standard_error[k] / m.mean[k];
    }
  }
}

TEST(ManifoldLight, names_light_by_way_of_smooth_coats) {
  const TestScene scene(periscope("Material \"coateddiffuse\" \"float roughness\" [ 0 ]\n"));
  EXPECT_EQ(missing(scene, "path:manifold=2").size(), 1u);
}

TEST(ManifoldLight, is_refused_in_participating_media) {
  const TestScene scene(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [ 1 1 1 ]\nMediumInterface \"\" "
      "\"fog\"\n" +
      periscope(metal));
  EXPECT_NO_THROW(scene.integrator("path:manifold=off"));
  EXPECT_THROW(scene.integrator("path:manifold=1"), std::runtime_error);
}

}  // namespace
}  // namespace montelux::test
