// What the squared errors of a filtered image are multiplied by to be relative.
#pragma once
#include <array>

#include "denoise/denoise.h"
#include "film/film_planes.h"
#include "film/picture_error.h"
#include "math/functions.h"

namespace montelux {

inline float reciprocal_square(float brightness) { return 1 / (square(brightness) + float(relative_epsilon)); }

// By channel and pixel.
struct RelativeScale {
  ColorPlanes reciprocals;  // estimates of 1 / (expectation^2 + relative_epsilon)
  ColorPlanes of_covers;    // to be added for unfiltered pixels that are covered in part; empty planes: nothing
};

// The colours themselves are the expectations.
RelativeScale scale_by_colors(const ColorPlanes& colors);

struct FilteredImage {
  std::array<ColorPlanes, 2> halves;
  ColorPlanes mean;  // of both halves
  Plane own;         // the share of the unfiltered pixel in the filtered one
};

// Reciprocals that do not share the noise of the errors. A rare bright sample that the filter left in its pixel is
// known by the pixels around, as in an unfiltered image. One that the filter of a half spread is known by the other
// half. No pixel is taken to be darker than both images show it. `noisy`: the image before the filter.
RelativeScale scale_by_expectation(const FilmPlanes& noisy, const FilteredImage& filtered,
                                   const DenoiseSettings& settings);

}  // namespace montelux
