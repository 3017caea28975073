// Recording of the rays that a program traces, and tracing them again by the kernel alone: how fast it could be at
// best.
#pragma once
#include <memory>

#include "accel/accel.h"

namespace montelux {

// Answers trace and occluded as the Accel does, and keeps the packets of one thread.
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
  // Traces all packets once more, in the order in which they came.
  Replay replay() const;

 private:
  struct Packets;
  const Accel& accel_;
  std::unique_ptr<Packets> packets_;
};

}  // namespace montelux
