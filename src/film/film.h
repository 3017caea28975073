// The film: at every pixel an estimate over independent passes. A pass contributes one number per pixel (the mean
// of the pass's samples), so that the spread over passes is the true spread of the estimator, whatever the correlation
// of the samples within a pass.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "film/half_sums.h"
#include "film/layer_film.h"
#include "film/picture_error.h"
#include "film/sample_count.h"
#include "image/pixel_sample.h"
#include "mc/exact_moments.h"

namespace montelux {

// The squares that cover the bounds in row-major order; those at the right and at the bottom may be cut off.
std::vector<PixelBounds> tiles_of(const PixelBounds& bounds, int side);

// Limits of a film: the samples of a pixel, and the number of a pass.
inline constexpr std::uint32_t max_film_samples = 1u << 24;
inline constexpr std::uint32_t max_pass_number = 0x7fffffff;

// Mean and spread of one pixel over passes, by channel.
struct PixelEstimate {
  double mean[rgb_size] = {};
  double m2[rgb_size] = {};  // sum of squared deviations of the pass means
  // The mean of the channels, summed over passes with even numbers: one of two independent halves of the passes.
  double half_sum = 0;
  std::uint32_t half_passes = 0;
  std::uint32_t passes = 0;
  std::uint32_t non_finite = 0;  // samples excluded from the mean

  // Adds the passes of the other one.
  void merge(const PixelEstimate& other);
  // Variance of `mean` (not of one pass), by channel; infinite below two passes.
  double variance_of_mean(int channel) const;
};

struct PixelFeatures {
  double emission = 0;  // sum over samples of the mean of the channels
  // Sums over samples that hit, by channel of the table of features.
  std::array<double, feature_channel_count> sums{};
  double hits = 0, samples = 0;
  double emission_rays = 0;
  std::uint32_t object = 0;  // of the first sample that hit
  void add(const Features& sample);

  double depth() const { return sums[feature_channel("Z")]; }
  double position(int c) const { return sums[feature_channel("P") + std::size_t(c)]; }
  double albedo(int c) const { return sums[feature_channel("albedo") + std::size_t(c)]; }
  double normal(int c) const { return sums[feature_channel("N") + std::size_t(c)]; }
};

// Exact sums of the channels of the table of features: small ones where samples are limited.
template <std::size_t... I>
auto feature_sums_of(std::index_sequence<I...>)
    -> std::tuple<std::conditional_t<(feature_limit(I) < no_feature_limit), SmallExactSum, ExactSum>...>;
using FeatureSums = decltype(feature_sums_of(std::make_index_sequence<feature_channel_count>()));

// The samples of one pixel in one pass, summed: the radiance of those that are finite, and the features.
struct PixelPass {
  double sum[rgb_size] = {};
  double emission[rgb_size] = {};  // of these samples: what the camera sees directly of emitters
  int finite = 0, non_finite = 0;
  PixelFeatures features;
  void add(const PixelSample& sample);
};

// The state of a pixel: sums over passes that do not depend on their order.
struct PixelSums {
  ExactMoments radiance[rgb_size];  // of the pass means
  ExactSum half;
  ExactSum emission;  // of the sums over the samples of a pass, as PixelFeatures has them
  FeatureSums sums;
  std::uint32_t passes = 0, half_passes = 0, non_finite = 0;
  SampleCount hits;
  std::uint32_t samples = 0;
  std::uint64_t emission_rays = 0;
  std::uint32_t object = 0;
  int object_pass = 0;  // the first pass in which a sample hit, and so the pass of the object

  // Adds a pass. Its radiance is the mean of its finite samples, if there are any.
  void add(int pass, const PixelPass& added);
  void add_mean(int pass, const double (&mean)[rgb_size]);
  void merge(const PixelSums& other);
  PixelEstimate estimate() const;
  std::array<double, rgb_size> mean() const;
  PixelFeatures features() const;
};

// Calls f(a, b, limit) for the emission and each channel of the table of features, with the members of two structs that
// have them, and the largest absolute value of one sample; values beyond it count as it.
template <class A, class B, class Function>
void for_each_feature(A& a, B& b, Function f) {
  f(a.emission, b.emission, no_feature_limit);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (f(std::get<I>(a.sums), std::get<I>(b.sums), feature_limit(I)), ...);
  }
  (std::make_index_sequence<feature_channel_count>());
}

// The mean of the whole image over passes, with an error that includes correlations between pixels.
struct ImageEstimate {
  double mean[rgb_size] = {};
  double standard_error[rgb_size] = {};  // infinite below two passes
  int passes = 0;                        // of the tile that has the fewest
};

// A tile of a film in one pass: the sums of the pass means of its pixels, in their order.
struct FilmPass {
  int pass = 0;
  int pixels = 0;  // pixels that have a finite sample
  double sum[rgb_size] = {};
};

// The passes that a tile has, by their numbers.
struct FilmTile {
  PixelBounds cells;
  std::vector<FilmPass> passes;
  bool has(int pass) const;
};

// The tiles of a film by the index of their first cell: from top to bottom and from left to right.
using FilmTiles = std::map<std::size_t, FilmTile>;

// From the estimates of the tiles, each over its own passes. A pixel without a finite sample in a pass is excluded
// from that pass. There is no mean until each of the `cells` of the film has a pass.
ImageEstimate image_of(const FilmTiles& tiles, int cells);

