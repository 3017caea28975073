// Rays against the scene: the only folder that knows the ray-tracing kernel (Embree 3 or 4).
#pragma once
#include <functional>
#include <memory>

#include "geometry/ray.h"
#include "scene/geometry_store.h"

namespace montelux {

// True where the surface is there for a ray, at (geometry row, primitive, u, v). Asked where the row has an alpha mask,
// and by shadow rays where it is open to some of them. The ray is in the space of the hit's instance. Of shapes that
// are no meshes, `primitive` is the number of surfaces of the shape that the ray has passed.
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
    Hit<F> hit;  // valid numbers in every lane, meaningful where found
  };
  // The nearest surface in (0, t_max) for lanes that are on. Rays of the camera run side by side, which makes them
  // fast, and pass by the backs of one-sided surfaces.
  template <class F>
  Trace<F> trace(const Ray<F>& ray, Mask<F> on, RayUse use = RayUse::path) const;
  // Whether anything lies in (0, t_max): yes only in lanes that are on.
  template <class F>
  Mask<F> occluded(const Ray<F>& ray, Mask<F> on) const;

  // Memory that the kernel holds, in bytes.
  std::size_t memory() const;
  static std::string kernel_version();

 private:
  friend class RayRecorder;
  struct Kernel;
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace montelux
