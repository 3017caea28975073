// The film: at every pixel an estimate over independent passes. A pass contributes one number a pixel (the mean of the
// pass's samples there), so the spread over passes is the true spread of the estimator, whatever the correlation of the
// samples inside a pass.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "film/layer_film.h"
#include "film/picture_error.h"
#include "image/pixel_sample.h"

namespace montelux {

// Mean and spread of one pixel over passes (Welford 1962; West 1979), by channel.
struct PixelEstimate {
  double mean[spectrum_size] = {};
  double m2[spectrum_size] = {};  // sum of squared deviations of the pass means
  // The sum over every other pass, from the first on, of the mean of the channels: with the rest an independent half.
  double half_sum = 0;
  std::uint32_t half_passes = 0;
  std::uint32_t passes = 0;
  std::uint32_t non_finite = 0;  // samples kept out of the mean

  void add(const double (&pass_mean)[spectrum_size]);
  void merge(const PixelEstimate& other);
  // Variance of `mean` (not of one pass), by channel; infinite below two passes.
  double variance_of_mean(int channel) const;
};

struct PixelFeatures {
  double emission = 0;  // sum over samples of the mean of the channels
  // Sums over samples that hit.
  double albedo[spectrum_size] = {}, normal[3] = {}, position[3] = {}, depth = 0;
  double hits = 0, samples = 0;
  std::uint32_t object = 0;  // of the first sample that hit
  void add(const Features& sample);
  // The later samples.
  void merge(const PixelFeatures& other);
};

// The samples of one pixel in one pass, summed: the radiance of those that are finite, and the features.
struct PixelPass {
  double sum[spectrum_size] = {};
  int finite = 0, non_finite = 0;
  PixelFeatures features;
  void add(const PixelSample& sample);
};

// The mean of the whole image over passes, with the error that correlations between pixels leave it.
struct ImageEstimate {
  double mean[spectrum_size] = {};
  double standard_error[spectrum_size] = {};  // infinite below two complete passes
  int passes = 0;
};

class Film {
 public:
  // `stride`: only the pixels of that grid are sampled.
  explicit Film(PixelBounds bounds, const std::optional<LayerPlan>& layers = {}, int stride = 1);

  const PixelBounds& bounds() const { return grid_.bounds; }
  const PixelGrid& grid() const { return grid_; }
  // The layers, where the film was made with a plan of them. Then the pass means are those of their exact sums.
  const std::optional<LayerFilm>& layers() const { return layers_; }

  // Adds one pass of a tile, which counts cells of the grid: samples in row-major order, those of one pixel
  // consecutive. Passes of one tile must be added in their order, for the sums to be the same bits in every run; tiles
  // are independent, so different tiles may be added by different threads at once. `sums`: of a film with layers, as
  // PixelIntegrator::trace_layers fills them.
  void add_pass(const PixelBounds& tile, int pass, int samples_per_pixel, std::span<const PixelSample> samples,
                std::span<const ExactRgb> sums = {});

  // The same of a pass whose samples came one by one, and are summed for each pixel.
  void add_pass(const PixelBounds& tile, int pass, std::span<const PixelPass> sums);

  // The film of all passes of both; the same grid and layers are required. `other` holds the later passes.
  void merge(const Film& other);

  // Of a pixel that is not sampled those of the one that stands for its cell.
  const PixelEstimate& pixel(int x, int y) const { return pixels_[index(x, y)]; }
  const PixelFeatures& features(int x, int y) const { return features_[index(x, y)]; }
  // Samples taken at a pixel.
  double samples(int x, int y) const { return is_sampled(x, y) ? features_[index(x, y)].samples : 0; }
  std::uint64_t non_finite() const;
  // Over the passes that are complete: every tile has them. A pixel that has no finite sample in a pass is left out of
  // that pass.
  ImageEstimate image() const;
  // Whether samples are taken at this pixel: all, unless the film has a stride.
  bool is_sampled(int x, int y) const {
    return grid_.pixel_x(grid_.cell_x(x)) == x && grid_.pixel_y(grid_.cell_y(y)) == y;
  }
  // Estimated mean squared errors of the picture; of a part of it, as with a stride, none.
  ErrorEstimate error() const;
  // Of them the squared error alone, which takes far less time.
  double mse() const;

 private:
  struct PassSum {
    double sum[spectrum_size] = {};  // of the pass means of the pixels, in tile order
    int pixels = 0;                  // that have a finite sample
    int cells = 0;                   // of the tile, where the pass is there

    void add(const double (&mean)[spectrum_size]);
  };
  std::size_t index_of_cell(int x, int y) const {
    return std::size_t(y - cells_.y0) * std::size_t(cells_.width()) + std::size_t(x - cells_.x0);
  }
  std::size_t index(int x, int y) const { return index_of_cell(grid_.cell_x(x), grid_.cell_y(y)); }
  void keep_pass_sum(const PixelBounds& tile, int pass, PassSum sum);

  PixelGrid grid_;
  PixelBounds cells_;
  std::vector<PixelEstimate> pixels_;
  std::vector<PixelFeatures> features_;
  // The sum of every pass over a tile, by the tile's first pixel and then by pass: threads write to different tiles,
  // and the sum over tiles is taken in their order.
  std::vector<std::vector<PassSum>> tile_sums_;
  std::optional<LayerFilm> layers_;
};

}  // namespace montelux
