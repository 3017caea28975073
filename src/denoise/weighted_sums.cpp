#include "denoise/weighted_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>

#include "denoise/local_fit.h"
#include "denoise/noise_correlation.h"
#include "denoise/padded_image.h"
#include "denoise/units.h"
#include "math/functions.h"
#include "math/lanes.h"

namespace montelux {

namespace {

using F = NativeFloats;

static_assert(tile_width % native_lanes == 0);
constexpr int packs_across = tile_width / native_lanes;

F load(const float* from) {
  F x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
void store(float* to, const F& x) { std::memcpy(to, &x, sizeof x); }

// Where another pixel is, and how far the filter reaches there: 1 at the pixel itself, 0 beyond.
struct Offset {
  int x, y;
  float near;
};

std::vector<Offset> offsets_in_reach() {
  std::vector<Offset> offsets;
  for (int dy = -filter_reach; dy <= filter_reach; ++dy)
    for (int dx = -filter_reach; dx <= filter_reach; ++dx) {
      constexpr float radius = filter_reach + 1;
      const float near = 1 - float(dx * dx + dy * dy) / (radius * radius);
      if (near > 0) offsets.push_back({dx, dy, near});
    }
  return offsets;
}

// A pixel and one of its neighbours, each the first one of a pack.
struct PixelPair {
  int x, y, other_x, other_y;
};

// What is filtered: the colours, and the correlation of each pixel's noise with that of the pixel that is filtered.
constexpr std::size_t correlation_channel = rgb_size, channel_count = rgb_size + 1;
// The features of a fit: the mean of the albedo, the normal, and the place on the image.
using Fit = LocalFit<F, fit_features, channel_count>;

// What a pixel counts in the filters of another one.
struct FilterWeights {
  std::array<F, mean_count> means;
  std::array<F, fit_count> fits;
};

// A pixel around those of a pack.
struct Neighbor {
  std::size_t number;  // of its offset
  PixelPair at;
  FilterWeights weights;
};

// One tile of a half of the first image: the pixels around its pixels in that half of any image, and their weights,
// which the other half alone decides.
class TileFilter {
 public:
  TileFilter(const PaddedImage& first, std::size_t half, int x0, int y0)
      : half_(half), guide_(first[1 - half]), x0_(x0), y0_(y0), offsets_(offsets_in_reach()) {
    differences_.resize(offsets_.size() * tile_size);
  }

  // The image whose pixels are the neighbours from now on.
  void look_at(const PaddedImage& there) {
    there_ = &there;
    for (std::size_t i = 0; i < offsets_.size(); ++i) find_differences(offsets_[i], &differences_[i * tile_size]);
  }
  std::size_t neighbors() const { return offsets_.size(); }
  const Offset& offset(std::size_t number) const { return offsets_[number]; }

  // Calls f(neighbor) for each neighbour of a pack of the tile.
  template <class Function>
  void for_each_neighbor(int row, int column, Function f) const {
    for (std::size_t i = 0; i < offsets_.size(); ++i) {
      const PixelPair at = pair(row, column, i);
      f(Neighbor{i, at, weights(at, offsets_[i].near, difference(row, column, i))});
    }
  }
  // The pixels of a pack and their neighbour by the number of its offset.
  PixelPair pair(int row, int column, std::size_t number) const {
    const int x = x0_ + column, y = y0_ + row;
    return {x, y, x + offsets_[number].x, y + offsets_[number].y};
  }
  // The features of the neighbour less those of the pixel.
  MONTELUX_INLINE Fit::Offsets feature_offsets(const PixelPair& at, std::size_t number) const {
    const PaddedHalf& guide = (*there_)[1 - half_];
    const auto difference = [&](const PaddedPlane& here, const PaddedPlane& there) {
      return load(there.at(at.other_x, at.other_y)) - load(here.at(at.x, at.y));
    };
    constexpr float per_pixel = 1.0f / filter_reach;
    return {difference(guide_.mean_albedo, guide.mean_albedo),
            difference(guide_.normal.mean[0], guide.normal.mean[0]),
            difference(guide_.normal.mean[1], guide.normal.mean[1]),
            difference(guide_.normal.mean[2], guide.normal.mean[2]),
            F(float(offsets_[number].x) * per_pixel),
            F(float(offsets_[number].y) * per_pixel)};
  }

 private:
  static constexpr std::size_t tile_size = std::size_t(tile_width) * tile_height;
  static constexpr int columns = tile_width + native_lanes;  // of differences: a pack more holds the patches' margin

  F difference(int row, int column, std::size_t number) const {
    return load(&differences_[number * tile_size + std::size_t(row * tile_width + column)]);
  }

  // The squared differences of the colours at each pixel and at its neighbour, without the part that their variances
  // explain, in units of these; means over the channels and over patches. A neighbour counts with at most the pixel's
  // own variance, or one rare bright sample would make its pixel similar to all pixels around it.
  void find_differences(const Offset& to, float* differences) const {
    const PaddedHalf& other = (*there_)[1 - half_];
    alignas(64) std::array<std::array<float, columns>, tile_height + 2 * patch> of_pixels;
    for (int row = 0; row < tile_height + 2 * patch; ++row) {
      const int y = y0_ + row - patch;
      for (int i = 0; i < columns; i += native_lanes) {
        const int x = x0_ - patch + i;
        F sum = 0.0f;
        for (std::size_t c = 0; c < rgb_size; ++c) {
          const F difference = load(guide_.color[c].at(x, y)) - load(other.color[c].at(x + to.x, y + to.y));
          const F here = load(guide_.variance[c].at(x, y)), there = load(other.variance[c].at(x + to.x, y + to.y));
          const F variance = here + min(here, there);
          sum += (difference * difference - variance) / (variance + 1e-8f);
        }
        store(&of_pixels[std::size_t(row)][std::size_t(i)], sum);
      }
    }
    for (std::size_t row = 0; row < tile_height; ++row) {
      // Sums over the rows of a patch, from the column before the tile on.
      alignas(64) std::array<float, columns> rows;
      for (std::size_t i = 0; i < std::size_t(columns); i += native_lanes)
        store(&rows[i], load(&of_pixels[row][i]) + load(&of_pixels[row + 1][i]) + load(&of_pixels[row + 2][i]));
      for (std::size_t i = 0; i < tile_width; i += native_lanes) {
        const F sum = load(&rows[i]) + load(&rows[i + 1]) + load(&rows[i + 2]);
        store(differences + row * tile_width + i, max(sum * (1.0f / (9 * rgb_size)), F(0.0f)));
      }
    }
  }

  MONTELUX_INLINE FilterWeights weights(const PixelPair& at, float near, F difference) const {
    const PaddedHalf &source = (*there_)[half_], &guide = (*there_)[1 - half_];
    const F features = distance(guide_.albedo, guide.albedo, at) * (1 / square(albedo_scale)) +
                       distance(guide_.normal, guide.normal, at) * (1 / square(normal_scale));
    // No light of surfaces spreads to where there are none: lamps before darkness would have a halo.
    const F other_near_surface = load(guide.near_surface.at(at.other_x, at.other_y));
    const F counts = 1.0f - other_near_surface * (1.0f - load(guide_.near_surface.at(at.x, at.y)));
    const F exists =
        load(source.exists.at(at.other_x, at.other_y)) * load(guide.exists.at(at.other_x, at.other_y)) * counts * near;
    const auto to_fourth = [](const F& x) { return square(square(x)); };
    // By colours and by features, each as in the smoothest filter; half of a scale is the fourth power.
    static_assert(mean_scales[1] == 1 && fit_scales[1] == 2 && fit_scales[0] == 1 && mean_scales[0] == 0.5f);
    static_assert(fit_feature_share == 1.0f / 16);
    const F smoothest = exp(difference * -0.25f), smooth = to_fourth(smoothest);
    const F alike = exp(features * -fit_feature_share), like_means = to_fourth(to_fourth(alike)) * exists;
    return {{to_fourth(smooth) * like_means, smooth * like_means},
            {smooth * alike * exists, smoothest * alike * exists}};
  }
  // The squared distance of a feature at two pixels, without what their variances explain. As with colours, that of the
  // second counts with at most the first one's.
  static F distance(const PaddedFeature& first, const PaddedFeature& second, const PixelPair& at) {
    const F here = load(first.variance.at(at.x, at.y)), there = load(second.variance.at(at.other_x, at.other_y));
    F sum = F(0.0f) - here - min(here, there);
    for (std::size_t c = 0; c < 3; ++c) {
      const F d = load(first.mean[c].at(at.x, at.y)) - load(second.mean[c].at(at.other_x, at.other_y));
      sum += d * d;
    }
    return max(sum, F(0.0f));
  }

  std::size_t half_;
  const PaddedHalf& guide_;  // of the first image
  const PaddedImage* there_ = nullptr;
  int x0_, y0_;
  std::vector<Offset> offsets_;
  std::vector<float> differences_;  // of the tile, offset by offset
};

// Sums of the channels of a half over the neighbours of a pack of pixels, for each filter.
struct PackSums {
  std::array<std::array<F, channel_count>, mean_count> channels;
  std::array<F, mean_count> weight;
  std::array<Fit, fit_count> fits;
};

// Adds the pixels of an image to the sums of a tile.
class ColorSums {
 public:
  ColorSums() : packs_(std::size_t(packs_across) * tile_height, PackSums{}) {}

  // `correlation`: of the noise of the neighbours; null: there is none.
  void add(const TileFilter& filter, const PaddedColors& colors, const NoiseCorrelation* correlation) {
    correlations_.clear();
    for (std::size_t i = 0; correlation && i < filter.neighbors(); ++i)
      correlations_.push_back(correlation->at(filter.offset(i).x, filter.offset(i).y));
    if (correlation)
      add_channels<channel_count>(filter, colors);
    else
      add_channels<rgb_size>(filter, colors);
  }

  PackSums& pack(int row, int column) { return packs_[std::size_t(row * packs_across + column / native_lanes)]; }

  template <std::size_t channels>
  void add_channels(const TileFilter& filter, const PaddedColors& colors) {
    for (std::vector<F>& weights : fit_weights_) weights.resize(filter.neighbors());
    for (int row = 0; row < tile_height; ++row)
      for (int column = 0; column < tile_width; column += native_lanes) {
        PackSums& sums = pack(row, column);
        add_means<channels>(filter, colors, row, column, sums);
        for (std::size_t k = 0; k < fit_count; ++k) {
          const Place at{filter, row, column};
          // As many sums at a time as there are registers for.
          constexpr std::size_t half = Fit::unknowns - 2;
          add_moments<0, half>(at, fit_weights_[k], sums.fits[k]);
          add_moments<half, Fit::unknowns>(at, fit_weights_[k], sums.fits[k]);
          add_products<channels>(at, fit_weights_[k], colors, sums.fits[k]);
        }
      }
  }

 private:
  struct Place {
    const TileFilter& filter;
    int row, column;
  };
  F value(const PaddedColors& colors, std::size_t c, const PixelPair& at, std::size_t number) const {
    return c == correlation_channel ? F(correlations_[number]) : load(colors[c].at(at.other_x, at.other_y));
  }

  template <std::size_t channels>
  void add_means(const TileFilter& filter, const PaddedColors& colors, int row, int column, PackSums& sums) {
    auto means = sums.channels;
    auto weight = sums.weight;
    filter.for_each_neighbor(row, column, [&](const Neighbor& to) {
      for (std::size_t k = 0; k < mean_count; ++k) {
        for (std::size_t c = 0; c < channels; ++c)
          means[k][c] += to.weights.means[k] * value(colors, c, to.at, to.number);
        weight[k] += to.weights.means[k];
      }
      for (std::size_t k = 0; k < fit_count; ++k) fit_weights_[k][to.number] = to.weights.fits[k];
    });
    sums.channels = means, sums.weight = weight;
  }

  // The rows of the matrix of a fit from `first` to before `end`.
  template <std::size_t first, std::size_t end>
  static void add_moments(const Place& at, const std::vector<F>& weights, Fit& fit) {
    constexpr std::size_t from = first * (first + 1) / 2, count = end * (end + 1) / 2 - from;
    std::array<F, count> sums;
    for (std::size_t m = 0; m < count; ++m) sums[m] = fit.moment[from + m];
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const Fit::Offsets x = at.filter.feature_offsets(at.filter.pair(at.row, at.column, i), i);
#pragma GCC unroll 8
      for (std::size_t j = first; j < end; ++j) {
        const F weighted = j == 0 ? weights[i] : weights[i] * x[j - 1];
        sums[j * (j + 1) / 2 - from] += weighted;
#pragma GCC unroll 8
        for (std::size_t k = 1; k <= j; ++k) sums[j * (j + 1) / 2 + k - from] += weighted * x[k - 1];
      }
    }
    for (std::size_t m = 0; m < count; ++m) fit.moment[from + m] = sums[m];
  }

  template <std::size_t channels>
  void add_products(const Place& at, const std::vector<F>& weights, const PaddedColors& colors, Fit& fit) const {
    auto sums = fit.product;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const PixelPair pair = at.filter.pair(at.row, at.column, i);
      const Fit::Offsets x = at.filter.feature_offsets(pair, i);
#pragma GCC unroll 4
      for (std::size_t c = 0; c < channels; ++c) {
        const F weighted = weights[i] * value(colors, c, pair, i);
        sums[c][0] += weighted;
#pragma GCC unroll 8
        for (std::size_t j = 1; j < Fit::unknowns; ++j) sums[c][j] += weighted * x[j - 1];
      }
    }
    fit.product = sums;
  }

