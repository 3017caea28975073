// The bias of the cache, by pairs at random samples: what the cache shows there, and an unbiased estimate of the same
// light.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "integrator/integrator.h"
#include "integrator/irradiance_cache/cached_paths.h"
#include "math/shared_count.h"
#include "math/shared_exact_sum.h"

namespace montelux {

// Sums over the frames of a series. Any number of threads add to them, in any order with the same bits.
class BiasPairs {
 public:
  // Paths of the unbiased estimate at each sample, in strata.
  static HemisphereStrata strata() { return HemisphereStrata::of(16); }

  // Which samples of a tile are compared, by their number in the tile: a random share of them. Empty if there are none.
  static std::vector<std::uint8_t> choose(const PointSet& points, int frame, const PixelBounds& tile, float share) {
    const RandomStream<float> all =
        RandomStream<float>(mix_bits(points.seed ^ 0x3c6ef372u), points.pass).fork(std::uint32_t(frame));
    std::vector<std::uint8_t> compared(std::size_t(tile.area()));
    std::size_t number = 0, count = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) {
        const bool chosen = all.fork(std::uint32_t(y)).at(std::uint32_t(x)) < share;
        compared[number++] = chosen ? 1 : 0, count += chosen ? 1 : 0;
      }
    return count > 0 ? compared : std::vector<std::uint8_t>{};
  }
  // The samples that are compared; where the cache had no part in one, nothing differs.
  void count(std::span<const std::uint8_t> compared) {
    for (const std::uint8_t one : compared)
      if (one != 0) samples_.next();
  }
  // `paths` with numbers of their own.
  template <class F, class Rays>
  void compare(std::span<const CachedLight> cached, HemispherePaths<F, Rays>& paths) {
    for (const CachedLight& light : cached) {
      const Spectrum<float> unbiased = paths.estimate(light.point).irradiance;
      const Rgb difference = to_rgb((light.irradiance - unbiased) * light.weight);
      for (int c = 0; c < rgb_size; ++c)
        if (is_finite(difference[c]) && std::abs(difference[c]) < ExactSum::largest)
          sums_[std::size_t(c)].add(difference[c]);
    }
  }
  // The mean over all samples that were compared since the last time.
  std::optional<MeanDifference> take() {
    const std::uint32_t n = samples_.take();
    MeanDifference mean{};
    for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = sums_[c].take().value() / std::max(n, 1u);
    return n > 0 ? std::optional(mean) : std::nullopt;
  }

 private:
  std::array<SharedExactSum, rgb_size> sums_;
  SharedCount samples_;
};

}  // namespace montelux
