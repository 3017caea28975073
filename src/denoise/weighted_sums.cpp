#include "denoise/weighted_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>

#include "denoise/box_mean.h"
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
  PaddedPlane exists;  // 1 for pixels of the image that have a pass, else 0
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

PaddedImage padded_image(const NoisyImage& image) {
  const int w = image.width, h = image.height;
  PaddedImage both;
  for (std::size_t k = 0; k < 2; ++k) {
    const HalfPlanes& half = image.halves[k];
    Plane exists(image.pixels());
    for (std::size_t i = 0; i < exists.size(); ++i) exists[i] = half.share[i] > 0 ? 1.0f : 0.0f;
    both[k] = {padded(half.color, w, h), padded(variance_of_half(image, half), w, h),
               padded_feature(image, k, &HalfPlanes::albedo), padded_feature(image, k, &HalfPlanes::normal),
               PaddedPlane(exists, w, h, false)};
  }
  return both;
}

// Sums over the neighbours of the pixels of a tile, for each filter.
struct TileSums {
  static constexpr int size = tile_width * tile_height;
  std::array<std::array<std::array<float, size>, rgb_size>, filter_count> color;
  std::array<std::array<float, size>, filter_count> weight;
};

struct PixelPair {
  int x, y, other_x, other_y;
};

// One tile of a half of the first image: sums over pixels of that half of any image, by the weights of the other half.
class TileFilter {
 public:
  TileFilter(const PaddedImage& first, std::size_t half, int x0, int y0)
      : half_(half), guide_(first[1 - half]), x0_(x0), y0_(y0) {}

  // Adds the pixels of an image to the sums.
  void add(const PaddedImage& there) {
    for (int dy = -filter_reach; dy <= filter_reach; ++dy)
      for (int dx = -filter_reach; dx <= filter_reach; ++dx) {
        constexpr float radius = filter_reach + 1;
        const float near = 1 - float(dx * dx + dy * dy) / (radius * radius);
        if (near <= 0) continue;
        find_differences(there[1 - half_], dx, dy);
        for (int row = 0; row < tile_height; ++row) add_row(there, row, dx, dy, near);
      }
  }
  const TileSums& sums() const { return sums_; }

 private:
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

  void add_row(const PaddedImage& there, int row, int dx, int dy, float near) {
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
      const PixelPair pair{x, y, x + dx, y + dy};
      const F features = distance(guide_.albedo, guide.albedo, pair) * (1 / square(albedo_scale)) +
                         distance(guide_.normal, guide.normal, pair) * (1 / square(normal_scale));
      const F exists = load(source.exists.at(x + dx, y + dy)) * load(guide.exists.at(x + dx, y + dy)) * near;
      std::array<F, rgb_size> color;
      for (std::size_t c = 0; c < rgb_size; ++c) color[c] = load(source.color[c].at(x + dx, y + dy));
      const std::size_t place = std::size_t(row) * tile_width + std::size_t(i);
      for (std::size_t k = 0; k < filter_count; ++k) {
        const float scale = 1 / (color_scales[k] * color_scales[k]);
        const F weight = exp(F(0.0f) - (difference * scale + features)) * exists;
        for (std::size_t c = 0; c < rgb_size; ++c) {
          float* sum = &sums_.color[k][c][place];
          store(sum, load(sum) + weight * color[c]);
        }
        store(&sums_.weight[k][place], load(&sums_.weight[k][place]) + weight);
      }
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
  alignas(64) TileSums sums_{};
};

// The part of the tile that is in the image.
void copy_tile(const TileSums& sums, const NoisyImage& image, const HalfPlanes& source, int x0, int y0,
               std::span<FilteredHalf> out) {
  for (int y = y0; y < std::min(y0 + tile_height, image.height); ++y)
    for (int x = x0; x < std::min(x0 + tile_width, image.width); ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
      const auto place = std::size_t((y - y0) * tile_width + x - x0);
      for (std::size_t k = 0; k < filter_count; ++k) {
        const float weight = sums.weight[k][place];
        const bool has_sum = weight > 0;
        for (std::size_t c = 0; c < rgb_size; ++c)
          out[k].color[c][i] = has_sum ? sums.color[k][c][place] / weight : source.color[c][i];
        // Its own weight is 1.
        out[k].own[i] = has_sum && source.share[i] > 0 ? std::min(1 / weight, 1.0f) : 1.0f;
      }
    }
}

}  // namespace

FilteredHalves filter_halves(const NoisyImage& image, const DenoiseSettings& settings) {
  std::vector<PaddedImage> images{padded_image(image)};
  for (const NoisyImage& other : settings.others) images.push_back(padded_image(other));
  FilteredHalves filtered;
  for (auto& half : filtered) {
    half.resize(settings.others.empty() ? filter_count : 2 * filter_count);
    for (FilteredHalf& one : half) {
      for (Plane& plane : one.color) plane.resize(image.pixels());
      one.own.resize(image.pixels());
    }
  }
  const int across = (image.width + tile_width - 1) / tile_width;
  const auto tiles = std::size_t(across) * std::size_t((image.height + tile_height - 1) / tile_height);
  const auto filter_tile = [&](std::size_t half, int x0, int y0) {
    const auto filter = std::make_unique<TileFilter>(images[0], half, x0, y0);
    const auto copy = [&](std::span<FilteredHalf> out) {
      copy_tile(filter->sums(), image, image.halves[half], x0, y0, out);
    };
    filter->add(images[0]);
    if (images.size() > 1) copy(std::span(filtered[half]).subspan(filter_count));
    for (std::size_t other = 1; other < images.size(); ++other) filter->add(images[other]);
    copy(filtered[half]);
  };
  Scheduler scheduler(settings.threads);
  const std::size_t done = scheduler.run(2 * tiles,
                                         [&](std::size_t unit, int) {
                                           const std::size_t tile = unit / 2;
                                           filter_tile(unit % 2, int(tile % std::size_t(across)) * tile_width,
                                                       int(tile / std::size_t(across)) * tile_height);
                                         },
                                         {0, settings.stop});
  if (done < 2 * tiles) throw std::runtime_error("the removal of noise was interrupted");
  return filtered;
}

}  // namespace montelux
