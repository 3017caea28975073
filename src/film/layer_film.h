// The layers of a film. Their sums are exact: at every pixel the layers of each family sum to all light, bit for bit,
// in any order of passes and merges.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "image/layers.h"
#include "image/pixel_sample.h"
#include "mc/exact_moments.h"

namespace montelux {

// The spread of the pass means of one layer, and their correlation with all light, by channel.
struct LayerSpread {
  double mean[rgb_size] = {};
  double m2[rgb_size] = {};         // sum of squared deviations
  double co_moment[rgb_size] = {};  // sum of products with the deviations of all light
};

// The mean of one layer over the samples of one half of the passes.
using LayerHalf = std::array<double, rgb_size>;

class ByteReader;
class ByteWriter;
struct PixelSums;

class LayerFilm {
 public:
  // `spread`: with the spread of each layer. `halves`: with the sums over one half of the passes.
  LayerFilm(PixelBounds bounds, int count, bool spread, bool halves);

  int count() const { return count_; }
  bool has_spread() const { return !spreads_.empty(); }
  bool has_halves() const { return !half_samples_.empty(); }

  // Adds a pass of a pixel: the sums over its finite samples, of which there is at least one; all light comes first.
  // `in_first_half`: whether the pass belongs to the first half.
  void add(int x, int y, int samples, std::span<const ExactRgb> sums, bool in_first_half);
  // Adds the passes of the other one. Throws if bounds, count, spread or halves differ.
  void merge(const LayerFilm& other);

  // Sums over all finite samples of the pixel.
  const ExactRgb& all_light(int x, int y) const { return sums_[first_sum(x, y)]; }
  const ExactRgb& layer(int x, int y, int layer) const { return sums_[first_sum(x, y) + std::size_t(layer) + 1]; }
  // These sums divided by the number of samples; 0 if there is no sample.
  double mean(int x, int y, int channel) const { return over_samples(x, y, all_light(x, y).c[channel]); }
  double layer_mean(int x, int y, int number, int channel) const {
    return over_samples(x, y, layer(x, y, number).c[channel]);
  }
  int passes(int x, int y) const { return counts_[index(x, y)].passes; }
  // Requires has_spread(). Number -1 is all light, whose co-moment is its m2.
  LayerSpread spread(int x, int y, int number) const;
  // Both halves of a layer. Each is the mean over all samples where one of them has no sample. Requires has_halves().
  std::array<LayerHalf, 2> halves(int x, int y, int number) const;
  // Variance of a layer's mean, infinite below two passes.
  double variance_of_mean(int x, int y, int number, int channel) const;

  // As Film::write_tile() and Film::read_tile(), for one pixel; `film` is its state in the film.
  void write_pixel(int x, int y, ByteWriter& out) const;
  void read_pixel(int x, int y, const PixelSums& film, ByteReader& in);

 private:
  struct Counts {
    std::uint64_t samples = 0;
    int passes = 0;
  };
  // Of the pass means of one layer, by channel.
  struct SpreadSums {
    ExactMoments own[rgb_size];
    ExactProducts with_all[rgb_size];  // products with those of all light
  };
  std::size_t index(int x, int y) const {
    return std::size_t(y - bounds_.y0) * std::size_t(bounds_.width()) + std::size_t(x - bounds_.x0);
  }
  std::size_t first_half_sum(int x, int y) const { return index(x, y) * std::size_t(count_); }
  std::size_t first_sum(int x, int y) const { return index(x, y) * (std::size_t(count_) + 1); }
  double over_samples(int x, int y, const ExactSum& sum) const {
    const std::uint64_t n = counts_[index(x, y)].samples;
    return n > 0 ? sum.value() / double(n) : 0;
  }

  PixelBounds bounds_;
  int count_;
  std::vector<Counts> counts_;       // by pixel
  std::vector<ExactRgb> sums_;       // by pixel, all light, then the layers
  std::vector<SpreadSums> spreads_;  // likewise
  // Of the passes of the first half; empty without halves.
  std::vector<std::uint64_t> half_samples_;  // by pixel
  std::vector<ExactRgb> half_sums_;          // by pixel, all layers
};

}  // namespace montelux
