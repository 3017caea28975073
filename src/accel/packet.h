// Packets of rays in the kernel's form, and its calls by the number of lanes.
#pragma once
#include <cstring>

#include "accel/accel.h"
#include "accel/rtcore.h"

namespace montelux {

// The value that the kernel writes if nothing was hit.
inline constexpr std::uint32_t missed = ~0u;

template <class F>
void store_lanes(void* to, const F& x) {
  std::memcpy(to, &x, sizeof x);
}
template <class F>
F load_lanes(const void* from) {
  F x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

// The kernel passes ray identifiers to the filters: here they state the use of the rays.
template <class F>
void put_ray(RTCRayNt<lanes_of<F>>& to, const Ray<F>& ray, RayUse use) {
  using U = Uint<F>;
  store_lanes(to.org_x, ray.o.x), store_lanes(to.org_y, ray.o.y), store_lanes(to.org_z, ray.o.z);
  store_lanes(to.dir_x, ray.d.x), store_lanes(to.dir_y, ray.d.y), store_lanes(to.dir_z, ray.d.z);
  store_lanes(to.tnear, F(0.0f)), store_lanes(to.tfar, ray.t_max), store_lanes(to.time, ray.time);
  store_lanes(to.mask, U(~0u)), store_lanes(to.id, U(std::uint32_t(use))), store_lanes(to.flags, U(0u));
}

#if RTC_VERSION_MAJOR >= 4
struct Arguments {
  RTCIntersectArguments intersect;
  RTCOccludedArguments occluded;
  explicit Arguments(RayUse use) {
    rtcInitIntersectArguments(&intersect);
    rtcInitOccludedArguments(&occluded);
    if (use == RayUse::camera) intersect.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
};
template <int N>
inline void kernel_intersect(const int* valid, RTCScene s, RTCRayHitNt<N>* r, Arguments& a) {
  if constexpr (N == 1) rtcIntersect1(s, reinterpret_cast<RTCRayHit*>(r), &a.intersect);
  if constexpr (N == 4) rtcIntersect4(valid, s, reinterpret_cast<RTCRayHit4*>(r), &a.intersect);
  if constexpr (N == 8) rtcIntersect8(valid, s, reinterpret_cast<RTCRayHit8*>(r), &a.intersect);
  if constexpr (N == 16) rtcIntersect16(valid, s, reinterpret_cast<RTCRayHit16*>(r), &a.intersect);
}
template <int N>
inline void kernel_occluded(const int* valid, RTCScene s, RTCRayNt<N>* r, Arguments& a) {
  if constexpr (N == 1) rtcOccluded1(s, reinterpret_cast<RTCRay*>(r), &a.occluded);
  if constexpr (N == 4) rtcOccluded4(valid, s, reinterpret_cast<RTCRay4*>(r), &a.occluded);
  if constexpr (N == 8) rtcOccluded8(valid, s, reinterpret_cast<RTCRay8*>(r), &a.occluded);
  if constexpr (N == 16) rtcOccluded16(valid, s, reinterpret_cast<RTCRay16*>(r), &a.occluded);
}
#else
struct Arguments {
  RTCIntersectContext context;
  explicit Arguments(RayUse use) {
    rtcInitIntersectContext(&context);
    if (use == RayUse::camera) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
};
template <int N>
inline void kernel_intersect(const int* valid, RTCScene s, RTCRayHitNt<N>* r, Arguments& a) {
  if constexpr (N == 1) rtcIntersect1(s, &a.context, reinterpret_cast<RTCRayHit*>(r));
  if constexpr (N == 4) rtcIntersect4(valid, s, &a.context, reinterpret_cast<RTCRayHit4*>(r));
  if constexpr (N == 8) rtcIntersect8(valid, s, &a.context, reinterpret_cast<RTCRayHit8*>(r));
  if constexpr (N == 16) rtcIntersect16(valid, s, &a.context, reinterpret_cast<RTCRayHit16*>(r));
}
template <int N>
inline void kernel_occluded(const int* valid, RTCScene s, RTCRayNt<N>* r, Arguments& a) {
  if constexpr (N == 1) rtcOccluded1(s, &a.context, reinterpret_cast<RTCRay*>(r));
  if constexpr (N == 4) rtcOccluded4(valid, s, &a.context, reinterpret_cast<RTCRay4*>(r));
  if constexpr (N == 8) rtcOccluded8(valid, s, &a.context, reinterpret_cast<RTCRay8*>(r));
  if constexpr (N == 16) rtcOccluded16(valid, s, &a.context, reinterpret_cast<RTCRay16*>(r));
}
#endif

// All bits set in lanes that are on.
template <class F>
Uint<F> valid_lanes(Mask<F> on) {
  return select(on, Uint<F>(~0u), Uint<F>(0u));
}

// A packet for the nearest hit, before the kernel fills in the rest.
template <class F>
void put_ray_hit(RTCRayHitNt<lanes_of<F>>& to, const Ray<F>& ray, RayUse use) {
  put_ray<F>(to.ray, ray, use);
  store_lanes(to.hit.geomID, Uint<F>(missed)), store_lanes(to.hit.primID, Uint<F>(0u));
  store_lanes(to.hit.instID[0], Uint<F>(missed));
  store_lanes(to.hit.u, F(0.0f)), store_lanes(to.hit.v, F(0.0f));
}

}  // namespace montelux
