// Participating media in closed form, each colour component by itself.
#include <algorithm>

#include "colour_means.h"

namespace montelux::test {

namespace {

using Coefficients = std::array<double, 3>;

std::string rgb(const Coefficients& c) {
  return "[ " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + " ]";
}

struct MediumText {
  Coefficients absorption, scattering;
  double g = 0;
  Coefficients emission{0, 0, 0};
  bool rayleigh = false;
  // Of the phase function, by the cosine of the directions of flight.
  double phase(double cosine) const {
    if (rayleigh) return 3 / (16 * std::numbers::pi) * (1 + cosine * cosine);
    const double d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d));
  }
  double extinction(std::size_t c) const { return absorption[c] + scattering[c]; }
  std::string text() const {
    return R"(MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" )" + rgb(absorption) + " \"rgb sigma_s\" " +
           rgb(scattering) +
           (rayleigh ? std::string(" \"string phase\" \"rayleigh\"") : " \"float g\" " + std::to_string(g)) +
           " \"rgb Le\" " + rgb(emission) + "\n";
  }
};

std::string head(int max_depth) {
  return R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
Integrator "volpath" "integer maxdepth" )" +
         std::to_string(max_depth) + "\n";
}

// Fails where a component contradicts truth(c), or does not contradict faulty(c).
void expect_means(const std::string& scene, const std::string& way, int samples, auto truth, auto faulty) {
  const Mean m = measure(TestScene(scene), way, samples, 1);
  const double level = sidak_level(family_level, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(p_value(m.mean[c], m.standard_error[c], truth(c)), level)
        << way << ", component " << c << ": " << m.mean[c] << " for " << truth(c) << " +- " << m.standard_error[c];
    EXPECT_LT(p_value(m.mean[c], m.standard_error[c], faulty(c)), level) << way << ", component " << c;
  }
}

// A slab of a medium between two interfaces one unit apart, seen at this cosine before a sky of radiance 1.
std::string slab_scene(const MediumText& medium, double cosine, int max_depth) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return head(max_depth) + "LookAt " + std::to_string(3 * sine) + " " + std::to_string(1 + 3 * cosine) +
         R"( 0  0 1 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
)" + medium.text() +
         R"(WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "interface"
MediumInterface "m" ""
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -500 1 -500   -500 1 500   500 1 500   500 1 -500 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -500 0 -500   500 0 -500   500 0 500   -500 0 500 ]
)";
}

TEST(MediumSlab, lets_light_through_as_beer_and_lambert_say) {
  const MediumText absorbs{{0.2, 0.7, 1.5}, {0, 0, 0}};
  // With no event left to scatter, what scatters is lost: extinction, by chance.
  const MediumText scatters{{0.2, 0.1, 0}, {0.3, 0.6, 1.2}, 0.5};
  for (const double cosine : {1.0, 0.5})
    for (const MediumText& m : {absorbs, scatters})
      for (const char* way : {"path", "bdpt"})
        expect_means(
            slab_scene(m, cosine, 0), way, 64, [&](std::size_t c) { return std::exp(-m.extinction(c) / cosine); },
            [&](std::size_t c) { return std::exp(-1.1 * m.extinction(c) / cosine); });
}

TEST(MediumSlab, emits_what_it_absorbs) {
  const MediumText m{{0.2, 0.7, 1.5}, {0, 0, 0}, 0, {2, 3, 0.5}};
  const auto seen = [&](double cosine, std::size_t c) {
    const double left = std::exp(-m.absorption[c] / cosine);
    return m.emission[c] * (1 - left) + left;
  };
  for (const double cosine : {1.0, 0.5})
    for (const char* way : {"path", "bdpt"})
      expect_means(
          slab_scene(m, cosine, 0), way, 16, [&](std::size_t c) { return seen(cosine, c); },
          [&](std::size_t c) { return 1.001 * seen(cosine, c); });
}

// Everything at one temperature looks alike, whatever scatters.
TEST(UnboundedMedium, glows_with_its_own_radiance) {
  const MediumText m{{0.2, 0.7, 1.5}, {1, 0.5, 0.1}, 0.3, {2, 3, 0.5}};
  const std::string scene = head(10000) + m.text() + R"(MediumInterface "" "m"
Camera "perspective" "float fov" 30
WorldBegin
)";
  for (const char* way : {"path", "bdpt"})
    expect_means(
        scene, way, 64, [&](std::size_t c) { return m.emission[c]; },
        [&](std::size_t c) { return 1.02 * m.emission[c]; });
}

