// The bias of an integrator, by unbiased samples with the same numbers.
#pragma once
#include <cstddef>
#include <map>
#include <mutex>
#include <span>

#include "render/measured_bias.h"

namespace montelux {

// Compares samples of a biased integrator with those that an unbiased one takes with the same numbers. Where both
// integrators are the same except for a limit or a clamp, the difference of samples has far less noise than each of
// them. One tile of `every` is compared at each turn, and each tile once in so many turns. A turn is a pass, or a frame
// of one.
class PairedBias {
 public:
  // `unbiased` must outlive this.
  PairedBias(const PixelIntegrator& unbiased, std::size_t tiles);

  const PixelIntegrator& unbiased() const { return unbiased_; }
  bool compares(std::size_t tile, std::size_t turn) const;
  // The samples of both in such a tile, at a turn of the pass. Those that are not finite in both do not count.
  // Thread-safe; turns of one pass must follow one another.
  void add(std::size_t tile, int pass, int samples_per_pixel, std::span<const PixelSample> biased,
           std::span<const PixelSample> unbiased);
  // Of the mean of the picture; the same bits whatever the order in which tiles came. The mean over passes is the sum
  // of all differences over the number of pixels, and the spread of passes is that of this ratio (Cochran 1977,
  // sec. 6.3): tiles of different sizes are no noise.
  BiasOfPasses bias();

 private:
  // Sums over pixels of differences of their means.
  struct Sum {
    MeanDifference difference{};
    double pixels = 0;
    Sum& operator+=(const Sum& other) {
      for (std::size_t c = 0; c < rgb_size; ++c) difference[c] += other.difference[c];
      pixels += other.pixels;
      return *this;
    }
  };
  const PixelIntegrator& unbiased_;
  std::size_t every_;
  std::mutex mutex_;
  std::map<int, std::map<std::size_t, Sum>> sums_;  // over the turns of a pass, by pass and tile
};

}  // namespace montelux
