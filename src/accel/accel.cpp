#include "accel/accel.h"

#include "accel/kernel.h"
#include "accel/packet.h"

namespace montelux {

static_assert(RTC_VERSION_MAJOR == MONTELUX_EMBREE_MAJOR,
              "the compiler sees the headers of another Embree than CMake found");

Accel::Accel(const GeometryStore& store, OpacityTest is_opaque, int threads)
    : kernel_(std::make_unique<Kernel>(store, std::move(is_opaque), threads)) {}
Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;

std::size_t Accel::memory() const { return std::size_t(kernel_->bytes.load()); }
std::string Accel::kernel_version() { return RTC_VERSION_STRING; }

namespace {

// Whether the kernel accepts the ray; the kernel aborts on coordinates that are too large or not a number. Rays that
// are not accepted hit nothing.
template <class F>
MONTELUX_INLINE Mask<F> is_valid(const Ray<F>& ray, float bound) {
  const auto within = [&](const Vec3<F>& v) {
    return (abs(v.x) <= F(bound)) & (abs(v.y) <= F(bound)) & (abs(v.z) <= F(bound));
  };
  return within(ray.o) & within(ray.d) & (ray.t_max == ray.t_max);
}

}  // namespace

template <class F>
Accel::Trace<F> Accel::trace(const Ray<F>& ray, Mask<F> wanted, RayUse use) const {
  const Mask<F> on = wanted & is_valid(ray, kernel_->max_ray);
  constexpr int n = lanes_of<F>;
  using U = Uint<F>;
  alignas(64) RTCRayHitNt<n> r;
  alignas(64) int valid[n];
  put_ray_hit<F>(r, ray, use);
  store_lanes(valid, valid_lanes<F>(on));
  Arguments arguments(use);
  if (n > 1 || any(on)) kernel_intersect<n>(valid, kernel_->world.get(), &r, arguments);

  U id = load_lanes<U>(r.hit.geomID), instance = load_lanes<U>(r.hit.instID[0]);
  Mask<F> found = on & (id != U(missed)), instanced = found & (instance != U(missed));
  U geometry = id;
  U placed = select(instanced, instance - U(kernel_->store.world_rows) + U(1u), U(0u));
  if (any(instanced)) {
    for_each_lane(instanced, [&](int k) {
      const PlacedObject& object = kernel_->store.instances[lane(placed, k) - 1];
      set_lane(geometry, k, kernel_->store.objects[object.object].first + lane(id, k));
    });
  }
  geometry = select(found, geometry, U(0u));
  return {found,
          {load_lanes<F>(r.ray.tfar), load_lanes<F>(r.hit.u), load_lanes<F>(r.hit.v), geometry,
           select(found, load_lanes<U>(r.hit.primID), U(0u)), placed}};
}

template <class F>
Mask<F> Accel::occluded(const Ray<F>& ray, Mask<F> wanted) const {
  const Mask<F> on = wanted & is_valid(ray, kernel_->max_ray);
  constexpr int n = lanes_of<F>;
  alignas(64) RTCRayNt<n> r;
  alignas(64) int valid[n];
  put_ray<F>(r, ray, RayUse::shadow);
  store_lanes(valid, valid_lanes<F>(on));
  // Embree 3.13 does not return from packets of shadow rays marked coherent if there are instances.
  Arguments arguments(RayUse::shadow);
  if (n > 1 || any(on)) kernel_occluded<n>(valid, kernel_->world.get(), &r, arguments);
  return on & (load_lanes<F>(r.tfar) < F(0.0f));
}

template Accel::Trace<float> Accel::trace(const Ray<float>&, bool, RayUse) const;
template bool Accel::occluded(const Ray<float>&, bool) const;
template Accel::Trace<NativeFloats> Accel::trace(const Ray<NativeFloats>&, Mask<NativeFloats>, RayUse) const;
template Mask<NativeFloats> Accel::occluded(const Ray<NativeFloats>&, Mask<NativeFloats>) const;

}  // namespace montelux