// What a fog scatters once, of a point light at (1, 0, 0), toward a camera at (0, 0, 5) that looks at the origin: an
// integral over the line of sight, by the midpoint rule in the angle at the light (Kulla and Fajardo 2012).
double single_scattering(const MediumText& m, std::size_t c, double intensity) {
  constexpr int steps = 200000;
  const double from = std::atan(-5.0), to = 2 * std::atan(1.0);  // of the camera, and at infinity
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double angle = from + (to - from) * (i + 0.5) / steps;
    const double z = std::tan(angle), t = 5 + z, r = std::sqrt(1 + z * z);  // dt / r^2 = d(angle)
    const double cosine = -z / r;  // of the flight from the light to (0, 0, -z), then along +z
    sum += m.scattering[c] * m.phase(cosine) * intensity * std::exp(-m.extinction(c) * (t + r));
  }
  return sum * (to - from) / steps;
}

TEST(UnboundedMedium, scatters_the_light_of_a_point_once) {
  const Coefficients intensity{1, 2, 3};
  for (const double g : {-0.5, 0.0, 0.7, 1.0}) {
    MediumText m{{0.1, 0.2, 0}, {0.2, 0.3, 0.5}, g};
    if (g == 1) m.g = 0, m.rayleigh = true;
    MediumText reversed = m;
    reversed.rayleigh = false, reversed.g = m.rayleigh ? 0 : g == 0 ? 0.3 : -g;
    const std::string scene = head(1) + m.text() + R"(MediumInterface "" "m"
LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -1e-4 1e-4 -1e-4 1e-4 ]
WorldBegin
LightSource "point" "rgb I" )" +
                              rgb(intensity) + " \"point3 from\" [ 1 0 0 ]\n";
    for (const char* way : {"path", "path:mis=balance"})
      expect_means(
          scene, way, 512, [&](std::size_t c) { return single_scattering(m, c, intensity[c]); },
          [&](std::size_t c) { return single_scattering(reversed, c, intensity[c]); });
  }
}

// The same with a wide view of the fog: the mean of single_scattering() over the directions of a picture, whose rays
// pass the light at many distances.
double mean_single_scattering(const MediumText& m, std::size_t c, double intensity, double tangent) {
  constexpr int across = 48, steps = 400;
  const Coefficients light{1, 0, -5};  // from the camera, which looks along -z
  double sum = 0;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      const double x = tangent * (2 * (i + 0.5) / across - 1), y = tangent * (2 * (j + 0.5) / across - 1);
      const double length = std::sqrt(x * x + y * y + 1);
      const double along = (light[0] * x - light[2]) / length;  // to the point nearest the light
      const double distance = std::sqrt(light[0] * light[0] + light[2] * light[2] - along * along);
      const double from = std::atan(-along / distance), to = std::numbers::pi / 2;
      double ray = 0;
      for (int k = 0; k < steps; ++k) {
        const double z = distance * std::tan(from + (to - from) * (k + 0.5) / steps), r = std::hypot(distance, z);
        ray += m.phase(-z / r) * std::exp(-m.extinction(c) * (along + z + r));
      }
      sum += ray * (to - from) / steps / distance;
    }
  return m.scattering[c] * intensity * sum / (across * across);
}

TEST(UnboundedMedium, scatters_the_light_of_a_point_once_for_every_way_to_find_it) {
  const Coefficients intensity{1, 2, 3};
  const double tangent = std::tan(10 * std::numbers::pi / 180);
  const MediumText m{{0.1, 0.2, 0}, {0.2, 0.3, 0.5}, 0.4};
  MediumText other = m;
  other.g = 0.3;
  const std::string scene = head(1) + m.text() + R"(MediumInterface "" "m"
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 20
WorldBegin
LightSource "point" "rgb I" )" +
                            rgb(intensity) + " \"point3 from\" [ 1 0 0 ]\n";
  std::array<double, 3> truth{}, faulty{};
  for (std::size_t c = 0; c < 3; ++c)
    truth[c] = mean_single_scattering(m, c, intensity[c], tangent),
    faulty[c] = mean_single_scattering(other, c, intensity[c], tangent);
  for (const auto& [way, samples] :
       {std::pair("path", 8192), std::pair("light", 16384), std::pair("bdpt", 4096),
        std::pair("vcm:radius=0.01,photons=1024", 128), std::pair("sppm:photons=16", 1024)})
    expect_means(
        scene, way, samples, [&](std::size_t c) { return truth[c]; }, [&](std::size_t c) { return faulty[c]; });
}

