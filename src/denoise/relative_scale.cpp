#include "denoise/relative_scale.h"

#include <algorithm>
#include <optional>

#include "denoise/units.h"
#include "film/partial_cover.h"
#include "film/reciprocals.h"

namespace montelux {

RelativeScale scale_by_colors(const ColorPlanes& colors) {
  RelativeScale scale{colors, {}};
  for (Plane& plane : scale.reciprocals)
    for (float& value : plane) value = reciprocal_square(value);
  return scale;
}

namespace {

// The filtered image, with the variance that the noise of each pixel alone gives it.
FilmPlanes planes_of(const FilmPlanes& noisy, const FilteredImage& filtered) {
  FilmPlanes planes = noisy;
  planes.mean = filtered.mean;
  for (std::size_t i = 0; i < filtered.own.size(); ++i) {
    float first = 0, second = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      planes.variance[c][i] *= square(filtered.own[i]);
      first += filtered.halves[0][c][i] / rgb_size, second += filtered.halves[1][c][i] / rgb_size;
    }
    planes.first_half[i] = first, planes.second_half[i] = second;
  }
  return planes;
}

}  // namespace

RelativeScale scale_by_expectation(const FilmPlanes& noisy, const FilteredImage& filtered,
                                   const DenoiseSettings& settings) {
  const FilmPlanes planes = planes_of(noisy, filtered);
  std::optional<Reciprocals> of_filtered, of_noisy;
  std::optional<PartialCovers> covers;
  for_each_unit(3, settings, [&](std::size_t unit) {
    if (unit == 0) of_filtered.emplace(planes);
    if (unit == 1) of_noisy.emplace(noisy);
    if (unit == 2) covers.emplace(noisy);
  });
  RelativeScale scale = scale_by_colors(filtered.mean);
  for (Plane& plane : scale.of_covers) plane.resize(filtered.own.size());
  for_each_pixel_in_parallel(filtered.own.size(), settings, [&](std::size_t i) {
    if (noisy.passes[i] < 2) return;
    std::array<double, rgb_size> reciprocal = of_filtered->of(i);
    const std::array<double, rgb_size> before = of_noisy->of(i);
    // At the edge of a lamp one half may have no light of it, too.
    const bool compares_halves = !covers->has(i) && noisy.emission[i] <= 0;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      if (compares_halves) {
        const auto& [first, second] = filtered.halves;
        const double of_halves = double(reciprocal_square(first[c][i]) + reciprocal_square(second[c][i])) / 2;
        reciprocal[c] += double(1 - filtered.own[i]) * std::max(of_halves - reciprocal[c], 0.0);
      }
      reciprocal[c] = std::min(reciprocal[c], std::max(before[c], double(scale.reciprocals[c][i])));
    }
    const std::array<double, rgb_size> of_covers = covers->correction(i, reciprocal);
    for (std::size_t c = 0; c < rgb_size; ++c)
      scale.reciprocals[c][i] = float(reciprocal[c]), scale.of_covers[c][i] = float(of_covers[c]);
  });
  return scale;
}

}  // namespace montelux
