// Filters: weighted sums over the pixels around each pixel.
#pragma once
#include <array>
#include <vector>

#include "denoise/denoise.h"

namespace montelux {

// The filters: weighted means, the first of them sharper, and then values of linear functions that are fitted to the
// pixels around (denoise/local_fit.h), which smooth more without blurring gradients. How a filter weighs differences of
// colours, in standard deviations: the greater, the smoother.
inline constexpr std::array<float, 2> mean_scales{0.5f, 1.0f}, fit_scales{1.0f, 2.0f};
inline constexpr std::size_t mean_count = mean_scales.size(), fit_count = fit_scales.size();
inline constexpr std::size_t filter_count = mean_count + fit_count;
inline constexpr std::size_t fit_features = 6;
inline constexpr int filter_reach = 8;  // pixels; weights fall to zero beyond, so that no edge of the window shows
// Distances of albedos and of normals at which the weight of a mean falls to 1/e. A fit follows differences of
// features, and counts this share of their squares.
inline constexpr float albedo_scale = 0.16f, normal_scale = 0.63f, fit_feature_share = 1.0f / 16;

// One half after one filter.
struct FilteredHalf {
  ColorPlanes color;
  Plane own;                  // the share of the pixel itself in the sum of the weights
  Plane correlation;          // covariance with the noise of the pixel, in variances of the pixel; empty: as `own`
  std::vector<Plane> slopes;  // of a fit, if the image has layers: its other coefficients

  const Plane& with_pixel() const { return correlation.empty() ? own : correlation; }
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