  std::vector<PackSums> packs_;
  std::array<std::vector<F>, fit_count> fit_weights_;  // of the neighbours of one pack
  std::vector<float> correlations_;                    // of the neighbours; empty: zero
};

// What the layers of a half of an image are averaged by: the share of each filter at each pixel times what its weights
// are multiplied by, which for a fit are its coefficients.
struct PaddedLayers {
  std::vector<PaddedPlane> planes;
  std::array<PaddedPlane, mean_count> means;
  std::array<std::array<PaddedPlane, Fit::unknowns>, fit_count> fits;
};

// Sums of all layers over the neighbours of the pixels of a tile, by the mixture of the filters.
class LayerSums {
 public:
  explicit LayerSums(std::size_t planes) : sums(planes) {}
  using TilePlane = std::array<float, std::size_t(tile_width) * tile_height>;
  std::vector<TilePlane> sums;

  void add(const TileFilter& filter, const PaddedLayers& layers) {
    for (int row = 0; row < tile_height; ++row)
      for (int column = 0; column < tile_width; column += native_lanes)
        filter.for_each_neighbor(row, column, [&](const Neighbor& to) {
          const F weight = weight_of(filter, layers, to);
          for (std::size_t c = 0; c < sums.size(); ++c) {
            float* const sum = &sums[c][std::size_t(row * tile_width + column)];
            store(sum, load(sum) + weight * load(layers.planes[c].at(to.at.other_x, to.at.other_y)));
          }
        });
  }

