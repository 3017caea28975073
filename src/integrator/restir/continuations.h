// Paths that continue beyond the vertex whose direct light is reused: a source of paths for the path loop.
#pragma once
#include <span>
#include <vector>

#include "image/pixel_sample.h"
#include "math/lane_queue.h"
#include "transport/path_state.h"

namespace montelux {

template <class F>
class Continuations {
 public:
  // Paths whose next vertex is path.hit; path.output says where their light goes. The light that they meet there
  // belongs to them only where `counts`: elsewhere the reused reservoirs have it.
  void add(const PathState<F>& path, Mask<F> on, Mask<F> counts) {
    PathState<F> numbered = path;
    for_each_lane(on, [&](int k) {
      set_lane(numbered.output, k, std::uint32_t(outputs_.size()));
      outputs_.push_back(lane(path.output, k));
      silent_depths_.push_back(lane(counts, k) ? ~0u : lane(path.depth, k));
    });
    paths_.add(numbered, on);
  }

  // The interface of the path loop's sources.
  Mask<F> refill(PathState<F>& state, Mask<F> on) { return on | paths_.fill(state, on); }
  Mask<F> counts_light(const PathState<F>& path, Mask<F> on) const {
    return on & (gather(silent_depths_.data(), select(on, path.output, Uint<F>(0u))) != path.depth);
  }

  // Adds what the loop has written to `results`, one for each path.
  std::size_t count() const { return outputs_.size(); }
  void add_results(std::span<const PixelSample> results, std::span<PixelSample> out) const {
    for (std::size_t i = 0; i < results.size(); ++i) out[outputs_[i]].radiance += results[i].radiance;
  }

 private:
  LaneQueue<PathState, F> paths_;
  std::vector<std::uint32_t> outputs_, silent_depths_;
};

}  // namespace montelux
