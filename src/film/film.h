// The film: at every pixel an estimate over independent passes. A pass contributes one number a pixel (the mean of the
// pass's samples there), so the spread over passes is the true spread of the estimator, whatever the correlation of the
// samples inside a pass.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/layer_film.h"
#include "film/picture_error.h"
#include "image/pixel_sample.h"
#include "mc/exact_moments.h"

namespace montelux {

// The squares that cover the bounds in row-major order; those at the right and at the bottom may be cut off.
std::vector<PixelBounds> tiles_of(const PixelBounds& bounds, int side);

// What a film has at most: samples of a pixel, and the number of a pass.
inline constexpr std::uint32_t max_film_samples = 1u << 24;
inline constexpr std::uint32_t max_pass_number = 0x7fffffff;

// Mean and spread of one pixel over passes, by channel.
struct PixelEstimate {
  double mean[rgb_size] = {};
  double m2[rgb_size] = {};  // sum of squared deviations of the pass means
  // The sum over the passes of even number of the mean of the channels: with the rest an independent half.
  double half_sum = 0;
  std::uint32_t half_passes = 0;
  std::uint32_t passes = 0;
  std::uint32_t non_finite = 0;  // samples kept out of the mean

  // The passes of both.
  void merge(const PixelEstimate& other);
  // Variance of `mean` (not of one pass), by channel; infinite below two passes.
  double variance_of_mean(int channel) const;
};

struct PixelFeatures {
  double emission = 0;  // sum over samples of the mean of the channels
  // Sums over samples that hit.
  double albedo[rgb_size] = {}, normal[3] = {}, position[3] = {}, depth = 0;
  double hits = 0, samples = 0;
  std::uint32_t object = 0;  // of the first sample that hit
  void add(const Features& sample);
};

// The samples of one pixel in one pass, summed: the radiance of those that are finite, and the features.
struct PixelPass {
  double sum[rgb_size] = {};
  int finite = 0, non_finite = 0;
  PixelFeatures features;
  void add(const PixelSample& sample);
};

// What a film keeps of a pixel: sums over passes that no order changes.
struct PixelSums {
  ExactMoments radiance[rgb_size];  // of the pass means
  ExactSum half;
  ExactSum emission, position[3], depth;  // of the sums over the samples of a pass, as PixelFeatures has them
  SmallExactSum albedo[rgb_size], normal[3];
  std::uint32_t passes = 0, half_passes = 0, non_finite = 0;
  std::uint32_t hits = 0, samples = 0;
  std::uint32_t object = 0;
  int object_pass = 0;  // that the object is of: the first in which a sample hit

  // A pass; of the radiance only the mean of its finite samples, where there are any.
  void add(int pass, const PixelPass& sums);
  void add_mean(int pass, const double (&mean)[rgb_size]);
  void merge(const PixelSums& other);
  PixelEstimate estimate() const;
  std::array<double, rgb_size> mean() const;
  PixelFeatures features() const;
};

// The mean of the whole image over passes, with the error that correlations between pixels leave it.
struct ImageEstimate {
  double mean[rgb_size] = {};
  double standard_error[rgb_size] = {};  // infinite below two passes
  int passes = 0;                        // of the tile that has fewest
};

// A tile of a film in one pass: the sums of the pass means of its pixels, in their order.
struct FilmPass {
  int pass = 0;
  int pixels = 0;  // that have a finite sample
  double sum[rgb_size] = {};
};

// The passes that a tile has, by their numbers.
struct FilmTile {
  PixelBounds cells;
  std::vector<FilmPass> passes;
  bool has(int pass) const;
};

// A pass is known by its number: the film of a set of passes is the same bits in whatever order, by whatever threads
// and in whatever parts they came. Tiles may have different passes.
class Film {
 public:
  // `stride`: only the pixels of that grid are sampled.
  explicit Film(PixelBounds bounds, const std::optional<LayerPlan>& layers = {}, int stride = 1);

  const PixelBounds& bounds() const { return grid_.bounds; }
  const PixelGrid& grid() const { return grid_; }
  // The layers, where the film was made with a plan of them. Then the pass means are those of their exact sums.
  const std::optional<LayerFilm>& layers() const { return layers_; }

  // Names a tile, which counts cells of the grid. Tiles may not overlap. A tile that add_pass() does not know yet is
  // named by it; but tiles must be named before threads add passes to them.
  FilmTile& name_tile(const PixelBounds& cells);
  // All that are named, from top to bottom and from left to right.
  const std::map<std::size_t, FilmTile>& tiles() const { return tiles_; }
  // How many passes a tile has, which they are, and whether it has this one.
  int passes(const PixelBounds& tile) const;
  std::vector<int> pass_numbers(const PixelBounds& tile) const;
  bool has(const PixelBounds& tile, int pass) const;

  // Adds a pass to a tile, which must not have it: samples in row-major order, those of one pixel consecutive. Tiles
  // are independent, so different tiles may be added to by different threads at once. `sums`: of a film with layers, as
  // PixelIntegrator::trace_layers fills them.
  void add_pass(const PixelBounds& tile, int pass, int samples_per_pixel, std::span<const PixelSample> samples,
                std::span<const ExactRgb> sums = {});

  // The same of a pass whose samples came one by one, and are summed for each pixel.
  void add_pass(const PixelBounds& tile, int pass, std::span<const PixelPass> sums);

  // The film of the passes of both; the same grid, layers and tiles are required, and no tile may have a pass in both.
  void merge(const Film& other);

  // Appends a named tile to the bytes, with all that the film has of it.
  void write_tile(const PixelBounds& tile, std::string& bytes) const;
  // Adds a tile that the film does not have yet, from the next bytes. Throws std::invalid_argument where these cannot
  // be those of such a tile.
  void read_tile(const PixelBounds& tile, ByteReader& bytes);

  // Of a pixel that is not sampled those of the one that stands for its cell.
  PixelEstimate pixel(int x, int y) const { return pixels_[index(x, y)].estimate(); }
  // The mean alone, which takes less time than the whole estimate.
  std::array<double, rgb_size> mean(int x, int y) const { return pixels_[index(x, y)].mean(); }
  PixelFeatures features(int x, int y) const { return pixels_[index(x, y)].features(); }
  // Samples taken at a pixel.
  double samples(int x, int y) const { return is_sampled(x, y) ? pixels_[index(x, y)].samples : 0; }
  std::uint64_t non_finite() const;
  // From the estimates of the tiles, each over its own passes. A pixel that has no finite sample in a pass is left out
  // of that pass. There is no mean until every pixel has a pass.
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
  std::size_t index_of_cell(int x, int y) const {
    return std::size_t(y - cells_.y0) * std::size_t(cells_.width()) + std::size_t(x - cells_.x0);
  }
  std::size_t index(int x, int y) const { return index_of_cell(grid_.cell_x(x), grid_.cell_y(y)); }
  FilmPass& new_pass(const PixelBounds& tile, int pass);
  static void add_pixel(PixelSums& pixel, const PixelPass& sums, FilmPass& whole);

  PixelGrid grid_;
  PixelBounds cells_;
  std::vector<PixelSums> pixels_;
  std::map<std::size_t, FilmTile> tiles_;  // by the index of the first cell
  std::optional<LayerFilm> layers_;
};

}  // namespace montelux
