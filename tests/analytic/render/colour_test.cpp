// Colour in closed form: each component by itself.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

constexpr int passes = 32;

struct Mean {
  std::array<double, 3> mean{}, standard_error{};
};

Mean measure(const TestScene& scene, const std::string& way, int samples_per_pass, std::uint32_t seed) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  const RenderResult result =
      render(chosen.any(), scene.settings(PointSetKind::independent, {samples_per_pass, passes}, seed), silent);
  const ImageEstimate image = result.film.image();
  EXPECT_EQ(result.film.non_finite(), 0u);
  Mean m;
  for (std::size_t c = 0; c < 3; ++c) m.mean[c] = image.mean[c], m.standard_error[c] = image.standard_error[c];
  return m;
}

// Student's test, with an allowance for paths that are summed in 32 bits.
double p_value(double mean, double standard_error, double truth) {
  const double distance = std::max(0.0, std::abs(mean - truth) - 1e-5 * truth);
  return distance == 0 ? 1 : 2 * student_t_cdf(-distance / standard_error, passes - 1);
}

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

std::string slab_scene(const Slab& slab, double cosine, const std::string& roughness = "") {
  const auto rgb = [](const std::array<double, 3>& c) {
    return "[ " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + " ]";
  };
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

// Rough faces, to which paths are joined: every way finds the same colours.
TEST(AbsorbingSlab, with_rough_faces_looks_the_same_to_every_integrator) {
  const TestScene scene(slab_scene({}, 0.8, "\"float roughness\" 0.5"));
  const Mean path = measure(scene, "path", 128, 1);
  const std::vector<std::string> ways{"naive",
                                      "tracepath",
                                      "restir-pt:radius=2,neighbours=3,footprint=0.1",
                                      "restir-pt:radius=2,neighbours=3,footprint=10",
                                      "restir-gi:radius=2,neighbours=3",
                                      "restir-pt:shift=replay,neighbours=1,radius=2"};
  const double level = sidak_level(family_level, 3 * double(ways.size()));
  std::uint32_t seed = 2;
  for (const std::string& way : ways) {
    const Mean m = measure(scene, way, 64, seed++);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto differs_from = [&](double factor) {
        const double variance = m.standard_error[c] * m.standard_error[c] * passes;
        return welch_test({m.mean[c], variance, passes},
                          {factor * path.mean[c], path.standard_error[c] * path.standard_error[c] * passes, passes})
                   .p_value < level;
      };
      EXPECT_FALSE(differs_from(1)) << way << ", component " << c << ": " << m.mean[c] << " +- " << m.standard_error[c]
                                    << ", path: " << path.mean[c] << " +- " << path.standard_error[c];
      EXPECT_TRUE(differs_from(1.1)) << way << ", component " << c;
    }
  }
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

}  // namespace

}  // namespace montelux::test
