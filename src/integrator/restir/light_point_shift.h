// The shift of direct light: a point of a light stays where it is, whichever surface asks for it. Points are counted in
// their own measure (area, direction, choice), which all surfaces share, so the Jacobian is 1 (Bitterli et al. 2020,
// sec. 4; Lin et al. 2022, sec. 5: reconnection at the light).
#pragma once
#include "integrator/restir/vertex.h"

namespace montelux {

// The domains of a combination of LightReservoirs: the integral over all lights at each of `vertices`.
template <class F, class Rays>
struct LightPointDomains {
  const LightSet& lights;
  const Rays& rays;
  std::span<const ReuseVertex<F>> vertices;
  bool sees;  // targets know what is in the way
  RayCounts& counts;

  Shifted<LightPoint<F>, F> shift(int, const LightPoint<F>& value, Mask<F> on) const {
    return {value, F(1.0f), target_at(0, value, on)};
  }
  F target_at(int to, const LightPoint<F>& value, Mask<F> on) const {
    const ReuseVertex<F>& vertex = vertices[std::size_t(to)];
    const Connection<F> way = connect(lights, vertex, value, on);
    if (!sees) return way.target;
    const Mask<F> open = is_open<F>(rays, vertex, way, on & (way.target > F(0.0f)), counts);
    return select(open, way.target, F(0.0f));
  }
};

}  // namespace montelux
