// Renders with layers, read as pictures with standard errors.
#pragma once
#include <cmath>

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

}  // namespace montelux::test
