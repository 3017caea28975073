// Rays that show lamps in view: the light of lamps of known area, with less noise, and none where it is not needed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "film/film.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// A lamp of a hundredth of a pixel, and one of 6 x 5 pixels between their edges, before darkness: at the depth 3,
// where a pixel is `pixel_side` wide.
constexpr int width = 24, height = 16;
const double pixel_side = 2 * 3 * std::tan(std::numbers::pi / 6) / height;
constexpr double small_side = 0.1, large_width = 6.3, large_height = 5.4;  // in pixels
constexpr std::array<double, 3> small_light{100, 50, 25}, large_light{1, 2, 4};

std::string rectangle(double x, double y, double w, double h, const std::array<double, 3>& light,
                      const std::string& group) {
  const double s = pixel_side, x0 = x * s, y0 = y * s, x1 = (x + w) * s, y1 = (y + h) * s;
  return fmt::format(R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [{} {} {}] "bool twosided" true "string group" "{}"
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "trianglemesh" "point3 P" [{} {} 3 {} {} 3 {} {} 3 {} {} 3] "integer indices" [0 1 2 0 2 3]
AttributeEnd
)",
                     light[0], light[1], light[2], group, x0, y0, x1, y0, x1, y1, x0, y1);
}

std::string scene_text(const std::string& lens) {
  return fmt::format(R"(LookAt 0 0 0 0 0 1 0 1 0
Camera "perspective" "float fov" 60 {}
Film "rgb" "integer xresolution" {} "integer yresolution" {}
PixelFilter "box"
WorldBegin
)",
                     lens, width, height) +
         rectangle(-4.27, 2.61, small_side, small_side, small_light, "small") +
         rectangle(1.37, -3.81, large_width, large_height, large_light, "large");
}

double expected(std::size_t channel) {
  return (small_light[channel] * small_side * small_side + large_light[channel] * large_width * large_height) /
         (width * height);
}

RenderResult rendered(const TestScene& scene, const std::string& way, int passes = 64, int samples = 4,
                      int threads = 1) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  PassPlan plan;
  plan.passes = passes, plan.samples_per_pass = samples;
  return render(chosen.any(), scene.settings(PointSetKind::blue_noise, plan, 5, threads), silent);
}

// How many standard errors the mean of a channel is off `truth`, at most, if the image is `factor` times as bright.
template <class Truth>
double deviation_from(Truth truth, const Film& film, double factor = 1) {
  const ImageEstimate image = film.image();
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(factor * image.mean[c] - truth(c)) / (factor * image.standard_error[c]));
  return largest;
}
double deviation(const Film& film, double factor = 1) { return deviation_from(expected, film, factor); }

double mean_square(const Film& film) {
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) sum += film.pixel(x, y).variance_of_mean(c);
  return sum;
}

TEST(LampRays, show_the_light_of_lamps_with_less_noise) {
  for (const std::string lens : {"", R"("float lensradius" 0.05 "float focaldistance" 2)"}) {
    const TestScene scene{std::string_view(scene_text(lens))};
    for (const std::string name : {"path", "restir-di", "restir-pt"}) {
      SCOPED_TRACE(name + " " + lens);
      const Film without = rendered(scene, name + ":lamp-rays=0").film,
                 one = rendered(scene, name + ":lamp-rays=1").film, with = rendered(scene, name).film;
      EXPECT_LT(deviation(without), 4.5);
      EXPECT_LT(deviation(one), 4.5);
      EXPECT_LT(deviation(with), 4.5);
      EXPECT_LT(mean_square(with), mean_square(without) / 4);
      // If the sample's own ray counted as well.
      EXPECT_GT(deviation(with, 2), 10);
      // If they stood for all of the rays: an eighth more of them.
      EXPECT_GT(deviation(with, 9.0 / 8), 4.5);
    }
  }
}

