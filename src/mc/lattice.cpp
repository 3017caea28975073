#include "mc/lattice.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "mc/cube_lanes.h"
#include "mc/digital.h"

namespace montelux {
namespace {

constexpr double two_pi_squared = 2 * std::numbers::pi * std::numbers::pi;

// One factor of the error's kernel for component j (from 1) at coordinate `word` / 2^32.
double kernel_factor(std::uint32_t word, std::size_t j) {
  const double x = double(word) * 0x1p-32;
  return 1 + two_pi_squared / double(j) * (x * (x - 1) + 1.0 / 6);
}

// The errors for all m from the products over the components at the points of the sequence, without the last factor.
std::vector<double> errors_at(const std::vector<double>& products, std::uint32_t z, std::size_t j,
                              LatticeSearch search) {
  std::vector<double> errors;
  double sum = 0;
  std::uint32_t i = 0;
  for (int m = 0; m <= search.last_m; ++m) {
    for (; i < 1u << m; ++i) sum += products[i] * kernel_factor(reverse_bits(i) * z, j);
    if (m >= search.first_m) errors.push_back(sum / double(1u << m) - 1);
  }
  return errors;
}

}  // namespace

// By construct_lattice with last_m = 18 and 128 candidates.
// clang-format off
const std::array<std::uint32_t, lattice_dimensions> lattice_generator{
    0x00000001u, 0x913dcd8fu, 0xf2d3c8dbu, 0x6b790c65u, 0x0b45ebbdu, 0x4965d373u, 0xd31b8cd1u, 0xf131524du,
    0x1f767d65u, 0x1eea3f29u, 0x60a1fcebu, 0xa7ad3d77u, 0x7263af03u, 0xadb54bf3u, 0x4bff2d6du, 0x2fa84a15u,
    0x322eb245u, 0x763972afu, 0x7fb49361u, 0x15a07675u, 0x651fc24bu, 0x58a7e879u, 0xc24dedebu, 0x9df6a695u,
    0xe6a8c1e9u, 0x7ec310b5u, 0x42df53efu, 0x4f918ee1u, 0x60bce447u, 0xfa663157u, 0x0c5c97abu, 0xdf3a158du,
    0x24c98b59u, 0x3a911513u, 0x21b45f6fu, 0x78873227u, 0xd46b0559u, 0xa2f78fbfu, 0x982b3cb1u, 0x01f44d2du,
    0x3571864du, 0xf6bafdb9u, 0x286b5fb1u, 0x90cc3831u, 0x20a14aadu, 0x7f98dc83u, 0xf0c0207du, 0x97121269u,
    0x8ba6ef69u, 0x4342945fu, 0x54b9ab15u, 0xa7eb9795u, 0xd8c8776bu, 0xdfc738b9u, 0x2d61a4abu, 0xc84193fbu,
    0xe12a495du, 0x11da3d3fu, 0x3a37c56bu, 0x11aad8d5u, 0xc3d2b309u, 0xcce70c5bu, 0x643a8161u, 0x7b9cd7a9u,
};
// clang-format on

double lattice_error(std::vector<std::uint32_t> generator, int m) {
  double sum = 0;
  for (std::uint32_t i = 0; i < 1u << m; ++i) {
    double product = 1;
    for (std::size_t j = 0; j < generator.size(); ++j) product *= kernel_factor(reverse_bits(i) * generator[j], j + 1);
    sum += product;
  }
  return sum / double(1u << m) - 1;
}

std::vector<std::uint32_t> construct_lattice(const LatticeSearch& search) {
  std::vector<std::uint32_t> generator;
  std::vector<double> products(std::size_t(1) << search.last_m, 1.0);
  RandomStream<float> stream(search.seed, 0x1a771ceu);
  for (std::size_t j = 1; j <= search.dimensions; ++j) {
    std::vector<std::uint32_t> candidates;
    std::vector<std::vector<double>> errors;
    // The first components have the largest weights and are used by every integral: they get more candidates.
    const std::uint32_t tried = j == 1 ? 1 : search.candidates * (j <= 10 ? 16 : 1);
    for (std::uint32_t c = 0; c < tried; ++c) {
      candidates.push_back(j == 1 ? 1u : stream.bits_at((std::uint32_t(j) << 20) + c) | 1u);
      errors.push_back(errors_at(products, candidates.back(), j, search));
    }
    std::vector<double> best(errors.front().size(), std::numeric_limits<double>::infinity());
    for (const auto& e : errors)
      for (std::size_t m = 0; m < e.size(); ++m) best[m] = std::min(best[m], e[m]);
    std::size_t chosen = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      double worst = 0;
      for (std::size_t m = 0; m < best.size(); ++m) worst = std::max(worst, errors[c][m] / best[m]);
      if (worst < smallest) smallest = worst, chosen = c;
    }
    generator.push_back(candidates[chosen]);
    for (std::uint32_t i = 0; i < products.size(); ++i)
      products[i] *= kernel_factor(reverse_bits(i) * generator.back(), j);
  }
  return generator;
}

void fill_lattice(CubeKey key, CubeBlock block) {
  const CubeWords lanes = lane_index<NativeFloats>();
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d));
    const std::uint32_t z = lattice_generator[d];
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      const CubeWords index = CubeWords(std::uint32_t(block.first + i)) + lanes;
      return unit_doubles(lattice_word(index, CubeWords(z), CubeWords(own.high)), CubeWords(own.low));
    });
  }
}

}  // namespace montelux
