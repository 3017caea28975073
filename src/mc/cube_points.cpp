#include "mc/cube_points.h"

#include <cmath>

#include "mc/cube_lanes.h"
#include "mc/digital.h"

namespace montelux {

CubeKey CubeKey::of(std::uint64_t seed, std::uint32_t pass) {
  const std::uint32_t low = std::uint32_t(seed), high = std::uint32_t(seed >> 32);
  const std::uint32_t mixed = mix_bits(low ^ mix_bits(high + 0x9e3779b9u));
  return CubeKey{mixed, mix_bits(high ^ mix_bits(low + 0x3c6ef372u))}.fork(pass);
}
CubeKey CubeKey::fork(std::uint32_t purpose) const {
  return {mix_bits(low ^ mix_bits(purpose * 0x85ebca6bu + 0x27d4eb2fu)), mix_bits(high + mix_bits(low + purpose))};
}

namespace {

// Uniform numbers of one coordinate at the positions first, first + 1, ... of a stream.
struct CoordinateStream {
  CubeKey key;
  MONTELUX_INLINE CubeDoubles at(std::uint64_t index) const {
    // A pack that straddles a multiple of 2^32 wraps within its 2^32 numbers; blocks begin at multiples of the pack.
    const CubeKey part = index >> 32 == 0 ? key : key.fork(std::uint32_t(index >> 32));
    const CubeWords place = CubeWords(std::uint32_t(index)) + lane_index<NativeFloats>();
    const CubeWords high =
        mix_bits(CubeWords(CubeWords(part.high) ^ mix_bits(CubeWords(CubeWords(part.low) + place * 0x9e3779b9u))));
    return unit_doubles(high, mix_bits(CubeWords(high ^ (place + part.low))));
  }
};

}  // namespace

void fill_independent(CubeKey key, CubeBlock block) {
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CoordinateStream stream{key.fork(std::uint32_t(d))};
    fill_coordinate(block.out + d * block.count, block.count,
                    [&](std::size_t i) { return stream.at(block.first + i); });
  }
}

void fill_antithetic(CubeKey key, CubeBlock block) {
  const std::uint64_t first = block.first / 2, last = (block.first + block.count + 1) / 2;
  std::vector<double> half(std::size_t(last - first) * block.dimension);
  fill_independent(key, {block.dimension, first, std::size_t(last - first), half.data()});
  for (std::size_t d = 0; d < block.dimension; ++d)
    for (std::size_t i = 0; i < block.count; ++i) {
      const std::uint64_t index = block.first + i;
      const double x = half[d * std::size_t(last - first) + std::size_t(index / 2 - first)];
      block.out[d * block.count + i] = index % 2 == 0 ? x : 1 - x;
    }
}

void fill_latin(CubeKey key, std::uint64_t n, CubeBlock block) {
  const CubeWords lanes = lane_index<NativeFloats>();
  const double scale = 1 / double(n);
  const CubeWords last(std::uint32_t(n - 1));
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d));
    const CoordinateStream jitter{own.fork(1)};
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      const CubeWords index = min(CubeWords(CubeWords(std::uint32_t(block.first + i)) + lanes), last);
      const CubeWords part = permute(index, std::uint32_t(n), CubeWords(own.low));
      return (__builtin_convertvector(part.v, CubeDoubles) + jitter.at(block.first + i)) * scale;
    });
  }
}

GridShape GridShape::of(std::size_t dimension, std::uint64_t n) {
  GridShape shape;
  auto parts = std::uint32_t(std::pow(double(n), 1 / double(dimension)) + 1e-9);
  shape.parts.assign(dimension, std::max(1u, parts));
  for (std::uint32_t p : shape.parts) shape.boxes *= p;
  for (std::uint32_t& p : shape.parts) {
    if (shape.boxes / p * (p + 1) > n) break;
    shape.boxes = shape.boxes / p * (p + 1);
    ++p;
  }
  return shape;
}

void fill_grid(CubeKey key, const GridShape& shape, CubeBlock block) {
  fill_independent(key, block);
  std::vector<std::uint64_t> place(block.count);
  for (std::size_t i = 0; i < block.count; ++i) place[i] = block.first + i;
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const std::uint32_t parts = shape.parts[d];
    double* x = block.out + d * block.count;
    for (std::size_t i = 0; i < block.count; ++i) {
      if (block.first + i < shape.boxes) x[i] = (double(place[i] % parts) + x[i]) / double(parts);
      place[i] /= parts;
    }
  }
}

void fold(std::span<double> x) {
  for (double& v : x) v = 1 - std::abs(2 * v - 1);
}

}  // namespace montelux
