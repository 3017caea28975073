#include "lab/compare/measure.h"

#include <cmath>

#include "image/flip.h"
#include "mc/confidence.h"

namespace montelux::lab {

namespace {

template <class Value>
PixelBuffer picture_of(const Film& film, Value value) {
  const PixelBounds& b = film.bounds();
  PixelBuffer image = make_pixel_buffer(b.width(), b.height(), {"R", "G", "B"});
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x)
      for (int c = 0; c < 3; ++c) image.at(x - b.x0, y - b.y0, c) = float(value(film.pixel(x, y), c));
  return image;
}

}  // namespace

PixelBuffer mean_of(const Film& film) {
  return picture_of(film, [](const PixelEstimate& p, int c) { return p.mean[c]; });
}

PixelBuffer variance_of(const Film& film) {
  return picture_of(film, [](const PixelEstimate& p, int c) { return p.variance_of_mean(c); });
}

double squared_error(const PixelBuffer& mean, const Reference& reference) {
  double sum = 0;
  for (std::size_t i = 0; i < mean.values.size(); ++i) {
    const double off = double(mean.values[i]) - double(reference.mean.values[i]);
    sum += off * off - double(reference.variance.values[i]);
  }
  return sum / double(mean.values.size());
}

double mean_value(const PixelBuffer& image) {
  double sum = 0;
  for (float v : image.values) sum += double(v);
  return sum / double(image.values.size());
}

Repeat measure(const Film& film, const Reference& reference) {
  Repeat r;
  const PixelBounds& b = film.bounds();
  const ImageEstimate image = film.image();
  r.passes = image.passes;
  for (int c = 0; c < 3; ++c) r.image_mean[c] = image.mean[c], r.image_error[c] = image.standard_error[c];
  double held = 0, intervals = 0, values = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      const PixelEstimate& p = film.pixel(x, y);
      const double t = p.passes > 1 ? student_t_quantile(0.975, p.passes - 1.0) : 0;
      for (int c = 0; c < 3; ++c) {
        const double truth = double(reference.mean.at(x - b.x0, y - b.y0, c));
        const double known = double(reference.variance.at(x - b.x0, y - b.y0, c));
        const double off = p.mean[c] - truth, square = off * off - known;
        r.mse += square, r.relative_mse += square / (truth * truth + 0.01), values += 1;
        if (p.passes < 2) continue;
        const double variance = p.variance_of_mean(c);
        r.variance += variance, intervals += 1;
        held += off * off <= t * t * (variance + known) ? 1 : 0;
      }
    }
  r.mse /= values, r.relative_mse /= values;
  r.variance = intervals > 0 ? r.variance / intervals : std::nan("");
  r.coverage = intervals > 0 ? held / intervals : std::nan("");
  r.flip = hdr_flip(mean_of(film), reference.mean).mean;
  return r;
}

}  // namespace montelux::lab
