// Rejection: propose until a proposal is accepted, and count.
#pragma once
#include <cmath>

#include "mc/random.h"

namespace montelux {

template <class T>
struct Rejection {
  T value;
  std::uint32_t trials;  // proposals made, the accepted one among them
};

// How many proposals were accepted; the efficiency is the area under the density over that of the proposals.
struct AcceptanceRate {
  double accepted = 0, trials = 0;

  template <class T>
  void add(const Rejection<T>& r) {
    accepted += 1, trials += r.trials;
  }
  double efficiency() const { return accepted / trials; }
  // The standard error of the efficiency when proposals are drawn until a fixed number is accepted (delta method).
  double standard_error() const {
    const double p = efficiency();
    return p * std::sqrt((1 - p) / accepted);
  }
};

// propose() draws a proposal, accept(proposal) accepts or rejects it. Returns only when one is accepted.
template <class Propose, class Accept>
auto sample_by_rejection(Propose propose, Accept accept) -> Rejection<decltype(propose())> {
  for (std::uint32_t trials = 1;; ++trials)
    if (auto proposal = propose(); accept(proposal)) return {proposal, trials};
}

// x in [0, 1) with density proportional to f >= 0, from points of the box below `bound` >= max f.
template <class Function>
Rejection<float> sample_under_curve(Function f, float bound, RandomStream<float>& stream) {
  const auto r =
      sample_by_rejection([&] { return stream.next2(); }, [&](Vec2f p) { return p.y * bound < float(f(p.x)); });
  return {r.value.x, r.trials};
}

// Uniform on the unit disk, from its bounding square.
inline Rejection<Vec2f> sample_disk_by_rejection(RandomStream<float>& stream) {
  return sample_by_rejection(
      [&] {
        const Vec2f u = stream.next2();
        return Vec2f{2 * u.x - 1, 2 * u.y - 1};
      },
      [](Vec2f p) { return p.x * p.x + p.y * p.y <= 1; });
}

// Uniform in solid angle on the hemisphere about +z, from points of the half ball in its bounding box, made unit.
inline Rejection<Vec3f> sample_hemisphere_by_rejection(RandomStream<float>& stream) {
  auto r = sample_by_rejection(
      [&] {
        const Vec2f u = stream.next2();
        return Vec3f{2 * u.x - 1, 2 * u.y - 1, stream.next()};
      },
      [](Vec3f p) { return dot(p, p) <= 1 && dot(p, p) > 1e-12f; });
  r.value = normalize(r.value);
  return r;
}

}  // namespace montelux