// A medium that absorbs, of another thickness for each channel, in which `part` of the way to the lamps is.
constexpr std::array<double, 3> absorption{0.1, 0.3, 0.6};
constexpr std::string_view medium = R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [0 0 0] )"
                                    R"("rgb sigma_a" [0.1 0.3 0.6]
)";
double expected_through(double part, std::size_t channel) {
  const auto light_of = [&](double x0, double y0, double w, double h, double light) {
    constexpr int n = 64;
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = (x0 + w * (i + 0.5) / n) * pixel_side, y = (y0 + h * (j + 0.5) / n) * pixel_side;
        sum += light * std::exp(-absorption[channel] * part * std::sqrt(x * x + y * y + 9));
      }
    return sum / (n * n) * w * h / (width * height);
  };
  return light_of(-4.27, 2.61, small_side, small_side, small_light[channel]) +
         light_of(1.37, -3.81, large_width, large_height, large_light[channel]);
}

TEST(LampRays, have_what_media_and_interfaces_leave) {
  const std::string plain = scene_text("");
  const std::size_t camera = plain.find("Camera"), world = plain.find("AttributeBegin");
  const std::string around = std::string(medium) + "MediumInterface \"\" \"fog\"\n";
  const std::string boundary = R"(AttributeBegin
MediumInterface "" "fog"
Material "interface"
Shape "trianglemesh" "point3 P" [-9 -9 1.5 9 -9 1.5 9 9 1.5 -9 9 1.5] "integer indices" [0 1 2 0 2 3]
AttributeEnd
)";
  for (const auto& [text, part] : {std::pair{std::string(plain).insert(camera, around), 1.0},
                                   std::pair{std::string(plain).insert(world, boundary).insert(camera, medium), 0.5}}) {
    SCOPED_TRACE(part);
    const TestScene scene{std::string_view(text)};
    const auto truth = [through = part](std::size_t c) { return expected_through(through, c); };
    const Film without = rendered(scene, "path:lamp-rays=0").film, with = rendered(scene, "path").film;
    EXPECT_LT(deviation_from(truth, without), 4.5);
    EXPECT_LT(deviation_from(truth, with), 4.5);
    EXPECT_LT(mean_square(with), mean_square(without) / 4);
    EXPECT_GT(deviation(with), 10);                 // without the medium
    EXPECT_GT(deviation_from(truth, with, 2), 10);  // if the sample's own ray counted as well
  }
}

// The small lamp is behind a black surface until the middle of the exposure.
TEST(LampRays, see_what_moves_before_them) {
  const double at_two = pixel_side * 2 / 3, right = (-4.27 + small_side / 2 + 4) * at_two, left = right - 12 * at_two;
  const std::string screen = fmt::format(R"(AttributeBegin
ActiveTransform EndTime
Translate {} 0 0
ActiveTransform All
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "trianglemesh" "point3 P" [{} {} 2 {} {} 2 {} {} 2 {} {} 2] "integer indices" [0 1 2 0 2 3]
AttributeEnd
)",
                                         -8 * at_two, left, at_two, right, at_two, right, 4 * at_two, left, 4 * at_two);
  const TestScene scene{std::string_view(scene_text("") + screen)};
  const auto truth = [](std::size_t c) {
    return expected(c) - 0.5 * small_light[c] * small_side * small_side / (width * height);
  };
  for (const std::string name : {"path", "restir-pt"}) {
    SCOPED_TRACE(name);
    const Film without = rendered(scene, name + ":lamp-rays=0").film, with = rendered(scene, name).film;
    EXPECT_LT(deviation_from(truth, without), 4.5);
    EXPECT_LT(deviation_from(truth, with), 4.5);
    EXPECT_LT(mean_square(with), mean_square(without) / 4);
    EXPECT_GT(deviation(with), 4.5);  // if all of the exposure showed it
  }
}

