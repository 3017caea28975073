// The light of samples in parts, each with its origin, where it is known only later how much of it counts in which
// pixel.
#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "integrator/tally.h"

namespace montelux {

// Light of one origin.
struct LightPart {
  LightOrigin<float> from;
  Spectrum<float> contribution;
};

// The origin, without what the layers of the plan do not distinguish.
inline LightOrigin<float> distinguished(const LayerPlan& plan, LightOrigin<float> from) {
  const auto first_of_rest = [](std::optional<int> last) { return last ? std::uint32_t(*last) + 1 : 0u; };
  from.bounces = std::min(
      from.bounces, std::max({first_of_rest(plan.bounces), first_of_rest(plan.strategies), plan.techniques ? 1u : 0u}));
  if (plan.light_groups) {
    const std::uint32_t group = plan.group_of_light[from.light];
    from.light = std::uint32_t(std::ranges::find(plan.group_of_light, group) - plan.group_of_light.begin());
  } else {
    from.light = 0;
  }
  if (!plan.techniques) from.technique = Technique::light_sampling;
  if (!plan.strategies) from.light_vertices = 0, from.merged = false;
  if (!plan.alone) from.weight = 1;
  return from;
}
inline bool same_origin(const LightOrigin<float>& a, const LightOrigin<float>& b) {
  return a.bounces == b.bounces && a.light == b.light && a.technique == b.technique &&
         a.light_vertices == b.light_vertices && a.merged == b.merged && a.weight == b.weight;
}
// Adds to the part of that origin, or another part. The parts are in the order in which their origins came.
inline void add_part(std::vector<LightPart>& parts, const LightOrigin<float>& from,
                     const Spectrum<float>& contribution) {
  for (LightPart& part : parts)
    if (same_origin(part.from, from)) {
      part.contribution += contribution;
      return;
    }
  parts.push_back({from, contribution});
}

// A tally that keeps the parts of each sample, as LayerTally keeps sums for each pixel.
class PartsTally {
 public:
  static constexpr bool records = true;
  // `samples`: the number of their outputs. `bounces_before`: of the samples' paths, which do not count. The plan must
  // outlive this.
  PartsTally(const LayerPlan& plan, std::size_t samples, std::uint32_t bounces_before = 0)
      : plan_(plan), bounces_before_(bounces_before), lanes_(native_lanes), parts_(samples) {}

  template <class F>
  void add(Mask<F> on, const Spectrum<F>& contribution, const LightOrigin<F>& from) {
    for_each_lane(on, [&](int k) {
      LightOrigin<float> one = lane_of(from, k);
      one.bounces -= bounces_before_;
      add_part(lanes_[std::size_t(k)], distinguished(plan_, one), lane(contribution, k));
    });
  }
  // The sample of lane k is done.
  void finish(int k, std::uint32_t output, PixelSample&) {
    parts_[output].clear();
    std::swap(parts_[output], lanes_[std::size_t(k)]);
  }
  // Those of a sample since the last time.
  std::vector<LightPart> take(std::size_t output) { return std::exchange(parts_[output], {}); }

 private:
  const LayerPlan& plan_;
  const std::uint32_t bounces_before_;
  std::vector<std::vector<LightPart>> lanes_, parts_;
};

}  // namespace montelux
