// Renders with layers, read as pictures with standard errors.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "image/welch.h"
#include "render_scenes.h"

namespace montelux::test {

// All families of layers of a scene's light.
inline LayerPlan all_layers(const Scene& scene, int bounces) {
  LayerPlan plan;
  plan.bounces = bounces, plan.light_groups = plan.techniques = plan.spread = true;
  plan.group_of_light = scene.lights.groups();
  plan.group_names = scene.lights.group_names();
  return plan;
}

// A picture and its error bars, of `passes` passes.
struct LayerPicture {
  PixelBuffer mean, standard_error;
  int passes = 0;
  EstimatedImage estimate() const { return {mean, standard_error, passes - 1.0}; }
  // Over all pixels, which must be independent of each other.
  double image_mean = 0, image_standard_error = 0;
};

// `number` -1 is all light.
inline LayerPicture layer_picture(const Film& film, int number) {
  const PixelBounds& b = film.bounds();
  const LayerFilm& layers = *film.layers();
  LayerPicture p{make_pixel_buffer(b.width(), b.height(), {"R", "G", "B"}),
                 make_pixel_buffer(b.width(), b.height(), {"R", "G", "B"}), layers.passes(b.x0, b.y0)};
  double variance = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x)
      for (int c = 0; c < 3; ++c) {
        const double mean = number < 0 ? layers.mean(x, y, c) : layers.layer_mean(x, y, number, c);
        const double v = layers.variance_of_mean(x, y, number, c);
        p.mean.at(x - b.x0, y - b.y0, c) = float(mean);
        p.standard_error.at(x - b.x0, y - b.y0, c) = float(std::sqrt(v));
        if (c == 0) p.image_mean += mean / b.area(), variance += v;
      }
  p.image_standard_error = std::sqrt(variance) / b.area();
  return p;
}

inline int layer_number(const LayerPlan& plan, std::string_view name) {
  const std::vector<std::string> names = layer_names(plan);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return int(i);
  throw std::runtime_error("no layer " + std::string(name));
}

// Whether the layers of each family sum to all light at every pixel, bit for bit.
inline bool families_sum_to_all(const Film& film, const LayerPlan& plan) {
  const PixelBounds& b = film.bounds();
  const LayerFilm& layers = *film.layers();
  for (const LayerFamily& family : layer_families(plan))
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x) {
        ExactRgb sum;
        for (int i = 0; i < family.count; ++i) sum += layers.layer(x, y, family.first + i);
        if (!(sum == layers.all_light(x, y))) return false;
      }
  return true;
}

// ---- scenes, and renders of them

inline constexpr const char* small_film = R"(
Film "rgb" "integer xresolution" [ 16 ] "integer yresolution" [ 16 ]
PixelFilter "box"
)";
// Rough surfaces alone, so that every integrator finds all light.
inline const std::string three_lights = std::string(small_film) + R"(
Integrator "path" "integer maxdepth" [ 5 ]
LookAt 0 1.2 -3   0 0.6 0   0 1 0
Camera "perspective" "float fov" [ 60 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ] "string group" "sky"
LightSource "point" "rgb I" [ 2 1 1 ] "point3 from" [ -1 2 -1 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 5 5 4 ] "string group" "key"
  Translate 0.8 1.5 0
  Shape "sphere" "float radius" [ 0.3 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3   3 0 -3   -3 0 3   3 0 3 ]
Material "conductor" "float roughness" [ 0.4 ]
AttributeBegin
  Translate -0.6 0.5 0.2
  Shape "sphere" "float radius" [ 0.5 ]
AttributeEnd
)";
// The inside of a sphere that emits L and reflects the share r: after b bounces its light is L r^b at every point.
inline const std::string furnace = std::string(small_film) + R"(
Integrator "path" "integer maxdepth" [ 12 ]
LookAt 0.2 0.1 -0.3   0 0 1   0 1 0
Camera "perspective" "float fov" [ 60 ]
WorldBegin
AreaLightSource "diffuse" "rgb L" [ 1 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.8 0.5 0.3 ]
ReverseOrientation
Shape "sphere"
)";
inline constexpr double emitted[3] = {1, 2, 3}, reflected[3] = {0.8, 0.5, 0.3};

