// Rank-1 lattices: the multiples of one vector modulo 1, and how good a vector is.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mc/cube_points.h"
#include "mc/digital.h"

namespace montelux {

inline constexpr std::size_t lattice_dimensions = 64;

// A generating vector for lattices of 2^m points, all m at once: point i of the sequence is the i-th radical inverse in
// base 2 times the vector, modulo 1 (Hickernell, Hong, L'Ecuyer and Lemieux 2000). It was found by construct_lattice.
extern const std::array<std::uint32_t, lattice_dimensions> lattice_generator;

// One coordinate of the point `index` of the sequence whose vector has `z` there, shifted modulo 1: in units of 2^-32.
template <class U>
MONTELUX_INLINE U lattice_word(U index, U z, U shift) {
  return reverse_bits(index) * z + shift;
}

// The squared worst-case error, mean over shifts, of the first 2^m points in the weighted Korobov space of smoothness 1
// with product weights 1 / j (Kuo 2003): 2^-m sum over points of prod_j (1 + 2 pi^2 / j B_2(x_j)), less 1.
double lattice_error(std::vector<std::uint32_t> generator, int m);

// Component by component (Sloan and Reztsov 2002): each component is the one of `candidates` random odd numbers whose
// worst ratio over m = first_m ... last_m, of its error to that of the best candidate at this m, is smallest (Cools,
// Kuo and Nuyens 2006).
struct LatticeSearch {
  std::size_t dimensions = lattice_dimensions;
  int first_m = 6, last_m = 18;
  std::uint32_t candidates = 128, seed = 1;
};
std::vector<std::uint32_t> construct_lattice(const LatticeSearch& search);

// A lattice sequence with a random shift: the first 2^m points are a rank-1 lattice, and so are those after them, for
// every m (lattice_generator). Indices below 2^32, dimensions up to lattice_dimensions.
void fill_lattice(CubeKey key, CubeBlock block);

}  // namespace montelux