// A white medium in a uniform sky cannot be seen: what it scatters out of a ray it scatters into it.
TEST(WhiteMedium, cannot_be_seen_in_a_furnace) {
  const Coefficients sky{1, 0.5, 2};
  const auto ball = [&](const Coefficients& absorption, const std::string& surface) {
    const MediumText m{absorption, {0.5, 2, 5}, 0.6};
    return head(100000) + "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\n" + m.text() +
           "WorldBegin\nLightSource \"infinite\" \"rgb L\" " + rgb(sky) + "\nMediumInterface \"m\" \"\"\nMaterial " +
           surface + "\nShape \"sphere\"\n";
  };
  for (const char* surface : {"\"interface\"", "\"dielectric\""}) {
    for (const auto& [way, fault] : {std::pair("path", 1.05), std::pair("bdpt", 1.25)})
      expect_means(
          ball({0, 0, 0}, surface), way, 128, [&](std::size_t c) { return sky[c]; },
          [&, fault = fault](std::size_t c) { return fault * sky[c]; });
    const Mean gray = measure(TestScene(ball({0.1, 0.1, 0.1}, surface)), "path", 128, 1);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LT(p_value(gray.mean[c], gray.standard_error[c], sky[c]), family_level) << surface;
  }
}

// A point light within a ball of a medium that absorbs: shadow rays cross its boundary and lose what it takes.
TEST(AbsorbingBall, dims_the_light_within_it) {
  const MediumText m{{0.2, 0.7, 1.5}, {0, 0, 0}};
  const std::string scene = head(1) + R"(LookAt 0 5 1  0 -2 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
)" + m.text() + R"(WorldBegin
LightSource "point" "rgb I" [ 1 1 1 ]
AttributeBegin
Material "interface"
MediumInterface "m" ""
Shape "sphere" "float radius" 1
AttributeEnd
Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
Translate 0 -2 0
Rotate -90 1 0 0
Shape "disk" "float radius" 50
)";
  // The camera's ray to the point below the light crosses the ball, too; its chord follows from the geometry.
  const double length = std::sqrt(7 * 7 + 1.0), along = 7 * 5 / length + 1 / length;  // to the point nearest the centre
  const double distance2 = 5 * 5 + 1 - along * along, chord = 2 * std::sqrt(1 - distance2);
  const auto radiance = [&](std::size_t c, double inside) {
    return 0.5 / std::numbers::pi / 4 * std::exp(-m.absorption[c] * (inside + chord));
  };
  expect_means(
      scene, "path", 16, [&](std::size_t c) { return radiance(c, 1); },
      [&](std::size_t c) { return radiance(c, 0.9); });
}

// Media that absorb alone, within bodies whose surfaces scatter, are known to every integrator that follows light
// through glass.
void expect_means_of_bodies(const std::string& scene, std::initializer_list<const char*> ways, int samples, auto truth,
                            auto faulty) {
  EXPECT_FALSE(TestScene(scene).scene().has_participating_media());
  for (const char* way : ways) expect_means(scene, way, samples, truth, faulty);
}

// A ball of radius 1 that absorbs, around what is `within` it, before a sky of radiance 1.
std::string glass_ball(const MediumText& medium, double index, const std::string& within = "") {
  return head(64) + R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
)" + medium.text() +
         R"(WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
)" + within +
         R"(Material "dielectric" "float eta" )" + std::to_string(index) + R"(
MediumInterface "m" ""
Shape "sphere" "float radius" 1
)";
}

