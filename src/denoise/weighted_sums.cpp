#include "denoise/weighted_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>

#include "denoise/box_mean.h"
#include "film/max_around.h"
#include "math/functions.h"
#include "math/lanes.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

using F = NativeFloats;

constexpr int tile_width = 64, tile_height = 16;
static_assert(tile_width % native_lanes == 0);
constexpr int patch = 1;  // differences of colours are means over 3 x 3 pixels
constexpr int halo = filter_reach + patch;

F load(const float* from) {
  F x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
void store(float* to, const F& x) { std::memcpy(to, &x, sizeof x); }

// A plane with a margin on all sides, in which the image is mirrored.
class PaddedPlane {
 public:
  PaddedPlane() = default;
  PaddedPlane(const Plane& plane, int width, int height, bool mirror = true)
      : stride_(width + 2 * halo + tile_width + native_lanes),
        values_(std::size_t(stride_) * std::size_t(height + 2 * halo + tile_height)) {
    const auto inside = [](int i, int n) {
      const int period = 2 * n, k = ((i % period) + period) % period;
      return k < n ? k : period - 1 - k;
    };
    const int rows = mirror ? height + halo : height, columns = mirror ? width + halo : width;
    for (int y = mirror ? -halo : 0; y < rows; ++y)
      for (int x = mirror ? -halo : 0; x < columns; ++x)
        values_[index(x, y)] =
            plane[std::size_t(inside(y, height)) * std::size_t(width) + std::size_t(inside(x, width))];
  }
  // Pixels from x on may be read beyond the image, up to the next whole tile and pack.
  const float* at(int x, int y) const { return values_.data() + index(x, y); }

 private:
  std::size_t index(int x, int y) const { return std::size_t(y + halo) * std::size_t(stride_) + std::size_t(x + halo); }
  int stride_ = 0;
  std::vector<float> values_;
};

using PaddedColors = std::array<PaddedPlane, rgb_size>;

template <std::size_t n>
std::array<PaddedPlane, n> padded(const std::array<Plane, n>& planes, int width, int height) {
  std::array<PaddedPlane, n> all;
  for (std::size_t i = 0; i < n; ++i) all[i] = PaddedPlane(planes[i], width, height);
  return all;
}

struct PaddedFeature {
  std::array<PaddedPlane, 3> mean;
  PaddedPlane variance;  // summed over the components
};

struct PaddedHalf {
  PaddedColors color, variance;
  PaddedFeature albedo, normal;
  PaddedPlane exists;        // 1 for pixels of the image that have a pass, else 0
  PaddedPlane near_surface;  // 1 for pixels that show a surface, and those beside them, else 0
};
using PaddedImage = std::array<PaddedHalf, 2>;

// The variance of a half, half of it that of the 3 x 3 pixels: that of single pixels is known too badly.
ColorPlanes variance_of_half(const NoisyImage& image, const HalfPlanes& half) {
  ColorPlanes variance = image.variance;
  for (Plane& plane : variance) {
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = half.share[i] > 0 ? plane[i] / half.share[i] : 0;
    const Plane around = box_mean(plane, image.width, image.height, 1);
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = 0.5f * (plane[i] + around[i]);
  }
  return variance;
}

// A feature of a half. The variance of the mean over all passes is known by how much both halves differ, here over 5 x
// 5 pixels.
PaddedFeature padded_feature(const NoisyImage& image, std::size_t half, std::array<Plane, 3> HalfPlanes::*feature) {
  const auto& [a, b] = image.halves;
  const HalfPlanes& own = image.halves[half];
  Plane variance(image.pixels());
  for (std::size_t i = 0; i < variance.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      variance[i] += a.share[i] * b.share[i] * square((a.*feature)[c][i] - (b.*feature)[c][i]);
  variance = box_mean(variance, image.width, image.height, 2);
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = own.share[i] > 0 ? variance[i] / own.share[i] : 0;
  return {padded(own.*feature, image.width, image.height), PaddedPlane(variance, image.width, image.height)};
}

// A pixel shows a surface if its mean normal is not zero.
Plane near_surface(const NoisyImage& image, const HalfPlanes& half) {
  Plane surface(image.pixels());
  for (const Plane& component : half.normal)
    for (std::size_t i = 0; i < surface.size(); ++i)
      if (component[i] != 0) surface[i] = 1;
  return max_around(surface, image.width, 1);
}

PaddedImage padded_image(const NoisyImage& image) {
  const int w = image.width, h = image.height;
  PaddedImage both;
  for (std::size_t k = 0; k < 2; ++k) {
    const HalfPlanes& half = image.halves[k];
    Plane exists(image.pixels());
    for (std::size_t i = 0; i < exists.size(); ++i) exists[i] = half.share[i] > 0 ? 1.0f : 0.0f;
    both[k] = {padded(half.color, w, h),
               padded(variance_of_half(image, half), w, h),
               padded_feature(image, k, &HalfPlanes::albedo),
               padded_feature(image, k, &HalfPlanes::normal),
               PaddedPlane(exists, w, h, false),
               PaddedPlane(near_surface(image, half), w, h)};
  }
  return both;
}

// A pixel and one of its neighbours, each the first one of a pack.
struct PixelPair {
  int x, y, other_x, other_y;
};

constexpr std::size_t tile_size = std::size_t(tile_width) * tile_height;
using TilePlane = std::array<float, tile_size>;
using FilterWeights = std::array<F, filter_count>;

void add_to(float* sum, const F& x) { store(sum, load(sum) + x); }

// Sums of the colours of a half over the neighbours of the pixels of a tile, for each filter.
struct ColorSums {
  alignas(64) std::array<std::array<TilePlane, rgb_size>, filter_count> color{};
  alignas(64) std::array<TilePlane, filter_count> weight{};

  void add(const PaddedColors& colors, const PixelPair& at, std::size_t place, const FilterWeights& weights) {
    std::array<F, rgb_size> values;
    for (std::size_t c = 0; c < rgb_size; ++c) values[c] = load(colors[c].at(at.other_x, at.other_y));
    for (std::size_t k = 0; k < filter_count; ++k) {
      for (std::size_t c = 0; c < rgb_size; ++c) add_to(&color[k][c][place], weights[k] * values[c]);
      add_to(&weight[k][place], weights[k]);
    }
  }
};

// What the layers of a half of an image are averaged by: `shares`, those of the filters at each pixel, divided by the
// sum of the weights of the filter there.
struct PaddedLayers {
  std::vector<PaddedPlane> planes;
  std::array<PaddedPlane, filter_count> shares;
};

// Sums of all layers over the neighbours of the pixels of a tile, by the mixture of the filters.
struct LayerSums {
  explicit LayerSums(std::size_t planes) : sums(planes) {}
  std::vector<TilePlane> sums;

  void add(const PaddedLayers& layers, const PixelPair& at, std::size_t place, const FilterWeights& weights) {
    F weight = 0.0f;
    for (std::size_t k = 0; k < filter_count; ++k) weight += load(layers.shares[k].at(at.x, at.y)) * weights[k];
    for (std::size_t c = 0; c < sums.size(); ++c)
      add_to(&sums[c][place], weight * load(layers.planes[c].at(at.other_x, at.other_y)));
  }
};

// One tile of a half of the first image: sums over pixels of that half of any image, by the weights of the other half.
class TileFilter {
 public:
  TileFilter(const PaddedImage& first, std::size_t half, int x0, int y0)
      : half_(half), guide_(first[1 - half]), x0_(x0), y0_(y0) {}

  // Adds the pixels of an image to the sums. `values`: of this half of the image.
  template <class Values, class Sums>
  void add(const PaddedImage& there, const Values& values, Sums& sums) {
    for (int dy = -filter_reach; dy <= filter_reach; ++dy)
      for (int dx = -filter_reach; dx <= filter_reach; ++dx) {
        constexpr float radius = filter_reach + 1;
        const float near = 1 - float(dx * dx + dy * dy) / (radius * radius);
        if (near <= 0) continue;
        find_differences(there[1 - half_], dx, dy);
        for (int row = 0; row < tile_height; ++row) add_row(there, values, row, {dx, dy}, near, sums);
      }
  }

 private:
  struct Offset {
    int x, y;
  };
  static constexpr int columns = tile_width + native_lanes;  // of differences: a pack more holds the patches' margin

  // The squared differences of the colours at each pixel and at its neighbour, without the part that their variances
  // explain, in units of these; sums over the channels. A neighbour counts with at most the pixel's own variance, or
  // one rare bright sample would make its pixel similar to all pixels around it.
  void find_differences(const PaddedHalf& other, int dx, int dy) {
    for (int row = 0; row < tile_height + 2 * patch; ++row) {
      const int y = y0_ + row - patch;
      for (int i = 0; i < columns; i += native_lanes) {
        const int x = x0_ - patch + i;
        F sum = 0.0f;
        for (std::size_t c = 0; c < rgb_size; ++c) {
          const F difference = load(guide_.color[c].at(x, y)) - load(other.color[c].at(x + dx, y + dy));
          const F here = load(guide_.variance[c].at(x, y)), there = load(other.variance[c].at(x + dx, y + dy));
          const F variance = here + min(here, there);
          sum += (difference * difference - variance) / (variance + 1e-8f);
        }
        store(&differences_[std::size_t(row)][std::size_t(i)], sum);
      }
    }
  }

  template <class Values, class Sums>
  void add_row(const PaddedImage& there, const Values& values, int row, Offset to, float near, Sums& sums) {
    const PaddedHalf &source = there[half_], &guide = there[1 - half_];
    const int y = y0_ + row;
    const auto first = std::size_t(row);
    // Sums over the rows of a patch, from the column before the tile on.
    alignas(64) std::array<float, columns> rows;
    for (std::size_t i = 0; i < std::size_t(columns); i += native_lanes)
      store(&rows[i],
            load(&differences_[first][i]) + load(&differences_[first + 1][i]) + load(&differences_[first + 2][i]));
    for (int i = 0; i < tile_width; i += native_lanes) {
      const int x = x0_ + i;
      const float* around = &rows[std::size_t(i)];
      const F difference =
          max((load(around) + load_across(around, 1) + load_across(around, 2)) * (1.0f / (9 * rgb_size)), F(0.0f));
      const PixelPair pair{x, y, x + to.x, y + to.y};
      const F features = distance(guide_.albedo, guide.albedo, pair) * (1 / square(albedo_scale)) +
                         distance(guide_.normal, guide.normal, pair) * (1 / square(normal_scale));
      // No light of surfaces spreads to where there are none: lamps before darkness would have a halo.
      const F other_near_surface = load(guide.near_surface.at(pair.other_x, pair.other_y));
      const F counts = 1.0f - other_near_surface * (1.0f - load(guide_.near_surface.at(x, y)));
      const F exists = load(source.exists.at(pair.other_x, pair.other_y)) *
                       load(guide.exists.at(pair.other_x, pair.other_y)) * counts * near;
      FilterWeights weights;
      for (std::size_t k = 0; k < filter_count; ++k) {
        const float scale = 1 / (color_scales[k] * color_scales[k]);
        weights[k] = exp(F(0.0f) - (difference * scale + features)) * exists;
      }
      sums.add(values, pair, std::size_t(row) * tile_width + std::size_t(i), weights);
    }
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
  static F load_across(const float* from, int columns_on) { return load(from + columns_on); }

  std::size_t half_;
  const PaddedHalf& guide_;  // of the first image
  int x0_, y0_;
  alignas(64) std::array<std::array<float, columns>, tile_height + 2 * patch> differences_{};
};

// Calls f(pixel of the image, its place in the tile) for the part of the tile that is in the image.
template <class Function>
void for_each_pixel(const NoisyImage& image, int x0, int y0, Function f) {
  for (int y = y0; y < std::min(y0 + tile_height, image.height); ++y)
    for (int x = x0; x < std::min(x0 + tile_width, image.width); ++x)
      f(std::size_t(y) * std::size_t(image.width) + std::size_t(x), std::size_t((y - y0) * tile_width + x - x0));
}

// The means of a tile, from its sums.
void copy_tile(const ColorSums& sums, const NoisyImage& image, const HalfPlanes& source, int x0, int y0,
               std::span<FilteredHalf> out) {
  for_each_pixel(image, x0, y0, [&](std::size_t i, std::size_t place) {
    for (std::size_t k = 0; k < filter_count; ++k) {
      const float weight = sums.weight[k][place];
      const bool has_sum = weight > 0;
      for (std::size_t c = 0; c < rgb_size; ++c)
        out[k].color[c][i] = has_sum ? sums.color[k][c][place] / weight : source.color[c][i];
      // Its own weight is 1.
      out[k].own[i] = has_sum && source.share[i] > 0 ? std::min(1 / weight, 1.0f) : 1.0f;
    }
  });
}

// The layers of half `half` of an image. `filters`: the number of the first filter of each group that averages over it.
PaddedLayers padded_layers(const NoisyImage& image, std::size_t half, const FilterMixture& mixture,
                           const std::vector<FilteredHalf>& filtered, std::span<const std::size_t> filters) {
  PaddedLayers padded;
  for (const NoisyLayer& layer : image.layers)
    for (const Plane& plane : layer.halves[half]) padded.planes.emplace_back(plane, image.width, image.height);
  for (std::size_t k = 0; k < filter_count; ++k) {
    Plane shares(image.pixels());
    for (std::size_t first : filters)
      for (std::size_t i = 0; i < shares.size(); ++i)
        shares[i] += mixture.filters[first + k][i] * filtered[first + k].own[i];
    padded.shares[k] = PaddedPlane(shares, image.width, image.height);
  }
  return padded;
}

// The image and the others.
std::vector<PaddedImage> padded_images(const NoisyImage& image, const DenoiseSettings& settings) {
  std::vector<PaddedImage> images{padded_image(image)};
  for (const NoisyImage& other : settings.others) images.push_back(padded_image(other));
  return images;
}

// Calls f(half, x0, y0) for each half of each tile, by all threads.
template <class Function>
void for_each_tile(const NoisyImage& image, const DenoiseSettings& settings, Function f) {
  const auto across = std::size_t((image.width + tile_width - 1) / tile_width);
  const std::size_t tiles = across * std::size_t((image.height + tile_height - 1) / tile_height);
  Scheduler scheduler(settings.threads);
  const auto run = [&](std::size_t unit, int) {
    const std::size_t tile = unit / 2;
    f(unit % 2, int(tile % across) * tile_width, int(tile / across) * tile_height);
  };
  if (scheduler.run(2 * tiles, run, {0, settings.stop}) < 2 * tiles)
    throw std::runtime_error("the removal of noise was interrupted");
}

}  // namespace

FilteredHalves filter_halves(const NoisyImage& image, const DenoiseSettings& settings) {
  const std::vector<PaddedImage> images = padded_images(image, settings);
  FilteredHalves filtered;
  for (auto& half : filtered) {
    half.resize(settings.others.empty() ? filter_count : 2 * filter_count);
    for (FilteredHalf& one : half) {
      for (Plane& plane : one.color) plane.resize(image.pixels());
      one.own.resize(image.pixels());
    }
  }
  for_each_tile(image, settings, [&](std::size_t half, int x0, int y0) {
    TileFilter filter(images[0], half, x0, y0);
    const auto sums = std::make_unique<ColorSums>();
    const auto copy = [&](std::size_t first) {
      copy_tile(*sums, image, image.halves[half], x0, y0, std::span(filtered[half]).subspan(first));
    };
    filter.add(images[0], images[0][half].color, *sums);
    if (images.size() > 1) copy(filter_count);
    for (std::size_t other = 1; other < images.size(); ++other)
      filter.add(images[other], images[other][half].color, *sums);
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
  for_each_tile(image, settings, [&](std::size_t half, int x0, int y0) {
    TileFilter filter(images[0], half, x0, y0);
    LayerSums sums(padded[half].front().planes.size());
    for (std::size_t i = 0; i < images.size(); ++i) filter.add(images[i], padded[half][i], sums);
    for_each_pixel(image, x0, y0, [&](std::size_t i, std::size_t place) {
      for (std::size_t layer = 0; layer < layers.size(); ++layer)
        for (std::size_t c = 0; c < rgb_size; ++c) layers[layer][half][c][i] += sums.sums[layer * rgb_size + c][place];
    });
  });
  return layers;
}

}  // namespace montelux
