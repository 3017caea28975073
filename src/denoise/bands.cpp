// An image is filtered in bands of rows.
#include <algorithm>
#include <vector>

#include "denoise/choice.h"
#include "denoise/denoise.h"

namespace montelux {

namespace {

Plane rows_of(const Plane& plane, int width, const RowRange& rows) {
  if (plane.empty()) return {};
  const auto begin = plane.begin() + std::ptrdiff_t(rows.first) * width;
  return {begin, begin + std::ptrdiff_t(rows.count) * width};
}

template <std::size_t n>
std::array<Plane, n> rows_of(const std::array<Plane, n>& planes, int width, const RowRange& rows) {
  std::array<Plane, n> part;
  for (std::size_t k = 0; k < n; ++k) part[k] = rows_of(planes[k], width, rows);
  return part;
}

// The rows of a band among those of `planes` take their places in the whole.
void put(const ColorPlanes& planes, int width, const RowRange& rows, const RowRange& band, ColorPlanes& whole) {
  if (planes.front().empty()) return;
  const auto skipped = std::ptrdiff_t(band.first - rows.first) * width, count = std::ptrdiff_t(band.count) * width;
  for (std::size_t c = 0; c < rgb_size; ++c)
    std::copy_n(planes[c].begin() + skipped, count, whole[c].begin() + std::ptrdiff_t(band.first) * width);
}

ColorPlanes color_planes(std::size_t pixels) { return {Plane(pixels), Plane(pixels), Plane(pixels)}; }

}  // namespace

NoisyImage rows_of(const NoisyImage& image, const RowRange& rows) {
  const int w = image.width;
  NoisyImage part(w, rows.count);
  for (std::size_t h = 0; h < 2; ++h) {
    const HalfPlanes& from = image.halves[h];
    HalfPlanes& to = part.halves[h];
    for (ColorPlanes HalfPlanes::*colors : {&HalfPlanes::color, &HalfPlanes::albedo, &HalfPlanes::emission})
      to.*colors = rows_of(from.*colors, w, rows);
    to.normal = rows_of(from.normal, w, rows), to.share = rows_of(from.share, w, rows);
  }
  part.variance = rows_of(image.variance, w, rows);
  for (const NoisyLayer& layer : image.layers) {
    NoisyLayer& to = part.layers.emplace_back(0, false, layer.family);
    for (std::size_t h = 0; h < 2; ++h) to.halves[h] = rows_of(layer.halves[h], w, rows);
    to.variance = rows_of(layer.variance, w, rows);
  }
  return part;
}

DenoisedImage denoise(const NoisyRows& image, const DenoiseSettings& settings) {
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  // A band is not lower than the rows around it.
  const std::size_t most = std::max(image.height / reach_of_colors, 1);
  const int bands = settings.filter ? 1 : int(std::min((pixels + settings.max_band - 1) / settings.max_band, most));
  if (bands <= 1) return denoise(image.rows({0, image.height}), settings);
  DenoisedImage result{color_planes(pixels), color_planes(pixels), {}, {}};
  for (int k = 0; k < bands; ++k) {
    const auto row_of = [&](int b) { return int(std::int64_t(image.height) * b / bands); };
    const RowRange band{row_of(k), row_of(k + 1) - row_of(k)};
    const int first = std::max(band.first - reach_of_colors, 0);
    const RowRange rows{first, std::min(band.end() + reach_of_colors, image.height) - first};
    std::vector<NoisyImage> others;
    for (const NoisyImage& other : settings.others) others.push_back(rows_of(other, rows));
    DenoiseSettings of_band = settings;
    of_band.others = others, of_band.counted_rows = RowRange{band.first - first, band.count};
    if (settings.progress) of_band.progress = [&, k](double share) { settings.progress((k + share) / bands); };
    const DenoisedImage part = denoise(image.rows(rows), of_band);
    put(part.color, image.width, rows, band, result.color), put(part.error, image.width, rows, band, result.error);
    for (std::size_t i = 0; i < part.layers.size(); ++i) {
      const DenoisedLayer& layer = part.layers[i];
      if (k == 0)
        result.layers.push_back({color_planes(pixels), color_planes(layer.error.front().empty() ? 0 : pixels)});
      put(layer.color, image.width, rows, band, result.layers[i].color);
      put(layer.error, image.width, rows, band, result.layers[i].error);
    }
    result.sums.add(part.sums);
  }
  return result;
}

}  // namespace montelux
