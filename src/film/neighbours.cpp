#include "film/neighbours.h"

#include <algorithm>
#include <cstdlib>

namespace montelux {

namespace {

constexpr int reach = 4;  // pixels
constexpr float spatial_scale = 2.0f * reach / 3.0f;
// Squared distances of albedos and of normals at which a neighbour's weight is a quarter, and its share where it shows
// another object.
constexpr float albedo_scale = 0.02f, normal_scale = 0.1f, other_object = 0.1f;

// Sums over the neighbours of a row of pixels.
struct RowSums {
  ColorPlanes light;
  Plane weight;
  explicit RowSums(int width) : weight(std::size_t(width)) {
    for (Plane& channel : light) channel.resize(std::size_t(width));
  }
  void clear() {
    for (Plane& channel : light) std::fill(channel.begin(), channel.end(), 0.0f);
    std::fill(weight.begin(), weight.end(), 0.0f);
  }
};

// A neighbour, by where it lies.
struct Offset {
  int dx, dy;
};

template <std::size_t n>
std::array<const float*, n> rows_at(const std::array<Plane, n>& planes, std::ptrdiff_t first) {
  std::array<const float*, n> rows;
  for (std::size_t i = 0; i < n; ++i) rows[i] = planes[i].data() + first;
  return rows;
}

// Adds one neighbour to each pixel of a row. The inner loop has no branches, so that it runs in lanes.
void add_neighbour(const FilmPlanes& p, int row, Offset offset, RowSums& sums) {
  const int width = p.bounds.width(), x0 = std::max(0, -offset.dx), x1 = std::min(width, width - offset.dx);
  const std::ptrdiff_t own = std::ptrdiff_t(row) * width, other = own + std::ptrdiff_t(offset.dy) * width + offset.dx;
  const float near = 1 / (1 + float(offset.dx * offset.dx + offset.dy * offset.dy) / (spatial_scale * spatial_scale));
  const auto albedo = rows_at(p.albedo, own), albedo_there = rows_at(p.albedo, other);
  const auto normal = rows_at(p.normal, own), normal_there = rows_at(p.normal, other);
  const auto mean_there = rows_at(p.mean, other);
  const float *object = p.object.data() + own, *object_there = p.object.data() + other;
  const std::uint8_t* passes_there = p.passes.data() + other;
  // Nothing else points to the sums.
  float* __restrict weights = sums.weight.data();
  std::array<float*, spectrum_size> light;
  for (std::size_t c = 0; c < spectrum_size; ++c) light[c] = sums.light[c].data();
#pragma GCC ivdep
  for (int x = x0; x < x1; ++x) {
    float albedos = 0, normals = 0;
    for (std::size_t c = 0; c < spectrum_size; ++c) {
      const float d = albedo[c][x] - albedo_there[c][x];
      albedos += d * d;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const float d = normal[c][x] - normal_there[c][x];
      normals += d * d;
    }
    const float alike = 1 / (1 + albedos * (1 / albedo_scale) + normals * (1 / normal_scale));
    const float same = object[x] == object_there[x] ? 1.0f : other_object;
    const float w = near * same * alike * alike * float(passes_there[x] > 0);
    for (std::size_t c = 0; c < spectrum_size; ++c) light[c][x] += w * mean_there[c][x];
    weights[x] += w;
  }
}

void add_all_neighbours(const FilmPlanes& p, int row, RowSums& sums) {
  for (int dy = -reach; dy <= reach; ++dy) {
    if (row + dy < 0 || row + dy >= p.bounds.height()) continue;
    for (int dx = -reach; dx <= reach; ++dx)
      if ((dx != 0 || dy != 0) && std::abs(dx) < p.bounds.width()) add_neighbour(p, row, {dx, dy}, sums);
  }
}

}  // namespace

ColorPlanes mean_of_neighbours(const FilmPlanes& p) {
  ColorPlanes means = p.mean;
  const std::size_t width = std::size_t(p.bounds.width());
  RowSums sums(p.bounds.width());
  for (int row = 0; row < p.bounds.height(); ++row) {
    sums.clear();
    add_all_neighbours(p, row, sums);
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < spectrum_size && sums.weight[x] > 0; ++c)
        means[c][std::size_t(row) * width + x] = sums.light[c][x] / sums.weight[x];
  }
  return means;
}

}  // namespace montelux
