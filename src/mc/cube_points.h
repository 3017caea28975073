// Many points of the unit hypercube at once, coordinate-major, in double precision: what methods of integration draw
// from. Every number is a pure function of the key, the index of the point and the dimension.
#pragma once
#include <cstddef>
#include <cstdint>

namespace montelux {

// Tells one randomisation from every other.
struct CubeKey {
  std::uint32_t low = 0, high = 0;
  // A key of its own for each pass of each seed.
  static CubeKey of(std::uint64_t seed, std::uint32_t pass);
  // A key of its own for each purpose.
  CubeKey fork(std::uint32_t purpose) const;
};

// Where the points go, and which: coordinate d of point first + i is out[d * count + i].
struct CubeBlock {
  std::size_t dimension = 1;
  std::uint64_t first = 0;
  std::size_t count = 0;
  double* out = nullptr;
};

// Independent uniform numbers in (0, 1), 52 bits each.
void fill_independent(CubeKey key, CubeBlock block);

}  // namespace montelux
