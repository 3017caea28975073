#include "mc/sobol.h"

#include "mc/cube_lanes.h"

namespace montelux {

void fill_sobol(CubeKey key, CubeBlock block) {
  const CubeWords lanes = lane_index<NativeFloats>();
  constexpr int lane_bits = std::countr_zero(unsigned(native_lanes));
  for (std::size_t d = 0; d < block.dimension; ++d) {
    const CubeKey own = key.fork(std::uint32_t(d)), more = own.fork(1);
    const auto& columns = sobol_matrices[d];
    const auto digits_of = [&](std::uint32_t index) {
      std::uint32_t digits = 0;
      for (; index != 0; index &= index - 1) digits ^= columns[std::size_t(std::countr_zero(index))];
      return digits;
    };
    // The digits of a pack are those of its first point combined, by linearity, with those of the lanes.
    CubeWords lane_digits = 0u;
    for (int k = 0; k < native_lanes; ++k) set_lane(lane_digits, k, digits_of(std::uint32_t(k)));
    const bool aligned = block.first % cube_pack == 0;
    std::uint32_t digits = digits_of(std::uint32_t(block.first));
    fill_coordinate(block.out + d * block.count, block.count, [&](std::size_t i) {
      CubeWords x = 0u;
      const auto index = std::uint32_t(block.first + i);
      if (aligned) {
        x = CubeWords(digits) ^ lane_digits;
        // From one pack to the next the index changes in its lowest bits, up to the first that becomes 1.
        for (std::uint32_t flip = (index >> lane_bits) ^ ((index >> lane_bits) + 1); flip != 0; flip &= flip - 1)
          digits ^= columns[std::size_t(lane_bits + std::countr_zero(flip)) & 31];
      } else {
        for (int k = 0; k < native_lanes; ++k) set_lane(x, k, digits_of(index + std::uint32_t(k)));
      }
      const CubeWords scrambled = reverse_bits(scramble_upwards(x, CubeWords(own.low))) ^ CubeWords(own.high);
      const CubeWords rest = mix_bits(CubeWords((CubeWords(index) + lanes) * 0x9e3779b9u ^ CubeWords(more.low)));
      return unit_doubles(scrambled, rest);
    });
  }
}

}  // namespace montelux
