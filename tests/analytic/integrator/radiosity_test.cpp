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

// Whether the mean is indistinguishable from the closed form times `off`.
bool finds(const std::string& scene_name, const std::string& way, double level, double off = 1) {
  constexpr int passes = 8;
  const TestScene scene(read_text(folder / scene_name), folder.string());
  const ImageEstimate image = render_film(scene, way, {4, passes}, 5).image();
  const double value = off * expected_mean(scene_name);
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
    EXPECT_TRUE(finds(scene, "radiosity:elementsize=0.3,frames=4,warm-up=40", level)) << scene;
    EXPECT_TRUE(finds(scene, "radiosity:elementsize=0.08,rays=5,frames=4,warm-up=40", level)) << scene;
    EXPECT_TRUE(finds(scene, "radiosity:elementsize=0.5,frames=4,warm-up=40,gather=on", level)) << scene;
  }
}

TEST(Radiosity, differs_from_a_closed_form_that_is_three_percent_off) {
  const double level = sidak_level(family_level, 3.0 * double(even_scenes.size()));
  int rejected = 0;
  for (const std::string& scene : even_scenes)
    rejected += finds(scene, "radiosity:elementsize=0.3,frames=4,warm-up=40", level, 1.03) ? 0 : 1;
  EXPECT_GE(rejected, 6) << "of " << even_scenes.size();
}

TEST(Radiosity, lacks_the_reflections_that_it_was_given_no_frames_for) {
  for (const char* scene : {"closed-furnace-box.pbrt", "closed-furnace-sphere.pbrt"})
    EXPECT_FALSE(finds(scene, "radiosity:elementsize=0.3,frames=4,warm-up=1", family_level)) << scene;
}

// A room with a shadow, seen below its lamp, whose edges would be the noise of both methods. The squared bias of a
// pixel is the product of two independent errors.
constexpr const char* room = R"(
LookAt 0 1 3.4  0 1 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 24 "float cropwindow" [0 1 0.25 1]
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

constexpr std::uint32_t pairs = 5;

// The squared bias against the path tracer's films, mean over pixels and channels: a value from each pair of
// independent errors.
std::vector<double> squared_biases(const TestScene& scene, const std::string& way, const std::vector<Film>& truths) {
  std::vector<double> products;
  for (std::uint32_t i = 0; i < 2 * pairs; i += 2) {
    const Film a = render_film(scene, way, {16, 4}, 10 + i), b = render_film(scene, way, {16, 4}, 11 + i);
    double sum = 0;
    const PixelBounds& bounds = a.bounds();
    for (int y = bounds.y0; y < bounds.y1; ++y)
      for (int x = bounds.x0; x < bounds.x1; ++x)
        for (int c = 0; c < rgb_size; ++c)
          sum += (a.pixel(x, y).mean[c] - truths[i].pixel(x, y).mean[c]) *
                 (b.pixel(x, y).mean[c] - truths[i + 1].pixel(x, y).mean[c]);
    products.push_back(sum / double(bounds.area() * rgb_size));
  }
  return products;
}

// The p-value of "the finer elements have no smaller squared bias", by the differences of each pair, which share the
// path tracer's films.
double p_value_of_no_gain(const std::vector<double>& coarse, const std::vector<double>& fine) {
  std::vector<double> gains;
  for (std::size_t i = 0; i < coarse.size(); ++i) gains.push_back(coarse[i] - fine[i]);
  const SampleSummary s = summarize(gains);
  return student_t_cdf(-s.mean / s.standard_error(), s.count - 1);
}

TEST(Radiosity, comes_nearer_to_the_path_tracer_as_its_elements_become_smaller) {
  const TestScene scene(room);
  std::vector<Film> truths;
  for (std::uint32_t i = 0; i < 2 * pairs; ++i) truths.push_back(render_film(scene, "path", {64, 4}, 50 + i));
  std::vector<std::vector<double>> biases;
  for (const char* size : {"0.4", "0.2", "0.1"}) {
    biases.push_back(squared_biases(scene, std::string("radiosity:elementsize=") + size, truths));
    const SampleSummary s = summarize(biases.back());
    std::printf("elementsize %s: squared bias %.3g +- %.1g\n", size, s.mean, s.standard_error());
  }
  const double level = sidak_level(family_level, 2);
  EXPECT_LT(p_value_of_no_gain(biases[0], biases[1]), level);
  EXPECT_LT(p_value_of_no_gain(biases[1], biases[2]), level);
  // A planted fault: elements that become larger.
  EXPECT_GT(p_value_of_no_gain(biases[1], biases[0]), level);
  EXPECT_GT(p_value_of_no_gain(biases[2], biases[1]), level);
}

TEST(Radiosity, gives_the_same_bits_for_any_number_of_threads) {
  const TestScene scene(room);
  const Film one = render_film(scene, "radiosity:elementsize=0.3,frames=2", {2, 2}, 3, 1);
  const Film two = render_film(scene, "radiosity:elementsize=0.3,frames=2", {2, 2}, 3, 2);
  const PixelBounds& b = one.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) EXPECT_EQ(one.pixel(x, y).mean[0], two.pixel(x, y).mean[0]);
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
