// Many points of the unit hypercube at once, coordinate-major, in double precision, for the integration methods.
// Every number is a pure function of the key, the index of the point and the dimension.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace montelux {

// Distinguishes randomisations.
struct CubeKey {
  std::uint32_t low = 0, high = 0;
  // A different key for each pass of each seed.
  static CubeKey of(std::uint64_t seed, std::uint32_t pass);
  // A different key for each purpose.
  CubeKey fork(std::uint32_t purpose) const;
};

// The output and the range of points: coordinate d of point first + i is out[d * count + i].
struct CubeBlock {
  std::size_t dimension = 1;
  std::uint64_t first = 0;
  std::size_t count = 0;
  double* out = nullptr;
};

// All functions fill the block with numbers in (0, 1), of 52 random bits unless stated otherwise. Blocks of one key may
// be filled in any order and in any parts.

// Independent uniform points.
void fill_independent(CubeKey key, CubeBlock block);
// Points 2k and 2k + 1 are mirror images of each other in the centre of the cube.
void fill_antithetic(CubeKey key, CubeBlock block);
// n points in a Latin hypercube: each coordinate has one of them in each of n equal parts (McKay, Beckman and Conover
// 1979). The block lies within [0, n); n < 2^31.
void fill_latin(CubeKey key, std::uint64_t n, CubeBlock block);

// The number of parts of each axis in a grid of at most n boxes: as equal as possible, the first axes with one more.
struct GridShape {
  std::vector<std::uint32_t> parts;  // by axis
  std::uint64_t boxes = 1;
  static GridShape of(std::size_t dimension, std::uint64_t n);
};
// n points, one uniform in each box of the grid; points in excess of the boxes are uniform in the cube.
void fill_grid(CubeKey key, const GridShape& shape, CubeBlock block);

// Folds each number by the baker's transformation x -> 1 - |2x - 1| (Hickernell 2002): uniform stays uniform, and any
// smooth function becomes continuous as a periodic function.
void fold(std::span<double> x);

}  // namespace montelux
