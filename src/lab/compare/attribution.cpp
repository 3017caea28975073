#include "lab/compare/attribution.h"

#include <algorithm>

namespace montelux::lab {

namespace {

// The sum over the window around each pixel; at the edge, over the part inside the image.
std::vector<double> over_windows(const std::vector<double>& values, int width, int height) {
  std::vector<double> sums(values.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i)
          sums[std::size_t(y * width + x)] += values[std::size_t(j * width + i)];
  return sums;
}

}  // namespace

AttributionRound attribute(const Film& film, PixelShares& pixels) {
  const LayerFilm& layers = *film.layers();
  const PixelBounds& b = film.bounds();
  AttributionRound round;
  round.layers.resize(std::size_t(layers.count()));
  pixels.resize(std::size_t(layers.count()) + 1);
  for (auto& layer : pixels) layer.resize(std::size_t(b.area()));
  std::size_t p = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x, ++p) {
      const int passes = layers.passes(x, y);
      if (passes < 2) continue;
      for (int i = -1; i < layers.count(); ++i) {
        double sum = 0;
        for (double co_moment : layers.spread(x, y, i).co_moment) sum += co_moment / (passes - 1.0);
        pixels[std::size_t(i + 1)][p] += sum;
        (i < 0 ? round.all : round.layers[std::size_t(i)]) += sum;
      }
    }
  return round;
}

Attribution attribution_of(const LayerPlan& plan, const std::vector<AttributionRound>& rounds,
                           const PixelShares& pixels, const AttributionFrame& frame) {
  Attribution attribution;
  const std::vector<std::string> names = layer_names(plan);
  std::vector<double> all;
  for (const AttributionRound& round : rounds) all.push_back(round.all);
  const std::vector<double> all_by_pixel = over_windows(pixels[0], frame.width, frame.height);
  for (const LayerFamily& family : layer_families(plan)) {
    FamilyShares shares{family.name, {}};
    for (int i = family.first; i < family.first + family.count; ++i) {
      std::vector<double> own;
      for (const AttributionRound& round : rounds) own.push_back(round.layers[std::size_t(i)]);
      shares.layers.push_back({names[std::size_t(i)], measured_ratio_of_sums(own, all, frame.confidence)});
      const std::vector<double> by_pixel = over_windows(pixels[std::size_t(i) + 1], frame.width, frame.height);
      std::vector<float>& shown = attribution.by_pixel.emplace_back();
      for (std::size_t p = 0; p < by_pixel.size(); ++p)
        shown.push_back(all_by_pixel[p] > 0 ? float(by_pixel[p] / all_by_pixel[p]) : 0.0f);
    }
    attribution.families.push_back(std::move(shares));
  }
  return attribution;
}

}  // namespace montelux::lab
