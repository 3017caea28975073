#include "scene/picture.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/ray.h"

namespace montelux {

namespace {

// Pixels [ceil(size * low), ceil(size * high)), the rounding of pbrt.
int cut(int size, float fraction) { return std::clamp(int(std::ceil(float(size) * fraction)), 0, size); }

PixelBounds crop_of(const FilmDesc& film, int width, int height, bool resized, Diagnostics& diagnostics) {
  const PixelBounds all{0, 0, width, height};
  PixelBounds crop = all;
  if (const auto& p = film.pixel_bounds; p && !resized)
    crop = {std::clamp((*p)[0], 0, width), std::clamp((*p)[2], 0, height), std::clamp((*p)[1], 0, width),
            std::clamp((*p)[3], 0, height)};
  else if (const auto& w = film.crop_window)
    crop = {cut(width, (*w)[0]), cut(height, (*w)[2]), cut(width, (*w)[1]), cut(height, (*w)[3])};
  if (crop.x0 < crop.x1 && crop.y0 < crop.y1) return crop;
  diagnostics.error(film.where, "the film's window contains no pixel");
  return all;
}

// As for --integrator: "ao:distance=2,cossample=off".
std::string with_settings(const IntegratorDesc& integrator) {
  std::string text = integrator.name;
  for (const auto& [name, value] : integrator.settings)
    text.append(text.size() > integrator.name.size() ? "," : ":").append(name).append("=").append(value);
  return text;
}

}  // namespace

std::string size_complaint(std::int64_t width, std::int64_t height) {
  constexpr std::int64_t max_pixels = std::int64_t{1} << 28;
  if (width >= 1 && height >= 1 && width <= max_picture_side && height <= max_picture_side &&
      width * height <= max_pixels)
    return {};
  return "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels is too " +
         (width < 1 || height < 1 ? "small" : "large") + "; each side is from 1 to " +
         std::to_string(max_picture_side) + ", and at most 2^28 pixels in all are valid";
}

PictureSettings picture_settings(const SceneDesc& scene, std::optional<std::pair<int, int>> resolution,
                                 Diagnostics& diagnostics) {
  PictureSettings s;
  const FilmDesc& film = scene.film;
  if (resolution)
    if (std::string complaint = size_complaint(resolution->first, resolution->second); !complaint.empty()) {
      diagnostics.error(film.where, complaint);
      return s;
    }
  std::tie(s.width, s.height) = resolution.value_or(std::pair{film.width, film.height});
  s.file = film.file;
  s.crop = crop_of(film, s.width, s.height, resolution.has_value(), diagnostics);
  if (film.max_component && *film.max_component < ray_infinity) s.max_component = film.max_component;
  const float open = scene.camera.shutter_open, close = scene.camera.shutter_close;
  s.transforms_start = scene.transforms_start, s.transforms_end = scene.transforms_end;
  s.shutter_open = double(open), s.shutter_close = double(close);
  // Uses the exposure that the file states, even if another one is requested.
  s.imaging_ratio = (close - open) * film.iso.value_or(100) / 100;
  if (scene.shutter) s.shutter_open = scene.shutter->first, s.shutter_close = scene.shutter->second;

  s.samples = scene.sampling.samples, s.seed = scene.sampling.seed, s.sampler = scene.sampling.points;
  s.pixel_centres = scene.sampling.pixel_centres;
  s.integrator = with_settings(scene.integrator);
  s.max_depth = scene.integrator.max_depth, s.light_selection = scene.integrator.light_selection;
  return s;
}

}  // namespace montelux
