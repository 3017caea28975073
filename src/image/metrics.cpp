#include "image/metrics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace montelux {
namespace {

double error_of(ErrorKind kind, double test, double reference) {
  double d = test - reference;
  if (kind == ErrorKind::absolute) return std::fabs(d);
  return kind == ErrorKind::squared ? d * d : d * d / (reference * reference + 0.01);
}

bool all_finite(const Rgb& color) { return is_finite(color.c[0]) && is_finite(color.c[1]) && is_finite(color.c[2]); }

}  // namespace

ErrorMeasures measure_error(const PixelBuffer& test, const PixelBuffer& reference) {
  assert(test.width == reference.width && test.height == reference.height);
  std::array<int, 3> a_channels = rgb_channels(test), b_channels = rgb_channels(reference);
  ErrorMeasures m;
  for (int y = 0; y < test.height; ++y)
    for (int x = 0; x < test.width; ++x) {
      Rgb a = rgb_at(test, a_channels, x, y), b = rgb_at(reference, b_channels, x, y);
      if (!all_finite(a) || !all_finite(b)) {
        ++m.non_finite;
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        m.mse += error_of(ErrorKind::squared, a.c[c], b.c[c]);
        m.relative_mse += error_of(ErrorKind::relative_squared, a.c[c], b.c[c]);
        m.mean_difference += double(a.c[c]) - double(b.c[c]);
      }
    }
  double count = 3.0 * double(test.pixel_count() - m.non_finite);
  m.mse /= count;
  m.relative_mse /= count;
  m.mean_difference /= count;
  m.psnr = m.mse > 0.0 ? -10.0 * std::log10(m.mse) : std::numeric_limits<double>::infinity();
  return m;
}

PixelBuffer error_map(const PixelBuffer& test, const PixelBuffer& reference, ErrorKind kind) {
  assert(test.width == reference.width && test.height == reference.height);
  std::array<int, 3> a_channels = rgb_channels(test), b_channels = rgb_channels(reference);
  PixelBuffer map = make_pixel_buffer(test.width, test.height, {"error"});
  for (int y = 0; y < test.height; ++y)
    for (int x = 0; x < test.width; ++x) {
      Rgb a = rgb_at(test, a_channels, x, y), b = rgb_at(reference, b_channels, x, y);
      double sum = 0.0;
      for (int c = 0; c < 3; ++c) sum += error_of(kind, a.c[c], b.c[c]);
      map.at(x, y, 0) = float(sum / 3.0);
    }
  return map;
}

}  // namespace montelux