// The ray along the diameter of a ball of glass meets its surface at normal incidence, again and again.
TEST(AbsorbingGlass, dims_every_passage_of_light_by_a_diameter) {
  const MediumText m{{0.2, 0.7, 1.5}, {0, 0, 0}};
  const double reflected = 0.04;
  const auto radiance = [&](std::size_t c, double diameter) {
    const double passes = std::exp(-m.absorption[c] * diameter), enters = 1 - reflected;
    return reflected + enters * enters * passes / (1 - reflected * passes);
  };
  const auto truth = [&](std::size_t c) { return radiance(c, 2); };
  const auto faulty = [&](std::size_t c) { return radiance(c, 1); };
  const std::string scene = glass_ball(m, 1.5);
  expect_means_of_bodies(scene, {"path", "bdpt", "distribution", "tracepath", "restir-gi", "restir-pt"}, 64, truth,
                         faulty);
  expect_means_of_bodies(scene, {"metropolis"}, 1024, truth, faulty);
}

// A diffuse plate across a ball without refraction: the sky's light reaches its centre by the radius of the ball, and
// leaves it by another.
TEST(AbsorbingGlass, dims_what_a_plate_within_it_scatters) {
  const MediumText m{{0.2, 0.7, 1.5}, {0, 0, 0}};
  const auto radiance = [&](std::size_t c, double radii) { return 0.5 * std::exp(-m.absorption[c] * radii); };
  expect_means_of_bodies(
      glass_ball(m, 1, "Material \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\nShape \"disk\" \"float radius\" 0.5\n"),
      {"path", "bdpt", "vcm", "distribution", "tracepath", "restir-gi", "restir-pt"}, 16,
      [&](std::size_t c) { return radiance(c, 2); }, [&](std::size_t c) { return radiance(c, 1); });
}

// Light of a lamp below a sheet that spreads what it transmits.
TEST(AbsorbingBody, dims_the_light_of_a_lamp_within_it) {
  const MediumText m{{0.2, 0.7, 1.5}, {0, 0, 0}};
  const std::string scene = head(8) + R"(LookAt 2 5 0  0 1 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
)" + m.text() + R"(WorldBegin
LightSource "point" "rgb I" [ 1 1 1 ]
Material "diffusetransmission" "rgb reflectance" [ 0 0 0 ] "rgb transmittance" [ .5 .5 .5 ]
MediumInterface "m" ""
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]
    "point3 P" [ -500 1 -500   -500 1 500   500 1 500   500 1 -500 ]
)";
  const auto radiance = [&](std::size_t c, double way) {
    return 0.5 / std::numbers::pi * std::exp(-m.absorption[c] * way);
  };
  expect_means_of_bodies(
      scene, {"path", "bdpt", "vcm", "direct", "distribution", "tracepath", "restir-di", "restir-gi", "restir-pt"}, 16,
      [&](std::size_t c) { return radiance(c, 1); }, [&](std::size_t c) { return radiance(c, 0.9); });
}

// A sheet over a medium is an interface for half of the rays: the camera's, and those toward the lamp above it.
TEST(MixedBoundary, lets_its_share_of_shadow_rays_into_the_medium) {
  const MediumText m{{0.2, 0.7, 1.5}, {0, 0, 0}};
  const std::string scene = head(1) + R"(LookAt 2 5 0  0 0 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]
)" + m.text() + R"(WorldBegin
LightSource "point" "point3 from" [ 0 2 0 ] "rgb I" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -9 0 -9   -9 0 9   9 0 9   9 0 -9 ]
MakeNamedMaterial "black" "string type" "diffuse" "rgb reflectance" [ 0 0 0 ]
MakeNamedMaterial "open" "string type" "interface"
Material "mix" "string materials" [ "black" "open" ] "float amount" 0.5
MediumInterface "m" ""
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -9 1 -9   -9 1 9   9 1 9   9 1 -9 ]
)";
  EXPECT_TRUE(TestScene(scene).scene().has_participating_media());
  const double slant = std::sqrt(29.0) / 5;  // of the camera's ray in the medium
  const auto radiance = [&](std::size_t c, double share) {
    return share * 0.5 / std::numbers::pi / 4 * std::exp(-m.absorption[c] * (1 + slant));
  };
  for (const char* way : {"path", "bdpt"})
    expect_means(
        scene, way, 256, [&](std::size_t c) { return radiance(c, 0.25); },
        [&](std::size_t c) { return radiance(c, 0.5); });
}

