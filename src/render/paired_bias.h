// The bias of an integrator, by unbiased samples with the same numbers.
#pragma once
#include <cstddef>
#include <map>
#include <mutex>
#include <span>

#include "render/measured_bias.h"

namespace montelux {

// Compares samples of a biased integrator with those that an unbiased one takes with the same numbers. Where the
// options of the former change nothing both are equal, so their difference has far less noise than each of them. One
// tile of `every` is compared in each pass, and each tile once in so many passes.
class PairedBias {
 public:
  // `unbiased` must outlive this.
  PairedBias(const PixelIntegrator& unbiased, std::size_t tiles);

  const PixelIntegrator& unbiased() const { return unbiased_; }
  bool compares(std::size_t tile, int pass) const;
  // The samples of both in such a tile and pass. Those that are not finite in both do not count. Thread-safe.
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
  };
  const PixelIntegrator& unbiased_;
  std::size_t every_;
  std::mutex mutex_;
  std::map<int, std::map<std::size_t, Sum>> sums_;  // by pass and tile
};

}  // namespace montelux
