// Shapes meet rays in double precision: one ray, or eight at a time. A template over D, double or Doubles, states each
// intersection once, so that both have the same bits.
#pragma once
#include <array>
#include <bit>
#include <optional>
#include <span>

#include "geometry/double3.h"
#include "geometry/shape_hit.h"
#include "math/double_lanes.h"

namespace montelux {

// A ray with the interval of its parameter, whose ends are of single precision.
template <class D>
struct DoubleRay {
  Vec3<D> o, d;
  D t_min, t_max;
  Vec3<D> at(D t) const { return o + d * t; }
  // Whether t is inside the interval, after rounding to single precision too.
  MaskOfDouble<D> contains(D t) const {
    const D rounded = rounded_to_float(t);
    return (t > t_min) & (rounded > t_min) & (rounded < t_max);
  }
};

// Where rays meet a shape: the parameter of the ray and those of the shape, valid where found.
template <class D>
struct DoubleHits {
  MaskOfDouble<D> found;
  D t, u, v;
};

// The hit of one ray after t_min, by nearest(DoubleRay<D>) -> DoubleHits<D>.
template <class Nearest>
std::optional<ShapeHit> hit_after(const Ray<float>& ray, float t_min, Nearest&& nearest) {
  const DoubleHits<double> hit = nearest(DoubleRay<double>{to_double(ray.o), to_double(ray.d), t_min, ray.t_max});
  if (!hit.found) return std::nullopt;
  return ShapeHit{float(hit.t), {float(hit.u), float(hit.v)}};
}

// The hits of several rays from t = 0; as many hits as rays.
template <class Nearest>
void hits_of(std::span<const Ray<float>> rays, std::span<std::optional<ShapeHit>> hits, Nearest&& nearest) {
  if (rays.size() == 1) {
    hits[0] = hit_after(rays[0], 0.0f, nearest);
    return;
  }
  for (std::size_t first = 0; first < rays.size(); first += double_lanes) {
    const std::size_t n = std::min(rays.size() - first, std::size_t(double_lanes));
    std::array<std::array<double, double_lanes>, 7> rows{};  // of each lane: o, d, t_max
    for (std::size_t k = 0; k < n; ++k) {
      const Ray<float>& ray = rays[first + k];
      rows[0][k] = ray.o.x, rows[1][k] = ray.o.y, rows[2][k] = ray.o.z;
      rows[3][k] = ray.d.x, rows[4][k] = ray.d.y, rows[5][k] = ray.d.z, rows[6][k] = ray.t_max;
    }
    const auto row = [&](std::size_t i) { return std::bit_cast<Doubles>(rows[i]); };
    const DoubleHits<Doubles> hit =
        nearest(DoubleRay<Doubles>{{row(0), row(1), row(2)}, {row(3), row(4), row(5)}, Doubles(0.0), row(6)});
    const auto t = std::bit_cast<std::array<double, double_lanes>>(hit.t);
    const auto u = std::bit_cast<std::array<double, double_lanes>>(hit.u);
    const auto v = std::bit_cast<std::array<double, double_lanes>>(hit.v);
    for (std::size_t k = 0; k < n; ++k) {
      std::optional<ShapeHit>& to = hits[first + k];
      to.reset();
      if (lane(hit.found, int(k))) to = ShapeHit{float(t[k]), {float(u[k]), float(v[k])}};
    }
  }
}

}  // namespace montelux
