// What all pixels hold between the steps of a series: one reservoir each, before a step and after it.
#pragma once
#include <vector>

#include "mc/reuse.h"
#include "transport/path_state.h"

namespace montelux {

// `Value` is made of 32-bit words alone.
template <template <class> class Value>
class ReservoirPlanes {
 public:
  using One = Reservoir<Value<float>, float>;

  void resize(std::size_t pixels) {
    for (auto& plane : planes_) plane.resize(pixels);
  }
  // Steps are counted from the first of the series on; only the last two are there.
  std::vector<One>& after(int step) { return planes_[std::size_t(step) & 1]; }
  const std::vector<One>& before(int step) const { return planes_[std::size_t(step + 1) & 1]; }

 private:
  std::vector<One> planes_[2];
};

template <template <class> class Value, class F>
void put(Reservoir<Value<F>, F>& lanes, int k, const Reservoir<Value<float>, float>& one) {
  set_lane_words(lanes.value, k, one.value);
  set_lane(lanes.weight, k, one.weight), set_lane(lanes.confidence, k, one.confidence);
  set_lane(lanes.target, k, one.target);
}
template <template <class> class Value, class F>
void get(const Reservoir<Value<F>, F>& lanes, int k, Reservoir<Value<float>, float>& one) {
  get_lane_words(lanes.value, k, one.value);
  one.weight = lane(lanes.weight, k), one.confidence = lane(lanes.confidence, k), one.target = lane(lanes.target, k);
}

}  // namespace montelux