inline Film film_of(const TestScene& scene, const std::string& way, const LayerPlan& plan, PassPlan passes,
                    int threads = 1, int first_pass = 0) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderSettings settings = scene.settings(PointSetKind::independent, passes, 5, threads);
  settings.image.layers = plan;
  settings.plan.first_pass = first_pass;
  RenderObserver silent;
  return render(chosen.any(), settings, silent).film;
}

// Samples that do not count are in no layer, and at least `some` pixels have no others.
inline void expect_uncounted_in_no_layer(const TestScene& scene, const std::string& way, const LayerPlan& plan,
                                         PassPlan passes, int some) {
  const Film film = film_of(scene, way, plan, passes);
  EXPECT_TRUE(families_sum_to_all(film, plan)) << way;
  const auto samples = std::uint64_t(passes.samples());
  int without = 0;
  const PixelBounds& b = film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      const PixelEstimate pixel = film.pixel(x, y);
      for (int c = 0; c < rgb_size; ++c) EXPECT_TRUE(std::isfinite(pixel.mean[c])) << way;
      if (pixel.non_finite < samples) continue;
      ++without;
      EXPECT_EQ(film.layers()->all_light(x, y), ExactRgb{}) << way;
    }
  EXPECT_GE(without, some) << way;
}

// The image means of a layer in each pass, by channel. Pixels of a pass share paths from the lights, passes share
// nothing.
using LayerMeans = std::array<std::vector<double>, rgb_size>;

inline std::vector<LayerMeans> layer_means(const TestScene& scene, const std::string& way, const LayerPlan& plan,
                                           int samples, int passes) {
  std::vector<LayerMeans> means(std::size_t(plan.count()));
  for (int pass = 0; pass < passes; ++pass) {
    const Film film = film_of(scene, way, plan, {samples, 1}, 1, pass);
    EXPECT_EQ(film.non_finite(), 0u);
    const PixelBounds& b = film.bounds();
    for (std::size_t i = 0; i < means.size(); ++i)
      for (int c = 0; c < rgb_size; ++c) {
        double sum = 0;
        for (int y = b.y0; y < b.y1; ++y)
          for (int x = b.x0; x < b.x1; ++x) sum += film.layers()->layer_mean(x, y, int(i), c);
        means[i][std::size_t(c)].push_back(sum / b.area());
      }
  }
  return means;
}

// The layers sum to the image bit for bit, have the same bits for other threads, and leave the image what it is without
// them, except for the rounding of sums of floats: a relative error of `rounding`.
inline void expect_layers_of_image(const TestScene& scene, const std::string& way, const LayerPlan& plan,
                                   double rounding) {
  const Film film = film_of(scene, way, plan, {3, 2});
  EXPECT_TRUE(families_sum_to_all(film, plan)) << way;
  const Film same = film_of(scene, way, plan, {3, 2}, 3);
  RenderObserver silent;
  const ChosenIntegrator chosen = scene.integrator(way);
  const Film plain = render(chosen.any(), scene.settings(PointSetKind::independent, {3, 2}, 5), silent).film;
  const PixelBounds& b = film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      for (int i = 0; i < plan.count(); ++i)
        EXPECT_EQ(film.layers()->layer(x, y, i), same.layers()->layer(x, y, i)) << way << " " << i;
      for (int c = 0; c < rgb_size; ++c) {
        const double mean = plain.pixel(x, y).mean[c];
        EXPECT_NEAR(film.pixel(x, y).mean[c], mean, rounding * mean + 1e-9) << way;
      }
    }
}

}  // namespace montelux::test
