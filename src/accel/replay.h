// Recording the rays that a program traces, and tracing them again by the kernel alone: an upper bound of the
// speed.
#pragma once
#include <memory>

#include "accel/accel.h"

namespace montelux {

// The same results for trace and occluded as the Accel, and records the packets of one thread.
class RayRecorder {
 public:
  explicit RayRecorder(const Accel& accel);
  ~RayRecorder();

  template <class F>
  Accel::Trace<F> trace(const Ray<F>& ray, Mask<F> on, RayUse use = RayUse::path) const;
  template <class F>
  Mask<F> occluded(const Ray<F>& ray, Mask<F> on) const;

  struct Replay {
    std::size_t rays = 0;  // that were on
    double seconds = 0;    // processor time in the kernel's calls
  };
  // Traces all packets again, in their original order.
  Replay replay() const;

 private:
  struct Packets;
  const Accel& accel_;
  std::unique_ptr<Packets> packets_;
};

}  // namespace montelux
