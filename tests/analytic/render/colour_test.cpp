// Colour in closed form: each component by itself.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "colour_means.h"

namespace montelux::test {

namespace {

// What a slab of glass, one unit thick, sends back of light that comes from everywhere, and lets through; seen at the
// angle with this cosine.
struct Slab {
  double eta = 1.5, thickness = 1;
  std::array<double, 3> absorption{0.2, 0.7, 1.5}, tint{0.9, 0.6, 1};

  double of_sky(double cosine, std::size_t component) const {
    const double sine2 = (1 - cosine * cosine) / (eta * eta), inside = std::sqrt(1 - sine2);
    const double parallel = (eta * cosine - inside) / (eta * cosine + inside);
    const double perpendicular = (cosine - eta * inside) / (cosine + eta * inside);
    const double r = (parallel * parallel + perpendicular * perpendicular) / 2;
    const double a = std::exp(-absorption[component] * thickness / inside), t = (1 - r) * tint[component];
    return r + t * t * a * (1 + r * a) / (1 - r * r * a * a);
  }
};

std::string rgb(const std::array<double, 3>& c) {
  return "[ " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + " ]";
}

std::string slab_scene(const Slab& slab, double cosine, const std::string& roughness = "") {
  const double sine = std::sqrt(1 - cosine * cosine);
  return R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
LookAt )" +
         std::to_string(3 * sine) + " " + std::to_string(1 + 3 * cosine) + R"( 0  0 1 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "tinteddielectric" "rgb absorption" )" +
         rgb(slab.absorption) + " \"rgb tint\" " + rgb(slab.tint) + " " + roughness + R"(
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -500 1 -500   -500 1 500   500 1 500   500 1 -500 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -500 0 -500   500 0 -500   500 0 500   -500 0 500 ]
)";
}

TEST(AbsorbingSlab, follows_beer_and_lambert_between_fresnels_reflections) {
  const Slab slab;
  const double cosines[] = {1, 0.7, 0.3};
  const double level = sidak_level(family_level, 3 * 3);
  for (const double cosine : cosines) {
    const TestScene scene(slab_scene(slab, cosine));
    const Mean m = measure(scene, "path", 256, 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const double truth = slab.of_sky(cosine, c);
      EXPECT_GT(p_value(m.mean[c], m.standard_error[c], truth), level)
          << "cosine " << cosine << ", component " << c << ": " << m.mean[c] << " +- " << m.standard_error[c]
          << " where " << truth << " is right";
      // A slab that is a tenth thinner, one whose absorption is that of another component, and one that is clear.
      Slab thinner = slab, other = slab, clear = slab;
      thinner.thickness = 0.9, other.absorption[c] = slab.absorption[(c + 1) % 3], clear.absorption = {0, 0, 0};
      for (const Slab& faulty : {thinner, other, clear})
        EXPECT_LT(p_value(m.mean[c], m.standard_error[c], faulty.of_sky(cosine, c)), level) << cosine << " " << c;
    }
  }
}

// Holds ways of rendering a scene to the colours that paths find, and to finding out that one is a tenth brighter.
void expect_colours_of_paths(const TestScene& scene, int samples_of_path, const std::vector<std::string>& ways,
                             int samples) {
  const Mean path = measure(scene, "path", samples_of_path, 1);
  const double level = sidak_level(family_level, 3 * double(ways.size()));
  std::uint32_t seed = 2;
  for (const std::string& way : ways) {
    const Mean m = measure(scene, way, samples, seed++);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GT(p_value_of_difference(m, path, c, 1), level)
          << way << ", component " << c << ": " << m.mean[c] << " +- " << m.standard_error[c]
          << ", path: " << path.mean[c] << " +- " << path.standard_error[c];
      EXPECT_LT(p_value_of_difference(m, path, c, 1.1), level) << way << ", component " << c;
    }
  }
}

// Rough faces, to which paths are joined: every way finds the same colours.
TEST(AbsorbingSlab, with_rough_faces_looks_the_same_to_every_integrator) {
  const TestScene scene(slab_scene({}, 0.8, "\"float roughness\" 0.5"));
  expect_colours_of_paths(scene, 128,
                          {"naive", "tracepath", "restir-pt:radius=2,neighbours=3,footprint=0.1",
                           "restir-pt:radius=2,neighbours=3,footprint=10", "restir-gi:radius=2,neighbours=3",
                           "restir-pt:shift=replay,neighbours=1,radius=2"},
                          64);
}

// A body of glass one unit high that stands on a diffuse floor, seen from above: what is not glass is within.
struct Pond {
  double eta = 1, albedo = 0.8;
  std::array<double, 3> absorption{0.2, 0.5, 0.9};

  // Of a sky of radiance 1, by the number of paths between floor and surface (cf. Kubelka and Munk 1931): the floor's
  // irradiance over pi is in / (1 - albedo back).
  double of_sky(std::size_t component) const {
    const double a = absorption[component], r = reflected(1), out = (1 - r) / (eta * eta) * std::exp(-a) * albedo;
    return r + out * entering(a) / (1 - albedo * returning(a));
  }
  double reflected(double cosine) const {  // at the surface, of light from above
    const double inside = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
    const double parallel = (eta * cosine - inside) / (eta * cosine + inside);
    const double perpendicular = (cosine - eta * inside) / (cosine + eta * inside);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
  }