TEST(LampRays, are_spent_where_pixels_show_lamps_in_part) {
  const TestScene scene{std::string_view(scene_text(""))};
  constexpr int passes = 2, samples = 4;
  const Film film = rendered(scene, "path:lamp-rays=8", passes, samples).film;
  const auto rays_at = [&](double x, double y) {  // in pixels from the centre, y up
    const PixelFeatures f = film.features(int(std::floor(width / 2 + x)), int(std::floor(height / 2 - y)));
    return f.emission_rays / f.samples;
  };
  // The camera of this space looks along z with x to the left or to the right: both sides count.
  const auto either = [&](double x, double y) { return std::max(rays_at(x, y), rays_at(-x, y)); };
  // They count for as many as there would be of the whole filter: small lamps have few of those.
  EXPECT_GT(either(-4.22, 2.66), 16);  // the small lamp
  EXPECT_GE(either(1.5, -2), 8);       // the rim of the large one
  EXPECT_EQ(either(4, -1), 1);         // within it
  EXPECT_EQ(either(10.5, 6.5), 1);     // darkness
  int pixels = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) pixels += film.features(x, y).emission_rays > passes * samples;
  EXPECT_LE(pixels, 48);
}

// A lamp a tenth of a pixel wide, across the picture: all pixels that show it have rays, and few others.
TEST(LampRays, are_spent_along_a_narrow_lamp) {
  const double s = pixel_side, wide = 0.05;
  const std::string tube = fmt::format(
      R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [9 9 9] "bool twosided" true
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "trianglemesh" "point3 P" [{} {} 3 {} {} 3 {} {} 3 {} {} 3] "integer indices" [0 1 2 0 2 3]
AttributeEnd
)",
      -8 * s, (-5 - wide) * s, 8 * s, (5 - wide) * s, 8 * s, (5 + wide) * s, -8 * s, (-5 + wide) * s);
  std::string text = scene_text("");
  text = text.substr(0, text.find("AttributeBegin")) + tube;
  const TestScene scene{std::string_view(text)};
  const Film shown = rendered(scene, "path:lamp-rays=0").film, film = rendered(scene, "path", 2).film;
  int with_light = 0, with_rays = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const PixelFeatures f = film.features(x, y);
      const bool light = shown.mean(x, y)[0] > 0, rays = f.emission_rays > f.samples;
      with_light += light, with_rays += rays;
      EXPECT_TRUE(rays || !light) << x << ' ' << y;
    }
  EXPECT_GE(with_light, 16);
  EXPECT_LE(with_rays, 3 * with_light);
}

// Light by light: the layers of the two lamps sum to the image, and that of the large one has its closed form (its rim
// alone makes noise, of less than a hundredth).
TEST(LampRays, belong_to_the_layers_of_their_lamps) {
  const TestScene scene{std::string_view(scene_text(""))};
  const ChosenIntegrator chosen = scene.integrator("path");
  RenderObserver silent;
  PassPlan plan;
  plan.passes = 64, plan.samples_per_pass = 4;
  RenderSettings settings = scene.settings(PointSetKind::blue_noise, plan, 5);
  LayerPlan layers;
  layers.light_groups = true;
  layers.group_of_light = scene.scene().lights.groups(), layers.group_names = scene.scene().lights.group_names();
  settings.image.layers = layers;
  const Film film = render(chosen.any(), settings, silent).film;
  const auto place = std::ranges::find(layers.group_names, "large");
  ASSERT_NE(place, layers.group_names.end());
  const int large = int(place - layers.group_names.begin());
  for (int c = 0; c < 3; ++c) {
    double of_large = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double sum = 0;
        for (int group = 0; group < layers.group_count(); ++group) sum += film.layers()->layer_mean(x, y, group, c);
        EXPECT_NEAR(sum, film.pixel(x, y).mean[c], 1e-12);
        of_large += film.layers()->layer_mean(x, y, large, c);
      }
    const double truth = large_light[std::size_t(c)] * large_width * large_height;
    EXPECT_NEAR(of_large, truth, 0.01 * truth);
  }
}

TEST(LampRays, make_the_same_bits_for_any_lanes_and_threads) {
  const TestScene scene{std::string_view(scene_text(""))};
  const Film all = rendered(scene, "path", 2).film, one = rendered(scene, "path:lanes=one", 2).film,
             threads = rendered(scene, "path", 2, 4, 3).film;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(all.pixel(x, y).mean[c], one.pixel(x, y).mean[c]);
        EXPECT_EQ(all.pixel(x, y).mean[c], threads.pixel(x, y).mean[c]);
      }
}

}  // namespace
}  // namespace montelux::test
