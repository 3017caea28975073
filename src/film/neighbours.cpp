#include "film/neighbours.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "film/likeness.h"

namespace montelux {

namespace {

constexpr int reach = 4;  // pixels
constexpr float spatial_scale = 2.0f * reach / 3.0f;

float mean_of_channels(const ColorPlanes& planes, std::size_t i) {
  float sum = 0;
  for (const Plane& channel : planes) sum += channel[i];
  return sum / rgb_size;
}

// Means over the neighbours of each pixel.
struct Neighbours {
  ColorPlanes mean;
  Plane variance;  // of one of them
  Plane emission;
  Plane count;  // number of neighbours of equal weight with the same variance (Kish 1965); 0: none

  // `mean` is that of the pixels themselves until it is known.
  explicit Neighbours(const FilmPlanes& p)
      : mean(p.mean), variance(p.object.size()), emission(p.object.size()), count(p.object.size()) {}
};

// Sums over the neighbours of a row of pixels.
struct RowSums {
  ColorPlanes light;
  Plane weight, square;  // of the weights, of their squares
  Plane variance, emission;

  explicit RowSums(std::size_t width) : width_(width) { clear(); }
  void clear() {
    for (Plane& channel : light) channel.assign(width_, 0.0f);
    for (Plane* plane : {&weight, &square, &variance, &emission}) plane->assign(width_, 0.0f);
  }

 private:
  std::size_t width_;
};

// A neighbour, by its offset.
struct Offset {
  int dx, dy;
};

template <std::size_t n>
std::array<const float*, n> rows_at(const std::array<Plane, n>& planes, std::ptrdiff_t first) {
  std::array<const float*, n> rows;
  for (std::size_t i = 0; i < n; ++i) rows[i] = planes[i].data() + first;
  return rows;
}

// Adds one neighbour to each pixel of a row. `variance`: means over the channels. The inner loop has no branches, so
// that it runs in lanes.
void add_neighbour(const FilmPlanes& p, const Plane& variance, int row, Offset offset, RowSums& sums) {
  const int width = p.bounds.width(), x0 = std::max(0, -offset.dx), x1 = std::min(width, width - offset.dx);
  const std::ptrdiff_t own = std::ptrdiff_t(row) * width, other = own + std::ptrdiff_t(offset.dy) * width + offset.dx;
  const float near = 1 / (1 + float(offset.dx * offset.dx + offset.dy * offset.dy) / (spatial_scale * spatial_scale));
  const auto albedo = rows_at(p.albedo, own), albedo_there = rows_at(p.albedo, other);
  const auto normal = rows_at(p.normal, own), normal_there = rows_at(p.normal, other);
  const auto mean_there = rows_at(p.mean, other);
  const float *object = p.object.data() + own, *object_there = p.object.data() + other;
  const std::uint32_t* passes_there = p.passes.data() + other;
  const float *emission_there = p.emission.data() + other, *variance_there = variance.data() + other;
  // No other pointer aliases the sums.
  float* __restrict weights = sums.weight.data(), * __restrict squares = sums.square.data();
  float* __restrict variances = sums.variance.data(), * __restrict emissions = sums.emission.data();
  std::array<float*, rgb_size> light;
  for (std::size_t c = 0; c < rgb_size; ++c) light[c] = sums.light[c].data();
#ifndef __clang__  // which sees by itself that no iteration depends on another
#pragma GCC ivdep
#endif
  for (int x = x0; x < x1; ++x) {
    float albedos = 0, normals = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const float d = albedo[c][x] - albedo_there[c][x];
      albedos += d * d;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const float d = normal[c][x] - normal_there[c][x];
      normals += d * d;
    }
    const float w = likeness(near, albedos, normals, object[x] == object_there[x]) * float(passes_there[x] > 0);
    for (std::size_t c = 0; c < rgb_size; ++c) light[c][x] += w * mean_there[c][x];
    weights[x] += w, squares[x] += w * w;
    variances[x] += w * variance_there[x], emissions[x] += w * emission_there[x];
  }
}

void add_all_neighbours(const FilmPlanes& p, const Plane& variance, int row, RowSums& sums) {
  for (int dy = -reach; dy <= reach; ++dy) {
    if (row + dy < 0 || row + dy >= p.bounds.height()) continue;
    for (int dx = -reach; dx <= reach; ++dx)
      if ((dx != 0 || dy != 0) && std::abs(dx) < p.bounds.width()) add_neighbour(p, variance, row, {dx, dy}, sums);
  }
}

Neighbours near_neighbours(const FilmPlanes& p) {
  Neighbours near(p);
  const std::size_t width = std::size_t(p.bounds.width());
  Plane variance(p.object.size());
  for (std::size_t i = 0; i < variance.size(); ++i) variance[i] = mean_of_channels(p.variance, i);
  RowSums sums(width);
  for (int row = 0; row < p.bounds.height(); ++row) {
    sums.clear();
    add_all_neighbours(p, variance, row, sums);
    for (std::size_t x = 0; x < width; ++x) {
      const float weight = sums.weight[x];
      if (weight <= 0) continue;
      const std::size_t i = std::size_t(row) * width + x;
      for (std::size_t c = 0; c < rgb_size; ++c) near.mean[c][i] = sums.light[c][x] / weight;
      near.variance[i] = sums.variance[x] / weight, near.emission[i] = sums.emission[x] / weight;
      near.count[i] = weight * weight / sums.square[x];
    }
  }
  return near;
}

constexpr int block = 4;  // pixels per side

// Adds a pixel to its block; sums are divided later.
void add_to_block(const FilmPlanes& p, std::size_t i, FilmPlanes& blocks, std::size_t k, Plane& count) {
  for (std::size_t c = 0; c < rgb_size; ++c) {
    blocks.mean[c][k] += p.mean[c][i], blocks.variance[c][k] += p.variance[c][i];
    blocks.albedo[c][k] += p.albedo[c][i];
  }
  for (std::size_t c = 0; c < 3; ++c) blocks.normal[c][k] += p.normal[c][i];
  blocks.object[k] = p.object[i], blocks.passes[k] = 1;
  count[k] += 1;
}

// Whether most of the light is of emitters that the camera sees.
bool shows_emitter(const ColorPlanes& mean, const Plane& emission, std::size_t i) {
  return 2 * emission[i] > mean_of_channels(mean, i);
}

// The image of the means of blocks. Their variance is that of one pixel.
FilmPlanes blocks_of(const FilmPlanes& p) {
  const int width = p.bounds.width(), height = p.bounds.height();
  FilmPlanes blocks({0, 0, (width + block - 1) / block, (height + block - 1) / block});
  Plane count(blocks.object.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      if (p.passes[i] > 0 && !shows_emitter(p.mean, p.emission, i))
        add_to_block(p, i, blocks, blocks.index(x / block, y / block), count);
    }
  for (std::size_t k = 0; k < count.size(); ++k) {
    if (count[k] == 0) continue;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      blocks.mean[c][k] /= count[k], blocks.albedo[c][k] /= count[k];
      blocks.variance[c][k] /= count[k];
    }
    for (std::size_t c = 0; c < 3; ++c) blocks.normal[c][k] /= count[k];
  }
  return blocks;
}

