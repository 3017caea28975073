// Removal of noise: a filter over an image, and an estimate of the error that is left.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "film/film_planes.h"

namespace montelux {

class ColorFilter;

// One half of the passes: the image that they make, and what it shows. Features are means over samples that hit.
struct HalfPlanes {
  ColorPlanes color, albedo;
  ColorPlanes emission;  // the part of the colour that the camera sees directly of emitters
  std::array<Plane, 3> normal;
  Plane share;  // of the passes of the pixel; 0: the pixel has none

  explicit HalfPlanes(std::size_t pixels);
};

// A part of the light of an image: the colours of both halves.
struct NoisyLayer {
  std::array<ColorPlanes, 2> halves;
  ColorPlanes variance;  // of the mean of both; empty planes where it is not known
  std::string family;    // layers of one family sum to the image; empty: the layer belongs to no family

  NoisyLayer(std::size_t pixels, bool knows_variance, std::string_view family_name = "");
  bool knows_variance() const { return !variance.front().empty(); }
};

// An image to be filtered, row by row from the top. The mean of the halves, weighted by their shares, is the image.
struct NoisyImage {
  int width = 0, height = 0;
  std::array<HalfPlanes, 2> halves;
  ColorPlanes variance;  // of the mean of both
  // The whole image as the film shows it, if it is known: by it the stated error is that of ErrorEstimate, in so far as
  // the filter leaves the noise of pixels.
  std::optional<FilmPlanes> whole;
  std::vector<NoisyLayer> layers;

  NoisyImage(int w, int h);
  std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
  // The pixel has passes in both halves: elsewhere nothing is known of the error, and nothing is filtered.
  bool has_halves(std::size_t i) const { return halves[0].share[i] > 0 && halves[0].share[i] < 1; }
};

// Rows of an image, counted from the top.
struct RowRange {
  int first = 0, count = 0;

  int end() const { return first + count; }
  bool has(int row) const { return row >= first && row < end(); }
};

// The same, without the others.
NoisyImage rows_of(const NoisyImage& image, const RowRange& rows);

// An image that is never in memory as a whole.
struct NoisyRows {
  int width = 0, height = 0;
  std::function<NoisyImage(const RowRange&)> rows;
};

struct DenoisedLayer {
  ColorPlanes color;
  ColorPlanes error;  // as that of the image; empty planes where the variance is not known
};

// Sums of estimated squared errors over pixels and channels. Relative: over the square of the expectation plus
// relative_epsilon, as in ErrorEstimate.
struct ErrorSums {
  double noisy = 0, noisy_relative = 0;        // before the filter
  double filtered = 0, filtered_relative = 0;  // after it
  double least = 0;                            // what the difference of the halves shows, of `filtered`
  double unfiltered = 0;           // of `filtered_relative`, noise of pixels that the filter leaves as it is
  double squares = 0;              // of what each pixel adds to `filtered_relative` by itself, less the mean around it
  double measured = 0;             // pixels with both halves times channels
  double pixels = 0, changed = 0;  // all pixels; those that the filter changes

  void add(const ErrorSums& other);
  // Means over channels and pixels.
  double noisy_mse() const { return mean(noisy); }
  double noisy_relative_mse() const { return mean(noisy_relative); }
  double mse() const { return mean(std::max(filtered, least)); }
  double relative_mse() const { return mean(filtered_relative); }
  double unfiltered_relative_mse() const { return mean(unfiltered); }
  // The standard deviation of relative_mse(), by the spread of what pixels add to it.
  double relative_deviation() const { return mean(std::sqrt(squares)); }
  double changed_share() const { return changed / std::max(pixels, 1.0); }

 private:
  double mean(double sum) const { return sum / std::max(measured, 1.0); }
};

struct DenoisedImage {
  ColorPlanes color;
  ColorPlanes error;  // root of the estimated mean squared error, bias included; a mean over 21 x 21 pixels
  ErrorSums sums;
  std::vector<DenoisedLayer> layers;
};

struct DenoiseSettings {
  int threads = 0;                  // 0: all of the machine
  std::function<bool()> stop = {};  // queried now and then: true ends it early
  // Images of other samples, of the same size and with the same layers, whose pixels are averaged too where they are
  // alike: earlier ones of a sequence, reprojected. Pixels without a pass have the share 0.
  std::span<const NoisyImage> others = {};
  const ColorFilter* filter = nullptr;  // instead of ours
  // Those whose errors are summed, of an image that is a part of a larger one; nothing: all.
  std::optional<RowRange> counted_rows = {};
  std::size_t max_band = std::size_t(1) << 20;  // about so many pixels of NoisyRows are filtered at once
  // Called now and then, by one thread at a time, with the share that is done.
  std::function<void(double)> progress = {};
};

// Filters each half by weights that come from the other half alone: differences of its colours, relative to their
// variance (Buades, Coll and Morel 2005; Rousselle, Knaus and Zwicker 2012), of its albedos and normals. Because the
// weights are independent of what they weigh, the error of each filter is estimated without bias (Stein 1981); what is
// stated counts noise that pixels share, too (denoise/noise_correlation.h). Two filters are means, two are fits of
// linear functions (Bitterli et al. 2016). Of them (with other images also those over the image alone), the unfiltered
// image and a mean of both each pixel takes the one with the least estimated error around it, averaged over what its
// neighbours take, as far as that is not much worse for the pixel. Layers are filtered as the image is, by its weights
// and its choices: layers that sum to the image sum to the filtered image, up to rounding, and none of a family is
// below zero. Lamps of few pixels that are far brighter than what is around them are not filtered
// (denoise/small_lamps.h). The same bits for any number of threads. Throws std::runtime_error if it was stopped.
// Another filter is applied to each half by itself, and to each layer, whose sum is then not that of the filtered
// layers. The result is the mean of both halves: whatever the filter does, the error of each is known without bias by
// the other half. It takes no other images; what it throws is passed on.
DenoisedImage denoise(const NoisyImage& image, const DenoiseSettings& settings = {});

// The same of an image in bands of rows, so that what the filter stores is bounded. Each is filtered with as many rows
// around it as determine its colours, which are those of the whole image, up to rounding. What is known of the image as
// a whole (how far pixels share their noise, how often few bright samples are a detail) is known of each band by
// itself, so that errors are stated a little differently. Another filter than ours sees the whole image.
DenoisedImage denoise(const NoisyRows& image, const DenoiseSettings& settings = {});

}  // namespace montelux
