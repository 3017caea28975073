// The filters: weighted sums over the pixels around each pixel.
#pragma once
#include <array>
#include <vector>

#include "denoise/denoise.h"

namespace montelux {

// How a filter weighs differences: the greater, the smoother.
inline constexpr std::array<float, 3> color_scales{0.5f, 0.3f, 1.0f};  // in standard deviations
inline constexpr int filter_count = int(color_scales.size());
inline constexpr int filter_reach = 8;  // pixels; weights fall to zero beyond, so that no edge of the window shows
// Distances of albedos and of normals at which a weight falls to 1/e.
inline constexpr float albedo_scale = 0.16f, normal_scale = 0.63f;

// One half after one filter.
struct FilteredHalf {
  ColorPlanes color;
  Plane own;  // the share of the pixel itself in the sum of the weights
};

// Half 0 or 1 of the image after each filter, by weights of the other half: first over all images; then, if there are
// others, over the image alone.
using FilteredHalves = std::array<std::vector<FilteredHalf>, 2>;
FilteredHalves filter_halves(const NoisyImage& image, const DenoiseSettings& settings);

// The weighted mean of the filters, in their order above, and of the unfiltered image that each pixel takes. The
// weights of a pixel sum to 1.
struct FilterMixture {
  std::vector<Plane> filters;
  Plane unfiltered;
};

// Both halves of each layer of the image after the mixture. `filtered`: the image after the filters. Pixels without a
// pass in one of the halves have no meaning.
std::vector<std::array<ColorPlanes, 2>> filter_layers(const NoisyImage& image, const DenoiseSettings& settings,
                                                      const FilterMixture& mixture, const FilteredHalves& filtered);

}  // namespace montelux
