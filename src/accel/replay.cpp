#include "accel/replay.h"

#include <ctime>
#include <vector>

#include "accel/kernel.h"
#include "accel/packet.h"

namespace montelux {

namespace {

// A recorded call of the kernel.
template <int N>
struct alignas(64) Recorded {
  RTCRayHitNt<N> packet;
  alignas(64) int valid[N];
  RayUse use;
};

template <int N>
double replay_all(RTCScene scene, const std::vector<Recorded<N>>& calls) {
  timespec before, after;
  // The copies are made before the clock starts: the kernel writes to its packets.
  std::vector<Recorded<N>> work(calls);
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
  for (Recorded<N>& call : work) {
    Arguments arguments(call.use);
    if (call.use == RayUse::shadow)
      kernel_occluded<N>(call.valid, scene, &call.packet.ray, arguments);
    else
      kernel_intersect<N>(call.valid, scene, &call.packet, arguments);
  }
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
  return double(after.tv_sec - before.tv_sec) + 1e-9 * double(after.tv_nsec - before.tv_nsec);
}

}  // namespace

struct RayRecorder::Packets {
  std::vector<Recorded<1>> single;
  std::vector<Recorded<native_lanes>> packs;
  std::size_t rays = 0;

  template <class F>
  void add(const Ray<F>& ray, Mask<F> on, RayUse use) {
    Recorded<lanes_of<F>> call{};
    put_ray_hit<F>(call.packet, ray, use);
    store_lanes(call.valid, valid_lanes<F>(on));
    call.use = use;
    rays += std::size_t(count(on));
    if constexpr (lanes_of<F> == 1)
      single.push_back(call);
    else
      packs.push_back(call);
  }
};

RayRecorder::RayRecorder(const Accel& accel) : accel_(accel), packets_(std::make_unique<Packets>()) {}
RayRecorder::~RayRecorder() = default;

template <class F>
Accel::Trace<F> RayRecorder::trace(const Ray<F>& ray, Mask<F> on, RayUse use) const {
  if (any(on)) packets_->add<F>(ray, on, use);
  return accel_.trace<F>(ray, on, use);
}

template <class F>
Mask<F> RayRecorder::occluded(const Ray<F>& ray, Mask<F> on) const {
  if (any(on)) packets_->add<F>(ray, on, RayUse::shadow);
  return accel_.occluded<F>(ray, on);
}

RayRecorder::Replay RayRecorder::replay() const {
  RTCScene scene = accel_.kernel_->world.get();
  return {packets_->rays, replay_all<1>(scene, packets_->single) + replay_all<native_lanes>(scene, packets_->packs)};
}

template Accel::Trace<float> RayRecorder::trace(const Ray<float>&, bool, RayUse) const;
template bool RayRecorder::occluded(const Ray<float>&, bool) const;
template Accel::Trace<NativeFloats> RayRecorder::trace(const Ray<NativeFloats>&, Mask<NativeFloats>, RayUse) const;
template Mask<NativeFloats> RayRecorder::occluded(const Ray<NativeFloats>&, Mask<NativeFloats>) const;

}  // namespace montelux
