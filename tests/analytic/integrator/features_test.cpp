// Feature layers: of mirrors and smooth glass they show the surfaces that are seen in them, by Fresnel's equations at
// normal incidence.
#include <gtest/gtest.h>

#include <cmath>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {
namespace {

using Colour = std::array<double, 3>;

constexpr Colour front{0.8, 0.4, 0.1}, back{0.1, 0.3, 0.6};
// What stays of float arithmetic, and of rays that are not quite normal.
constexpr double rounding = 3e-5;

std::string rgb(const Colour& c) {
  std::ostringstream out;
  out << " [ " << c[0] << " " << c[1] << " " << c[2] << " ] ";
  return out.str();
}

// A camera that looks along z through `object`, between a wall in front and one behind.
std::string scene_of(const std::string& object, bool walls = true) {
  const std::string head = R"(LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" [ 0.02 ]
Film "rgb" "integer xresolution" [ 24 ] "integer yresolution" [ 16 ]
PixelFilter "box"
WorldBegin
LightSource "point" "rgb I" [ 9 9 9 ] "point3 from" [ 0 1 0.2 ]
)";
  const std::string room = "Material \"diffuse\" \"rgb reflectance\"" + rgb(front) +
                           "Shape \"bilinearmesh\" \"point3 P\" [ -5 -5 3  5 -5 3  -5 5 3  5 5 3 ]\nMaterial "
                           "\"diffuse\" \"rgb reflectance\"" +
                           rgb(back) + "Shape \"bilinearmesh\" \"point3 P\" [ -5 -5 -1  5 -5 -1  -5 5 -1  5 5 -1 ]\n";
  return head + (walls ? room : "") + object;
}
const std::string sheet = "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]\n";
const std::string ball = "Translate 0 0 1.5\nShape \"sphere\" \"float radius\" [ 0.5 ]\n";

// Over the pixels, which all see the same.
struct Shown {
  std::array<SampleSummary, 3> albedo;
  SampleSummary normal, depth;  // the normal's z
};
Shown shown(const std::string& text, const std::string& way) {
  const TestScene scene(text);
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  const Film film = render(chosen.any(), scene.settings(PointSetKind::independent, {8, 4}, 7), silent).film;
  std::array<std::vector<double>, 5> values;
  for (int y = 0; y < film.bounds().y1; ++y)
    for (int x = 0; x < film.bounds().x1; ++x) {
      const PixelFeatures f = film.features(x, y);
      EXPECT_EQ(f.hits, f.samples);
      for (std::size_t c = 0; c < 3; ++c) values[c].push_back(f.albedo(int(c)) / f.hits);
      values[3].push_back(f.normal(2) / f.hits), values[4].push_back(f.depth() / f.hits);
    }
  return {
      {summarize(values[0]), summarize(values[1]), summarize(values[2])}, summarize(values[3]), summarize(values[4])};
}

bool agrees(const SampleSummary& s, double truth) {
  const double distance = std::max(0.0, std::abs(s.mean - truth) - rounding);
  return distance == 0 || z_test(distance, s.standard_error(), 0).p_value > sidak_level(family_level, 200);
}

struct Truth {
  Colour albedo;
  double normal;
};
// `planted`: what must be rejected.
void expect(const std::string& text, const std::string& way, const Truth& truth, const Truth& planted) {
  const Shown s = shown(text, way);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_TRUE(agrees(s.albedo[c], truth.albedo[c])) << way << " " << c << ": " << s.albedo[c].mean << " +- "
                                                      << s.albedo[c].standard_error() << ", not " << truth.albedo[c];
    EXPECT_FALSE(agrees(s.albedo[c], planted.albedo[c])) << way << " " << c;
  }
  EXPECT_TRUE(agrees(s.normal, truth.normal)) << way << ": " << s.normal.mean << ", not " << truth.normal;
  EXPECT_FALSE(agrees(s.normal, planted.normal)) << way;
  EXPECT_NEAR(s.depth.mean, 1, 1e-4) << way;  // of the first surface
}

const std::vector<std::string> ways{"path",
                                    "path:lanes=one",
                                    "naive",
                                    "restir-di",
                                    "restir-gi",
                                    "restir-pt",
                                    "bdpt",
                                    "vcm",
                                    "sppm:photons=1000",
                                    "photonmap:photons=1000,caustic-photons=1000",
                                    "metropolis",
                                    "irradiance-cache"};

