#include "film/film_planes.h"

#include <algorithm>

#include "film/film.h"

namespace montelux {

namespace {

double mean_of(const double (&channels)[rgb_size]) {
  double sum = 0;
  for (double c : channels) sum += c;
  return sum / rgb_size;
}

}  // namespace

FilmPlanes::FilmPlanes(const PixelBounds& b) : bounds(b) {
  const std::size_t pixels = std::size_t(b.area());
  for (ColorPlanes* planes : {&mean, &variance, &albedo})
    for (Plane& plane : *planes) plane.resize(pixels);
  for (Plane& plane : normal) plane.resize(pixels);
  for (Plane* plane : {&emission, &coverage, &samples, &emission_rays, &object, &first_half, &second_half})
    plane->resize(pixels);
  passes.resize(pixels), expected.resize(pixels);
}

void FilmPlanes::copy(const Film& film, const PixelBounds& part) {
  max_chance_radiance = film.max_chance_radiance();
  for (int y = part.y0; y < part.y1; ++y)
    for (int x = part.x0; x < part.x1; ++x) {
      const PixelEstimate& pixel = film.pixel(x, y);
      const PixelFeatures& features = film.features(x, y);
      const std::size_t i = index(x, y);
      const double hits = std::max(features.hits, 1.0), sampled = std::max(features.samples, 1.0);
      passes[i] = pixel.passes;
      expected[i] = film.is_sampled(x, y) && (pixel.passes > 0 || pixel.non_finite == 0);
      for (int c = 0; c < rgb_size; ++c) {
        mean[std::size_t(c)][i] = float(pixel.mean[c]);
        variance[std::size_t(c)][i] = pixel.passes < 2 ? 0.0f : float(pixel.variance_of_mean(c));
        albedo[std::size_t(c)][i] = float(features.albedo(c) / hits);
      }
      for (std::size_t c = 0; c < 3; ++c) normal[c][i] = float(features.normal(int(c)) / hits);
      emission[i] = float(features.emission / sampled), coverage[i] = float(features.hits / sampled);
      samples[i] = float(features.samples), emission_rays[i] = float(features.emission_rays);
      object[i] = float(features.object);
      const double all = mean_of(pixel.mean), half = pixel.half_sum;
      const bool halves = pixel.half_passes > 0 && pixel.half_passes < pixel.passes;
      first_half[i] = float(halves ? half / pixel.half_passes : all);
      second_half[i] = float(halves ? (all * pixel.passes - half) / (pixel.passes - pixel.half_passes) : all);
    }
}

std::vector<std::uint8_t> known_covers_of(const FilmPlanes& planes) {
  std::vector<std::uint8_t> known(planes.samples.size());
  bool has_more_rays = false;
  for (std::size_t i = 0; i < known.size(); ++i) {
    known[i] = planes.emission_rays[i] <= planes.samples[i];
    has_more_rays |= known[i] == 0;
  }
  if (!has_more_rays) known.assign(known.size(), 0);
  return known;
}

}  // namespace montelux
