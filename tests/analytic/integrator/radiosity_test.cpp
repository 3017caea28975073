// Radiosity finds closed forms where irradiance is even over what is looked at, and elsewhere the path tracer's picture
// the better the smaller its elements are.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
constexpr double rounding = 2e-4;  // areas of elements of quadrics are by differences

double expected_mean(const std::string& scene) {
  for (const nlohmann::json& e : nlohmann::json::parse(read_text(folder / "expected.json")))
    if (e.at("scene") == scene) return e.at("value").get<double>();
  throw std::runtime_error("no closed form of " + scene);
}

Film render_film(const TestScene& scene, const std::string& way, PassPlan plan, std::uint32_t seed, int threads = 1) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  return render(chosen.any(), scene.settings(PointSetKind::independent, plan, seed, threads), silent).film;
}

bool finds(const std::string& scene_name, const std::string& way, double level) {
  constexpr int passes = 8;
  const TestScene scene(read_text(folder / scene_name), folder.string());
  const ImageEstimate image = render_film(scene, way, {4, passes}, 5).image();
  const double value = expected_mean(scene_name);
  const double distance = std::max(0.0, std::abs(image.mean[0] - value) - rounding * value);
  return distance == 0 || 2 * student_t_cdf(-distance / image.standard_error[0], passes - 1) >= level;
}

const std::vector<std::string> even_scenes{"closed-furnace-box.pbrt", "closed-furnace-sphere.pbrt",
                                           "integrating-sphere.pbrt", "facing-squares.pbrt",
                                           "corner-squares.pbrt",     "sky.pbrt",
                                           "sky-two-tone.pbrt",       "distant-light.pbrt"};

TEST(Radiosity, finds_closed_forms_of_even_irradiance_whatever_the_elements) {
  const double level = sidak_level(family_level, 3.0 * double(even_scenes.size()));
  for (const std::string& scene : even_scenes) {
    EXPECT_TRUE(finds(scene, "radiosity:elementsize=0.3,chain=4,warm-up=40", level)) << scene;
    EXPECT_TRUE(finds(scene, "radiosity:elementsize=0.08,rays=5,chain=4,warm-up=40", level)) << scene;
    EXPECT_TRUE(finds(scene, "radiosity:elementsize=0.5,chain=4,warm-up=40,gather=on", level)) << scene;
  }
}

TEST(Radiosity, lacks_the_reflections_that_it_was_given_no_frames_for) {
  for (const char* scene : {"closed-furnace-box.pbrt", "closed-furnace-sphere.pbrt"})
    EXPECT_FALSE(finds(scene, "radiosity:elementsize=0.3,chain=4,warm-up=1", family_level)) << scene;
}

// A room with a shadow. The squared bias of a pixel is the product of two independent errors.
constexpr const char* room = R"(
LookAt 0 1 3.4  0 1 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
WorldBegin
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "bilinearmesh" "point3 P" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]
Shape "bilinearmesh" "point3 P" [-1 2 -1  1 2 -1  -1 2 1  1 2 1]
Shape "trianglemesh" "point3 P" [-1 0 -1  1 0 -1  1 2 -1  -1 2 -1] "integer indices" [0 1 2 0 2 3]
Material "diffuse" "rgb reflectance" [0.7 0.2 0.1]
Shape "trianglemesh" "point3 P" [-1 0 -1  -1 0 1  -1 2 1  -1 2 -1] "integer indices" [0 1 2 0 2 3]
Shape "trianglemesh" "point3 P" [1 0 -1  1 0 1  1 2 1  1 2 -1] "integer indices" [0 1 2 0 2 3]
Shape "bilinearmesh" "point3 P" [-0.5 0.8 -0.5  0.2 0.8 -0.5  -0.5 0.8 0.2  0.2 0.8 0.2]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [6 6 6] "bool twosided" true
Shape "bilinearmesh" "point3 P" [-0.3 1.9 -0.3  0.3 1.9 -0.3  -0.3 1.9 0.3  0.3 1.9 0.3]
AttributeEnd
)";

struct Bias {
  double squared = 0, standard_error = 0;  // mean over pixels and channels
};

Bias bias_of(const TestScene& scene, const std::string& way, PassPlan plan) {
  constexpr int repeats = 6;
  std::vector<Film> ours, theirs;
  for (std::uint32_t i = 0; i < repeats; ++i) {
    ours.push_back(render_film(scene, way, plan, 10 + i));
    theirs.push_back(render_film(scene, "path", {64, 4}, 50 + i));
  }
  Moments products;  // of disjoint pairs, which are independent
  for (std::size_t i = 0; i + 1 < repeats; i += 2) {
    double sum = 0;
    const PixelBounds& b = ours[i].bounds();
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x)
        for (int c = 0; c < spectrum_size; ++c)
          sum += (ours[i].pixel(x, y).mean[c] - theirs[i].pixel(x, y).mean[c]) *
                 (ours[i + 1].pixel(x, y).mean[c] - theirs[i + 1].pixel(x, y).mean[c]);
    products.add(sum / double(b.area() * spectrum_size));
  }
  return {products.mean, products.standard_error()};
}

TEST(Radiosity, comes_nearer_to_the_path_tracer_as_its_elements_become_smaller) {
  const TestScene scene(room);
  const std::vector<double> sizes{0.2, 0.1, 0.05};
  std::vector<Bias> biases;
  for (double size : sizes) {
    biases.push_back(bias_of(scene, "radiosity:elementsize=" + std::to_string(size), {16, 4}));
    const Bias& b = biases.back();
    std::printf("elementsize %.3g: squared bias %.3g +- %.1g\n", size, b.squared, b.standard_error);
  }
  // By three standard errors each: the coarse elements are seen to be wrong, and halving them takes away half or more.
  EXPECT_GT(biases[0].squared - 3 * biases[0].standard_error, 2 * (biases[1].squared + 3 * biases[1].standard_error));
  EXPECT_LT(biases[2].squared, biases[1].squared);
}

TEST(Radiosity, gives_the_same_bits_for_any_number_of_threads) {
  const TestScene scene(room);
  const Film one = render_film(scene, "radiosity:elementsize=0.3,chain=2", {2, 2}, 3, 1);
  const Film two = render_film(scene, "radiosity:elementsize=0.3,chain=2", {2, 2}, 3, 2);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) EXPECT_EQ(one.pixel(x, y).mean[0], two.pixel(x, y).mean[0]);
}

TEST(Radiosity, refuses_what_is_not_diffuse_and_says_so) {
  const std::string diffuse = R"(Material "diffuse" "rgb reflectance" [0.7 0.2 0.1])";
  const TestScene glass(replaced(room, diffuse, R"(Material "dielectric")"));
  try {
    glass.integrator("radiosity");
    FAIL() << "a pane of glass was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("diffuse surfaces"), std::string::npos) << error.what();
  }
}

}  // namespace

}  // namespace montelux::test