 private:
  static F weight_of(const TileFilter& filter, const PaddedLayers& layers, const Neighbor& to) {
    const auto here = [&](const PaddedPlane& plane) { return load(plane.at(to.at.x, to.at.y)); };
    F weight = 0.0f;
    for (std::size_t k = 0; k < mean_count; ++k) weight += here(layers.means[k]) * to.weights.means[k];
    const Fit::Offsets x = filter.feature_offsets(to.at, to.number);
    for (std::size_t k = 0; k < fit_count; ++k) {
      Fit::Coefficients c;
      for (std::size_t j = 0; j < c.size(); ++j) c[j] = here(layers.fits[k][j]);
      weight += weight_by_fit(c, x) * to.weights.fits[k];
    }
    return weight;
  }
};

// Calls f(pixel of the image, its place in the tile) for the part of the tile that is in the image.
template <class Function>
void for_each_pixel(const NoisyImage& image, int x0, int y0, Function f) {
  for (int y = y0; y < std::min(y0 + tile_height, image.height); ++y)
    for (int x = x0; x < std::min(x0 + tile_width, image.width); ++x)
      f(std::size_t(y) * std::size_t(image.width) + std::size_t(x), std::size_t((y - y0) * tile_width + x - x0));
}

// The filtered pixels of a pack, from its sums.
struct FilteredPack {
  std::array<std::array<F, channel_count>, filter_count> channels;
  std::array<F, filter_count> own;
  std::array<Fit::Coefficients, fit_count> coefficients;

