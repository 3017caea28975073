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
// them. An eighth of the samples of each tile is compared: in passes of eight samples or more a part of each pass, so
// that every pass sees the whole picture and its parts are no noise.
class PairedBias {
 public:
  // `samples_per_pass`: of each pixel; of a series, frames. `unbiased` must outlive this.
  PairedBias(const PixelIntegrator& unbiased, std::size_t tiles, int samples_per_pass);

  const PixelIntegrator& unbiased() const { return unbiased_; }
  bool compares(std::size_t tile, int pass, int sample) const;
  // One sample of each pixel of such a tile, by both. Those that are not finite in both do not count. Thread-safe;
  // samples of one pass must follow one another.
  void add(std::size_t tile, int pass, std::span<const PixelSample> biased, std::span<const PixelSample> unbiased);
  // Of the mean of the picture; the same bits whatever the order in which tiles came. By pass or, where shorter passes
  // see the whole picture only together and there are enough, by the first of so many. The mean over them is the sum
  // of all differences over the number of pixels, and their spread is that of this ratio (Cochran 1977, sec. 6.3):
  // tiles of different sizes are no noise.
  BiasOfPasses bias();

 private:
  // Over pixels and samples.
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
  std::size_t every_;  // turns until each tile has had one
  std::size_t samples_per_pass_, samples_per_turn_;
  std::mutex mutex_;
  std::map<int, std::map<std::size_t, Sum>> sums_;  // by pass and tile
};

}  // namespace montelux