// Half of the picture is a lamp in the fog, the other half a sky of which an endless fog leaves nothing.
TEST(UnboundedMedium, that_absorbs_dims_what_is_near_and_hides_the_sky) {
  const MediumText m{{0.2, 0.7, 1.5}, {0, 0, 0}};
  const std::string scene = m.text() + "MediumInterface \"\" \"m\"\n" + head(4) + R"(LookAt 0 0 2  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ 0 -9 0  9 -9 0  9 9 0  0 9 0 ]
)";
  EXPECT_TRUE(TestScene(scene).scene().has_participating_media());
  const auto radiance = [&](std::size_t c, double way) { return 0.5 * std::exp(-m.absorption[c] * way); };
  for (const char* way : {"path", "bdpt"})
    expect_means(
        scene, way, 64, [&](std::size_t c) { return radiance(c, 2); }, [&](std::size_t c) { return radiance(c, 1.8); });
}

TEST(Media, that_no_path_can_enter_do_not_count) {
  const std::string text = R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 1 1 1 ]
MakeNamedMedium "tint" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ] "rgb sigma_s" [ 0 0 0 ]
WorldBegin
MediumInterface "fog" "fog"
Shape "sphere"
Material "dielectric"
)";
  const TestScene empty(text), tinted(text + R"(MediumInterface "tint" "" Shape "sphere" "float radius" 2)"),
      foggy(text + R"(MediumInterface "fog" "" Shape "sphere" "float radius" 2)");
  EXPECT_TRUE(empty.scene().media.empty());
  EXPECT_FALSE(tinted.scene().media.empty());
  EXPECT_FALSE(tinted.scene().has_participating_media());
  EXPECT_TRUE(foggy.scene().has_participating_media());
  EXPECT_NO_THROW((void)tinted.integrator("restir-pt"));
  EXPECT_THROW((void)foggy.integrator("restir-pt"), std::runtime_error);
}

TEST(Media, are_refused_by_integrators_that_cannot_cross_them) {
  const TestScene scene(slab_scene({{1, 1, 1}, {0, 0, 0}}, 1, 3));
  for (const char* way :
       {"direct", "distribution", "tracepath", "restir-di", "restir-gi", "restir-pt", "vcm:connect=off", "ao"})
    try {
      (void)scene.integrator(way);
      ADD_FAILURE() << way;
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("participating media"), std::string::npos) << e.what();
    }
}

TEST(Media, without_a_boundary_are_named_where_light_comes_from_infinity) {
  const std::string fog = R"(MakeNamedMedium "fog" "string type" "homogeneous" MediumInterface "" "fog"
Camera "perspective" WorldBegin MediumInterface "fog" "fog" )";
  const auto notes = [](const std::string& text) {
    const TestScene scene(text);
    std::size_t found = 0;
    for (const char* way : {"path", "bdpt"}) {
      ChosenIntegrator chosen = scene.integrator(way);
      note_missing_light(chosen, {}, scene.scene(), scene.accel());
      for (const std::string& note : chosen.notes) found += note.find("no boundary") != std::string::npos;
    }
    return found;
  };
  const std::string ball = R"( Shape "sphere" )", sky = R"( LightSource "infinite" )",
                    sun = R"( LightSource "distant" )";
  EXPECT_EQ(notes(fog + sky + ball), 2u);
  EXPECT_EQ(notes(fog + sun + ball), 2u);
  EXPECT_EQ(notes(fog + R"( LightSource "point" )" + ball), 0u);
  EXPECT_EQ(
      notes(fog + ball + R"( MediumInterface "fog" "" Material "interface" Shape "sphere" "float radius" 5 )" + sky),
      0u);
}

TEST(Media, that_emit_are_named_by_light_tracing_which_misses_them) {
  const auto missing = [](const Coefficients& emission) {
    return TestScene(slab_scene({{1, 1, 1}, {0, 0, 0}, 0, emission}, 1, 3)).integrator("light").missing;
  };
  const std::string name = "light that media emit";
  EXPECT_EQ(std::ranges::count(missing({2, 3, 0.5}), name), 1);
  EXPECT_EQ(std::ranges::count(missing({0, 0, 0}), name), 0);
}

}  // namespace

}  // namespace montelux::test