  explicit FilteredPack(const PackSums& sums) {
    for (std::size_t k = 0; k < mean_count; ++k) {
      own[k] = select(sums.weight[k] > F(0.0f), F(1.0f) / sums.weight[k], F(0.0f));  // its own weight is 1
      for (std::size_t c = 0; c < channel_count; ++c) channels[k][c] = sums.channels[k][c] * own[k];
    }
    for (std::size_t k = 0; k < fit_count; ++k) {
      coefficients[k] = sums.fits[k].coefficients();
      own[mean_count + k] = coefficients[k][0];
      for (std::size_t c = 0; c < channel_count; ++c)
        channels[mean_count + k][c] = sums.fits[k].color(coefficients[k], c);
    }
  }
};

// Pixels of which no neighbour counts keep their colours.
void copy_tile(ColorSums& sums, const NoisyImage& image, const HalfPlanes& source, int x0, int y0,
               std::span<FilteredHalf> out) {
  for (int row = 0; row < tile_height; ++row)
    for (int column = 0; column < tile_width; column += native_lanes) {
      const int y = y0 + row, x1 = x0 + column;
      if (y >= image.height || x1 >= image.width) continue;
      const FilteredPack filtered(sums.pack(row, column));
      for (int lane_number = 0; lane_number < std::min(native_lanes, image.width - x1); ++lane_number) {
        const std::size_t i = std::size_t(y) * std::size_t(image.width) + std::size_t(x1 + lane_number);
        for (std::size_t k = 0; k < filter_count; ++k) {
          const float own = lane(filtered.own[k], lane_number);
          const bool has_sum = own > 0;
          for (std::size_t c = 0; c < rgb_size; ++c)
            out[k].color[c][i] = has_sum ? lane(filtered.channels[k][c], lane_number) : source.color[c][i];
          const bool is_filtered = has_sum && source.share[i] > 0;
          out[k].own[i] = is_filtered ? std::min(own, 1.0f) : 1.0f;
          if (!out[k].correlation.empty())
            out[k].correlation[i] =
                is_filtered ? std::min(lane(filtered.channels[k][correlation_channel], lane_number), 1.0f) : 1.0f;
          for (std::size_t j = 0; j < out[k].slopes.size(); ++j)
            out[k].slopes[j][i] = lane(filtered.coefficients[k - mean_count][j + 1], lane_number);
        }
      }
    }
}

// `filters`: the first one over all images, and then, if there are others, the first one over the image alone.
PaddedLayers padded_layers(const NoisyImage& image, std::size_t half, const FilterMixture& mixture,
                           const std::vector<FilteredHalf>& filtered, std::span<const std::size_t> filters) {
  PaddedLayers padded;
  for (const NoisyLayer& layer : image.layers)
    for (const Plane& plane : layer.halves[half]) padded.planes.emplace_back(plane, image.width, image.height);
  // By the share of filter k and its coefficient j.
  const auto shares = [&](std::size_t k, std::size_t j) {
    Plane sum(image.pixels());
    for (std::size_t first : filters) {
      const FilteredHalf& one = filtered[first + k];
      const Plane& coefficient = j == 0 ? one.own : one.slopes[j - 1];
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += mixture.filters[first + k][i] * coefficient[i];
    }
    return PaddedPlane(sum, image.width, image.height);
  };
  for (std::size_t k = 0; k < mean_count; ++k) padded.means[k] = shares(k, 0);
  for (std::size_t k = 0; k < fit_count; ++k)
    for (std::size_t j = 0; j < Fit::unknowns; ++j) padded.fits[k][j] = shares(mean_count + k, j);
  return padded;
}

// The image and the others.
std::vector<PaddedImage> padded_images(const NoisyImage& image, const DenoiseSettings& settings) {
  std::vector<PaddedImage> images{padded_image(image, settings)};
  for (const NoisyImage& other : settings.others) images.push_back(padded_image(other, settings));
  return images;
}

// Calls f(half, x0, y0) for each half of each tile, by all threads. `stage`: 0 for the image, 1 for its layers.
template <class Function>
void for_each_tile(const NoisyImage& image, const DenoiseSettings& settings, int stage, Function f) {
  const auto across = std::size_t((image.width + tile_width - 1) / tile_width);
  const std::size_t tiles = across * std::size_t((image.height + tile_height - 1) / tile_height);
  const double stages = image.layers.empty() ? 1 : 2;
  std::size_t started = 0;
  DenoiseSettings of_stage = settings;
  of_stage.stop = [&] {
    if (settings.progress) settings.progress((stage + double(started++) / double(2 * tiles)) / stages);
    return settings.stop && settings.stop();
  };
  for_each_unit(2 * tiles, of_stage, [&](std::size_t unit) {
    const std::size_t tile = unit / 2;
    f(unit % 2, int(tile % across) * tile_width, int(tile / across) * tile_height);
  });
}

}  // namespace

