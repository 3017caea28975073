// Rays against the scene: the only folder that uses the ray-tracing kernel (Embree 3 or 4).
#pragma once
#include <functional>
#include <memory>

#include "geometry/ray.h"
#include "scene/geometry_store.h"

namespace montelux {

// True if the surface exists for a ray at (geometry row, primitive, u, v). Called if the row has an alpha mask,
// and for shadow rays if some of them pass it. The ray is in the space of the hit's instance. For shapes that
// are not meshes, `primitive` is the number of surfaces of the shape that the ray has passed.
using OpacityTest = std::function<bool(const Hit<float>&, const Ray<float>&, RayUse)>;

class Accel {
 public:
  // `store` must outlive it and not change. `threads`: for building; 0: all of the machine.
  Accel(const GeometryStore& store, OpacityTest is_opaque, int threads = 0);
  ~Accel();
  Accel(Accel&&) noexcept;

  template <class F>
  struct Trace {
    Mask<F> found;
    Hit<F> hit;  // finite numbers in every lane, meaningful where found
  };
  // The nearest surface in (0, t_max) for lanes that are on. Camera rays are coherent, which makes them
  // fast, and ignore the backs of one-sided surfaces.
  template <class F>
  Trace<F> trace(const Ray<F>& ray, Mask<F> on, RayUse use = RayUse::path) const;
  // Whether anything is in (0, t_max): true only in lanes that are on.
  template <class F>
  Mask<F> occluded(const Ray<F>& ray, Mask<F> on) const;

  // Memory used by the kernel, in bytes.
  std::size_t memory() const;
  static std::string kernel_version();

 private:
  friend class RayRecorder;
  struct Kernel;
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace montelux