Colour product(const Colour& a, const Colour& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
Colour scaled(const Colour& a, double by) { return {by * a[0], by * a[1], by * a[2]}; }

TEST(Features, of_a_mirror_are_those_of_the_wall_that_it_shows) {
  const Colour reflectance{0.64, 0.25, 0.81};
  const std::string mirror =
      scene_of("Material \"conductor\" \"float roughness\" [ 0 ] \"rgb reflectance\"" + rgb(reflectance) + sheet);
  for (const std::string& way : ways) expect(mirror, way, {product(reflectance, back), 1}, {reflectance, -1});
}

TEST(Features, of_a_mirror_that_shows_nothing_are_its_own) {
  const Colour reflectance{0.64, 0.25, 0.81};
  const std::string mirror = scene_of(
      "Material \"conductor\" \"float roughness\" [ 0 ] \"rgb reflectance\"" + rgb(reflectance) + sheet, false);
  for (const std::string& way : ways) expect(mirror, way, {reflectance, -1}, {scaled(reflectance, 1.001), 0});
}

TEST(Features, of_a_pane_are_those_of_both_walls) {
  const Colour tint{0.9, 0.5, 0.2};
  const std::string pane =
      scene_of("Material \"thindielectric\" \"float eta\" [ 1.5 ] \"rgb tint\"" + rgb(tint) + sheet);
  const double once = 0.04, reflected = 2 * once / (1 + once);
  Colour albedo = product(tint, front);
  for (std::size_t c = 0; c < 3; ++c) albedo[c] = reflected * back[c] + (1 - reflected) * albedo[c];
  Colour own{};
  for (std::size_t c = 0; c < 3; ++c) own[c] = reflected + (1 - reflected) * tint[c];
  for (const std::string& way : ways) expect(pane, way, {albedo, reflected - (1 - reflected)}, {own, -1});
}

// Coloured glass: all ways of light between its faces, with what is absorbed and what the faces tint.
TEST(Features, of_a_glass_ball_are_those_of_both_walls) {
  const Colour tint{0.9, 0.7, 0.5}, absorption{0.1, 0.5, 1};
  const std::string glass = scene_of("Material \"tinteddielectric\" \"float eta\" [ 1.5 ] \"rgb tint\"" + rgb(tint) +
                                     "\"rgb absorption\"" + rgb(absorption) + ball);
  const double r = 0.04;
  Colour albedo{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double left = std::exp(-absorption[c]), both = (1 - r) * (1 - r) * tint[c] * tint[c] * left;
    const double rounds = 1 / (1 - r * r * left * left);
    albedo[c] = both * rounds * front[c] + (r + both * r * left * rounds) * back[c];
  }
  const double through = (1 - r) / (1 + r);
  Colour clear = albedo;
  for (std::size_t c = 0; c < 3; ++c) clear[c] /= std::exp(-absorption[c]);
  for (const std::string way : {"path:roulette=off,maxdepth=64", "path:roulette=off,maxdepth=64,lanes=one"})
    expect(glass, way, {albedo, (1 - through) - through}, {clear, -1});
}

// What scatters is shown itself, whatever is mirrored in it.
TEST(Features, of_a_surface_that_scatters_are_its_own) {
  const Colour reflectance{0.3, 0.2, 0.1}, transmittance{0.1, 0.6, 0.2};
  const std::string sheet_of_paper = scene_of("Material \"diffusetransmission\" \"rgb reflectance\"" +
                                              rgb(reflectance) + "\"rgb transmittance\"" + rgb(transmittance) + sheet);
  Colour both{};
  for (std::size_t c = 0; c < 3; ++c) both[c] = reflectance[c] + transmittance[c];
  for (const std::string& way : ways) expect(sheet_of_paper, way, {both, -1}, {scaled(both, 1.001), 1});

  // A smooth coat over white of which nothing is absorbed.
  const std::string coated = scene_of(
      "Material \"coateddiffuse\" \"float roughness\" [ 0 ] \"float thickness\" [ 1e-6 ] \"integer maxdepth\" [ 4000 ] "
      "\"rgb reflectance\" [ 1 1 1 ]" +
      sheet);
  expect(coated, "path", {{1, 1, 1}, -1}, {{0.98, 0.98, 0.98}, 1});
}

}  // namespace
}  // namespace montelux::test