 private:
  // Means over the hemisphere, by the cosine, of what f gives at a cosine.
  template <class Function>
  static double mean(Function f) {
    constexpr int n = 200000;
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += f(std::sqrt((i + 0.5) / n));
    return sum / n;
  }
  double entering(double a) const {
    return mean([&](double cosine) {
      return (1 - reflected(cosine)) * std::exp(-a / std::sqrt(1 - (1 - cosine * cosine) / (eta * eta)));
    });
  }
  double returning(double a) const {
    return mean([&](double inside) {
      const double sine2 = (1 - inside * inside) * eta * eta;
      return std::exp(-2 * a / inside) * (sine2 >= 1 ? 1 : reflected(std::sqrt(1 - sine2)));
    });
  }
};

std::string pond_scene(const Pond& pond, const std::string& glass = "", const std::string& more = "",
                       const std::string& light = R"(LightSource "infinite" "rgb L" [ 1 1 1 ])") {
  return R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
LookAt 0 4 0  0 0 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
WorldBegin
)" + light +
         "\nMaterial \"diffuse\" \"rgb reflectance\" " + rgb({pond.albedo, pond.albedo, pond.albedo}) + R"(
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -500 0 -500   -500 0 500   500 0 500   500 0 -500 ]
)" + more +
         "Material \"tinteddielectric\" \"float eta\" " + std::to_string(pond.eta) + " \"rgb absorption\" " +
         rgb(pond.absorption) + " " + glass + R"(
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -500 1 -500   -500 1 500   500 1 500   500 1 -500 ]
)";
}

// The mean of the scene is `truth` of each component, and not a tenth more.
template <class Truth>
void expect_colours(const std::string& scene, const std::string& way, int samples, Truth truth) {
  const Mean m = measure(TestScene(scene), way, samples, 1);
  const double level = sidak_level(family_level, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(p_value(m.mean[c], m.standard_error[c], truth(c)), level)
        << way << ", component " << c << ": " << m.mean[c] << " +- " << m.standard_error[c] << " where " << truth(c)
        << " is right";
    EXPECT_LT(p_value(m.mean[c], m.standard_error[c], 1.1 * truth(c)), level) << way << ", component " << c;
  }
}

TEST(AbsorbingPond, hides_its_floor_by_beer_and_lambert) {
  for (const double eta : {1.0, 1.5}) {
    Pond pond;
    pond.eta = eta;
    for (const char* way : {"path", "naive", "tracepath", "distribution", "restir-gi", "restir-pt"})
      expect_colours(pond_scene(pond), way, 128, [&](std::size_t c) { return pond.of_sky(c); });
  }
  // Without refraction the mean is twice the exponential integral of third order.
  const Pond plain;
  for (std::size_t c = 0; c < 3; ++c) {
    const double a = plain.absorption[c], e3 = (std::exp(-a) * (1 - a) - a * a * std::expint(-a)) / 2;
    EXPECT_NEAR(plain.of_sky(c), 0.8 * std::exp(-a) * 2 * e3, 1e-11);  // rounding; the sum over cosines is off by 2e-13
  }
}

// A lamp within, to which shadow rays go.
TEST(AbsorbingPond, absorbs_the_light_of_a_lamp_within) {
  const Pond pond;
  const std::string lamp = R"(LightSource "point" "rgb I" [ 2 2 2 ] "point3 from" [ 0.75 0.6 0 ])";
  const double squared = 0.75 * 0.75 + 0.6 * 0.6, far = std::sqrt(squared);
  for (const char* way : {"path", "distribution", "tracepath", "restir-di", "restir-gi", "restir-pt"})
    expect_colours(pond_scene(pond, "", "", lamp), way, 64, [&](std::size_t c) {
      return pond.albedo / 3.14159265358979 * 2 * 0.6 / far / squared * std::exp(-pond.absorption[c] * (1 + far));
    });
}

// Clear ice in the pond, and a dark body in that.
TEST(AbsorbingPond, has_other_bodies_within) {
  const Pond pond;
  const auto layer = [](double from, double to) {
    const auto sheet = [](double y, bool up) {
      const std::string h = " " + std::to_string(y) + " ";
      return std::string("Shape \"trianglemesh\" \"integer indices\" ") +
             (up ? "[ 0 1 2  0 2 3 ]" : "[ 0 2 1  0 3 2 ]") + " \"point3 P\" [ -500" + h + "-500  -500" + h +
             "500  500" + h + "500  500" + h + "-500 ]\n";
    };
    return sheet(from, false) + sheet(to, true);
  };
  const std::string ice = "Material \"dielectric\" \"float eta\" 1\n" + layer(0.3, 0.7);
  Pond thinner = pond;
  for (double& a : thinner.absorption) a *= 0.6;
  for (const char* way : {"path", "distribution", "restir-pt"})
    expect_colours(pond_scene(pond, "", ice), way, 128, [&](std::size_t c) { return thinner.of_sky(c); });
}