// A pass is identified by its number: the film of a set of passes has the same bits for any order, any number of
// threads and any division into parts. Tiles may have different passes.
class Film {
 public:
  // `stride`: only the pixels of that grid are sampled. `halves`: with the colours and features of one half of the
  // passes.
  explicit Film(PixelBounds bounds, const std::optional<LayerPlan>& layers = {}, int stride = 1, bool halves = false);

  const PixelBounds& bounds() const { return grid_.bounds; }
  const PixelGrid& grid() const { return grid_; }
  // The layers, if the film was made with a plan of them. The pass means are then computed from their exact sums.
  const std::optional<LayerFilm>& layers() const { return layers_; }
  // By channel, the brightest sample that may come from lights that are met by chance alone, so that it may be missing
  // although no noise shows it; black: there are no such lights.
  const Rgb& max_chance_radiance() const { return max_chance_radiance_; }
  void set_max_chance_radiance(const Rgb& radiance) { max_chance_radiance_ = radiance; }

  // Names a tile, which counts cells of the grid. Tiles may not overlap. add_pass() names a tile that has no name
  // yet, but tiles must be named before threads add passes to them.
  FilmTile& name_tile(const PixelBounds& cells);
  // All named tiles.
  const FilmTiles& tiles() const { return tiles_; }
  // The number of passes of a tile, their numbers in ascending order, and whether it has this one.
  int passes(const PixelBounds& tile) const;
  std::vector<int> pass_numbers(const PixelBounds& tile) const;
  bool has(const PixelBounds& tile, int pass) const;

  // Adds a pass to a tile, which must not have it: samples in row-major order, those of one pixel consecutive. Several
  // threads may add passes to different tiles at the same time. `sums`: for a film with layers, as filled by
  // PixelIntegrator::trace_layers.
  void add_pass(const PixelBounds& tile, int pass, int samples_per_pixel, std::span<const PixelSample> samples,
                std::span<const ExactRgb> sums = {});

  // The same for a pass whose samples are summed for each pixel already.
  void add_pass(const PixelBounds& tile, int pass, std::span<const PixelPass> pixels,
                std::span<const ExactRgb> sums = {});

  // Adds the passes of the other film. Grid, layers and tiles must be the same, and no tile may have a pass in both.
  void merge(const Film& other);

  // Appends the complete state of a named tile to the bytes.
  void write_tile(const PixelBounds& tile, std::string& bytes) const;
  // Adds a tile that the film does not have yet, from the next bytes. Throws std::invalid_argument if these cannot
  // be the bytes of such a tile.
  // `has_emission_rays`: films of older versions have one for each sample, and do not state it.
  void read_tile(const PixelBounds& tile, ByteReader& bytes, bool has_emission_rays = true);

  // For a pixel that is not sampled, the result is that of the sampled pixel of its cell.
  PixelEstimate pixel(int x, int y) const { return pixels_[index(x, y)].estimate(); }
  // The number of its passes alone, or its mean, which take less time than the whole estimate.
  std::uint32_t passes_of(int x, int y) const { return pixels_[index(x, y)].passes; }
  std::array<double, rgb_size> mean(int x, int y) const { return pixels_[index(x, y)].mean(); }
  bool has_halves() const { return !halves_.empty(); }
  // Both halves of a pixel. Requires has_halves().
  std::array<PixelHalf, 2> halves(int x, int y) const { return halves_[index(x, y)].halves(pixels_[index(x, y)]); }
  PixelFeatures features(int x, int y) const { return pixels_[index(x, y)].features(); }
  // The number of samples of a pixel.
  double samples(int x, int y) const { return is_sampled(x, y) ? pixels_[index(x, y)].samples : 0; }
  std::uint64_t non_finite() const;
  ImageEstimate image() const { return image_of(tiles_, cells_.area()); }
  // Whether this pixel is sampled: all are, unless the film has a stride.
  bool is_sampled(int x, int y) const {
    return grid_.pixel_x(grid_.cell_x(x)) == x && grid_.pixel_y(grid_.cell_y(y)) == y;
  }
  // The estimated mean squared errors of the image; there is no estimate for a film with a stride.
  ErrorEstimate error() const;
  // The squared error alone, which takes far less time.
  double mse() const;

 private:
  std::size_t index_of_cell(int x, int y) const {
    return std::size_t(y - cells_.y0) * std::size_t(cells_.width()) + std::size_t(x - cells_.x0);
  }
  std::size_t index(int x, int y) const { return index_of_cell(grid_.cell_x(x), grid_.cell_y(y)); }
  FilmPass& new_pass(const PixelBounds& tile, int pass);
  // Pixel number i of the tile; `sums` are those of all its pixels.
  void add_pixel(const PixelBounds& tile, std::size_t i, PixelPass of_pixel, std::span<const ExactRgb> sums,
                 FilmPass& whole);

  PixelGrid grid_;
  PixelBounds cells_;
  std::vector<PixelSums> pixels_;
  std::vector<HalfSums> halves_;  // empty, or by pixel
  FilmTiles tiles_;
  std::optional<LayerFilm> layers_;
  Rgb max_chance_radiance_{};
};

}  // namespace montelux
