// The distance of an image from a reference, as one number and as a map.
#pragma once
#include "image/pixel_buffer.h"

namespace montelux {

// Means over all pixels and the three colour channels of a (the test) and b (the reference), which must have the same
// size. Pixels that are not finite in either image are excluded and counted.
struct ErrorMeasures {
  double mse = 0.0;
  // mean((a - b)^2 / (b^2 + 0.01)) (Rousselle, Knaus and Zwicker 2011, with their epsilon).
  double relative_mse = 0.0;
  // 10 log10(1 / mse), for images in [0, 1]; infinite for equal images.
  double psnr = 0.0;
  double mean_difference = 0.0;
  std::size_t non_finite = 0;
};
ErrorMeasures measure_error(const PixelBuffer& test, const PixelBuffer& reference);

enum class ErrorKind { absolute, squared, relative_squared };
// One channel "error": the mean over the colour channels of the chosen kind of error at each pixel.
PixelBuffer error_map(const PixelBuffer& test, const PixelBuffer& reference, ErrorKind kind);

}  // namespace montelux