// Rough glass and a rough floor, to which paths are joined.
TEST(AbsorbingPond, under_rough_glass_looks_the_same_to_every_integrator) {
  Pond pond;
  pond.eta = 1.5;
  const TestScene scene(pond_scene(pond, "\"float roughness\" 0.5"));
  expect_colours_of_paths(scene, 256,
                          {"naive", "tracepath", "distribution", "restir-pt:radius=2,neighbours=3,footprint=0.1",
                           "restir-pt:radius=2,neighbours=3,footprint=10", "restir-gi:radius=2,neighbours=3",
                           "restir-pt:shift=replay,neighbours=1,radius=2"},
                          192);
}

// A pane of green glass multiplies what goes through it.
TEST(TintedPane, multiplies_what_goes_through) {
  const std::string text = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
LookAt 0 3 0  0 1 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "thindielectric" "float eta" 1.5 "rgb tint" [ 0.2 0.9 0.5 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -5 1 -5   -5 1 5   5 1 5   5 1 -5 ]
)";
  const Mean m = measure(TestScene(text), "path", 64, 1);
  const double r = 0.04, reflected = 2 * r / (1 + r), tint[] = {0.2, 0.9, 0.5};
  for (std::size_t c = 0; c < 3; ++c) {
    const double truth = reflected + (1 - reflected) * tint[c];
    EXPECT_GT(p_value(m.mean[c], m.standard_error[c], truth), sidak_level(family_level, 3)) << c;
    EXPECT_LT(p_value(m.mean[c], m.standard_error[c], 0.97 * truth), sidak_level(family_level, 3)) << c;
  }
}

// Black paint under a coat, seen at 60 degrees: `maps` says which way base and coat look. The sky is white,
// or `more` has lamps.
std::string painted_scene(const std::string& maps,
                          const std::string& more = R"(LightSource "infinite" "rgb L" [ 1 1 1 ])") {
  return R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
LookAt 3.4641016 2 0  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
WorldBegin
)" + more +
         R"(
Material "coatedmetallicroughness" "rgb basecolor" [ 0 0 0 ] "float metallic" 0 "float specular" 0 )" +
         maps + R"(
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point2 uv" [ 0 0  0 1  1 1  1 0 ]
    "point3 P" [ -5 0 -5   -5 0 5   5 0 5   5 0 -5 ]
)";
}

// A smooth coat reflects by its own normal, which is the surface's where it has no map: not by that of the base.
TEST(ClearCoat, looks_where_its_own_map_says) {
  const auto schlick = [](double degrees) { return 0.04 + 0.96 * std::pow(1 - std::cos(degrees / 180 * M_PI), 5); };
  // Tilted by 30 degrees from the normal toward u, which is toward the camera.
  const std::string tilted = R"(normaltexture" [ 0.75 0.5 0.9330127 ] )";
  const struct {
    std::string maps;
    double degrees;
  } cases[] = {{"", 60},
               {"\"rgb " + tilted, 60},
               {"\"rgb coat" + tilted, 30},
               {"\"rgb coat" + tilted + "\"rgb " + tilted, 30},
               {"\"rgb coat" + tilted + "\"float coatnormalscale\" [ 0 0 ]", 60}};
  for (const auto& c : cases) {
    const Mean m = measure(TestScene(painted_scene(c.maps)), "path", 64, 1);
    EXPECT_GT(p_value(m.mean[0], m.standard_error[0], schlick(c.degrees)), sidak_level(family_level, 4)) << c.maps;
    EXPECT_LT(p_value(m.mean[0], m.standard_error[0], schlick(90 - c.degrees)), sidak_level(family_level, 4)) << c.maps;
  }
}

// A rough coat that looks away from its base: light samples and the coat's own directions find the same.
TEST(ClearCoat, that_is_bent_looks_the_same_to_every_integrator) {
  const std::string lamps = R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 5 5 5 ]
Translate -1 2 1
Shape "sphere" "float radius" 0.7
Translate 3 -1.2 -1
Shape "sphere" "float radius" 0.5
AttributeEnd)";
  const TestScene scene(painted_scene(R"("float clearcoatroughness" 0.6 "rgb coatnormaltexture" [ 0.1 0.5 0.8 ]
    "rgb normaltexture" [ 0.9 0.5 0.8 ])",
                                      lamps));
  const Mean path = measure(scene, "path", 256, 1);
  EXPECT_GT(path.mean[0], 0.01);
  std::uint32_t seed = 2;
  for (const char* way : {"naive", "path:light-selection=ris:4", "direct", "tracepath", "restir-di:radius=2"}) {
    const Mean m = measure(scene, way, 256, seed++);
    EXPECT_GT(p_value_of_difference(m, path, 0, 1), sidak_level(family_level, 5)) << way << " " << m.mean[0];
    EXPECT_LT(p_value_of_difference(m, path, 0, 1.1), sidak_level(family_level, 5)) << way << " " << m.mean[0];
  }
}

}  // namespace

}  // namespace montelux::test
