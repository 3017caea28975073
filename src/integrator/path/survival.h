// Russian roulette for efficiency: a path survives with the probability that minimises variance times cost, as measured
// by a pilot before the render.
#pragma once
#include <span>
#include <vector>

#include "image/pixel_sample.h"
#include "transport/path_state.h"

namespace montelux {

// What the throughput of a path is multiplied by to give its probability to live on: by block of the picture and by
// the number of scattering events. Immutable, so the decisions of a render are a function of its settings alone.
class SurvivalMap {
 public:
  static constexpr int depths = 12;  // the last one is for all that are deeper

  SurvivalMap(int block_bits, int blocks_across, std::vector<float> factors)
      : block_bits_(block_bits), blocks_across_(blocks_across), factors_(std::move(factors)) {}

  // The pixel lies within the picture.
  template <class F>
  F factor(Uint<F> x, Uint<F> y, Uint<F> depth) const {
    using U = Uint<F>;
    const U block = (y >> block_bits_) * U(std::uint32_t(blocks_across_)) + (x >> block_bits_);
    const U deepest = U(std::uint32_t(depths)), last = U(std::uint32_t(factors_.size() - 1));
    const U bounded = select(depth < deepest, depth, deepest);
    const U place = block * deepest + select(bounded > U(0u), bounded - U(1u), U(0u));
    // Lanes that are off may lie anywhere.
    return gather(factors_.data(), select(place < last, place, last));
  }

 private:
  int block_bits_, blocks_across_;
  std::vector<float> factors_;  // blocks by rows; the depths of a block are consecutive
};

// A path that survives with too small a probability would have too large a weight.
inline constexpr float min_survival = 0.05f;

// One path of the pilot, without roulette: before each decision its throughput (as roulette takes it) and the light
// gathered so far, mean of the channels; at last all of its light.
struct PilotPath {
  struct Decision {
    float throughput, gathered;
  };
  std::vector<Decision> decisions;
  float light = 0;
  int block = 0, pixel = 0;  // the pixel: a number of its own
};

// Watches the paths of one tile as a tally of the path loop does.
class PilotTally {
 public:
  static constexpr bool records = false;
  explicit PilotTally(std::span<PilotPath> paths) : paths_(paths) {}

  // Paths have scattered, in the lanes `on`, and are about to play roulette.
  template <class F>
  void scattered(const PathState<F>& path, Mask<F> on) {
    const F throughput = roulette_throughput(path);
    const Spectrum<F> gathered = path.radiance * path.weight;
    for_each_lane(on, [&](int k) {
      paths_[lane(path.output, k)].decisions.push_back({lane(throughput, k), mean_light(to_rgb(lane(gathered, k)))});
    });
  }
  static float mean_light(const Rgb& radiance) { return (radiance.c[0] + radiance.c[1] + radiance.c[2]) / 3; }

 private:
  std::span<PilotPath> paths_;
};

// The blocks of a picture: at most 16 across and down, of at least 8 pixels.
struct PilotBlocks {
  int bits = 3, across = 1, down = 1;
  static PilotBlocks of(int width, int height);
  int count() const { return across * down; }
};

// The factors by the paths of a pilot: a path of throughput T lives on with probability T r sqrt(M / c) sqrt(C / V),
// where M is the mean square of what it would yet gather for a throughput of 1, c what that costs, V and C the
// variance and the cost of a whole sample, and r weighs a block as relative errors do. That is where the derivative of
// V C vanishes (Bolin and Meyer 1997, "An error metric for Monte Carlo ray tracing"; Rath et al. 2022, "EARS"). M, c, V
// and C depend on the roulette itself, so they are found by iteration, over expectations of the recorded paths.
SurvivalMap survival_from(std::span<const PilotPath> paths, const PilotBlocks& blocks, int roulette_depth);

}  // namespace montelux