// The mean of the near ones shrinks toward that of the far ones as far as noise explains how they differ (James and
// Stein 1961). Where few samples are bright the near ones may have had none of them, so the noise is at least that of
// the far ones. The edge of an emitter is no noise. `pixels`: of the picture in one of the near ones.
void shrink(Neighbours& near, std::size_t i, const Neighbours& far, std::size_t k, float pixels) {
  if (near.count[i] <= 0 || far.count[k] <= 0 || shows_emitter(near.mean, near.emission, i)) return;
  const float difference = mean_of_channels(near.mean, i) - mean_of_channels(far.mean, k);
  const float variance = std::max(near.variance[i], far.variance[k]) / pixels;
  const float noise = variance * (1 / near.count[i] + 1 / (block * block * far.count[k]));
  const float square = difference * difference, share = square > noise ? 1 - noise / square : 0.0f;
  for (std::size_t c = 0; c < rgb_size; ++c)
    near.mean[c][i] = far.mean[c][k] + share * (near.mean[c][i] - far.mean[c][k]);
}

// Of a picture whose pixels are means of so many.
Neighbours neighbours_of(const FilmPlanes& p, float pixels) {
  Neighbours near = near_neighbours(p);
  const int width = p.bounds.width(), height = p.bounds.height();
  if (std::max(width, height) <= reach) return near;
  const FilmPlanes blocks = blocks_of(p);
  const Neighbours far = neighbours_of(blocks, pixels * block * block);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      shrink(near, std::size_t(y) * std::size_t(width) + std::size_t(x), far, blocks.index(x / block, y / block),
             pixels);
  return near;
}

}  // namespace

ColorPlanes mean_of_neighbours(const FilmPlanes& p) { return neighbours_of(p, 1).mean; }

}  // namespace montelux