FilteredHalves filter_halves(const NoisyImage& image, const DenoiseSettings& settings) {
  const std::vector<PaddedImage> images = padded_images(image, settings);
  const NoiseCorrelation correlation(image);
  const bool is_correlated = !correlation.is_zero();
  FilteredHalves filtered;
  for (auto& half : filtered) {
    half.resize(settings.others.empty() ? filter_count : 2 * filter_count);
    for (std::size_t k = 0; k < half.size(); ++k) {
      for (Plane& plane : half[k].color) plane.resize(image.pixels());
      half[k].own.resize(image.pixels());
      if (is_correlated) half[k].correlation.resize(image.pixels());
      // Layers need them.
      if (k % filter_count >= mean_count && !image.layers.empty())
        half[k].slopes.assign(fit_features, Plane(image.pixels()));
    }
  }
  for_each_tile(image, settings, 0, [&](std::size_t half, int x0, int y0) {
    TileFilter filter(images[0], half, x0, y0);
    const auto sums = std::make_unique<ColorSums>();
    const auto copy = [&](std::size_t first) {
      copy_tile(*sums, image, image.halves[half], x0, y0, std::span(filtered[half]).subspan(first));
    };
    for (std::size_t i = 0; i < images.size(); ++i) {
      filter.look_at(images[i]);
      // Only its own passes share noise with the image.
      sums->add(filter, images[i][half].color, is_correlated && i == 0 ? &correlation : nullptr);
      if (i == 0 && images.size() > 1) copy(filter_count);
    }
    copy(0);
  });
  return filtered;
}

