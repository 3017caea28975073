// Paths that continue beyond the vertex whose direct light is reused: a source of paths for the path loop.
#pragma once
#include <span>
#include <vector>

#include "image/pixel_sample.h"
#include "transport/path_state.h"

namespace montelux {

template <class F>
class Continuations {
 public:
  // Paths whose next vertex is path.hit; path.output says where their light goes. The light that they meet there
  // belongs to them only where `counts`: elsewhere the reused reservoirs have it.
  void add(const PathState<F>& path, Mask<F> on, Mask<F> counts) {
    for_each_lane(on, [&](int k) {
      PathState<float>& one = paths_.emplace_back();
      get_lane_words(path, k, one);
      outputs_.push_back(one.output);
      one.output = std::uint32_t(outputs_.size()) - 1;
      silent_depths_.push_back(lane(counts, k) ? ~0u : one.depth);
    });
  }

  // The interface of the path loop's sources.
  Mask<F> refill(PathState<F>& state, Mask<F> on) {
    std::uint32_t running = bits(on);
    for (int k = 0; k < lanes_of<F> && next_ < paths_.size(); ++k) {
      if ((running >> k) & 1u) continue;
      set_lane_words(state, k, paths_[next_++]);
      running |= 1u << k;
    }
    return mask_of_bits<F>(running);
  }
  Mask<F> counts_light(const PathState<F>& path, Mask<F> on) const {
    return on & (gather(silent_depths_.data(), select(on, path.output, Uint<F>(0u))) != path.depth);
  }

  // Adds what the loop has written to `results`, one for each path.
  std::size_t count() const { return paths_.size(); }
  void add_results(std::span<const PixelSample> results, std::span<PixelSample> out) const {
    for (std::size_t i = 0; i < results.size(); ++i) out[outputs_[i]].radiance += results[i].radiance;
  }

 private:
  std::vector<PathState<float>> paths_;
  std::vector<std::uint32_t> outputs_, silent_depths_;
  std::size_t next_ = 0;
};

}  // namespace montelux