std::vector<std::array<ColorPlanes, 2>> filter_layers(const NoisyImage& image, const DenoiseSettings& settings,
                                                      const FilterMixture& mixture, const FilteredHalves& filtered) {
  std::vector<std::array<ColorPlanes, 2>> layers;
  if (image.layers.empty()) return layers;
  for (const NoisyLayer& layer : image.layers) {
    auto& halves = layers.emplace_back(layer.halves);
    for (ColorPlanes& planes : halves)
      for (Plane& plane : planes)
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] *= mixture.unfiltered[i];
  }
  const std::vector<PaddedImage> images = padded_images(image, settings);
  // By half and image. Filters over the image alone come after those over all.
  std::array<std::vector<PaddedLayers>, 2> padded;
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<std::size_t> filters{0};
    if (images.size() > 1) filters.push_back(filter_count);
    padded[half].push_back(padded_layers(image, half, mixture, filtered[half], filters));
    for (const NoisyImage& other : settings.others)
      padded[half].push_back(padded_layers(other, half, mixture, filtered[half], std::span(filters).first(1)));
  }
  for_each_tile(image, settings, 1, [&](std::size_t half, int x0, int y0) {
    TileFilter filter(images[0], half, x0, y0);
    LayerSums sums(padded[half].front().planes.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
      filter.look_at(images[i]);
      sums.add(filter, padded[half][i]);
    }
    for_each_pixel(image, x0, y0, [&](std::size_t i, std::size_t place) {
      for (std::size_t layer = 0; layer < layers.size(); ++layer)
        for (std::size_t c = 0; c < rgb_size; ++c) layers[layer][half][c][i] += sums.sums[layer * rgb_size + c][place];
    });
  });
  return layers;
}

}  // namespace montelux
