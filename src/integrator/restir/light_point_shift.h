// The shift of direct light: a point of a light stays where it is, whichever surface uses it. Points are counted in
// their own measure (area, direction, choice), which all surfaces share, so the Jacobian is 1 (Bitterli et al. 2020,
// sec. 4; Lin et al. 2022, sec. 5: reconnection at the light).
#pragma once
#include <memory>

#include "integrator/restir/shadow_ray_batch.h"
#include "integrator/restir/vertex.h"

namespace montelux {

// What differs from domain to domain: the light that the vertex sends on.
template <class F>
struct LightPointImage {
  F jacobian, target;
  Spectrum<F> scattered;
};
template <class F>
MONTELUX_INLINE LightPointImage<F> select(Mask<F> m, const LightPointImage<F>& a,
                                          const LightPointImage<F>& b) requires(lanes_of<F> > 1) {
  return {select(m, a.jacobian, b.jacobian), select(m, a.target, b.target), select(m, a.scattered, b.scattered)};
}

// The image of a light point, with that light.
template <class F>
struct ShiftedLight : Shifted<LightPoint<F>, F> {
  Spectrum<F> scattered;
};

// The domains of a combination of LightReservoirs: the integral over all lights at each of `vertices`.
template <class F, class Rays>
struct LightPointDomains {
  const MediumSet& media;
  const LightSet& lights;
  const Rays& rays;
  std::span<const ReuseVertex<F>> vertices;
  bool sees;  // targets know what is in the way
  RayCounts& counts;

  ShiftedLight<F> shift(int, const LightPoint<F>& value, Mask<F> on) const {
    const LightConnection<F> way = seen_from(0, value, on);
    return {{value, F(1.0f), way.target}, way.value};
  }
  F target_at(int to, const LightPoint<F>& value, Mask<F> on) const { return seen_from(to, value, on).target; }
  // A surface sees what it has.
  LightPointImage<F> own(int of, const LightPoint<F>& value, Mask<F> on) const {
    const LightConnection<F> way = connect(media, lights, vertices[std::size_t(of)], value, on);
    return {F(1.0f), way.target, way.value};
  }
  void images(int from, const LightPoint<F>& value, std::span<const Mask<F>> on,
              std::span<LightPointImage<F>> images) const {
    std::vector<Ray<F>> ways(images.size());
    const auto open = std::make_unique<Mask<F>[]>(images.size());
    for (std::size_t k = 0; k < images.size(); ++k) {
      const LightConnection<F> way = connect(media, lights, vertices[k], value, on[k]);
      images[k] = {F(1.0f), way.target, way.value};
      open[k] = on[k] & (way.target > F(0.0f)) & Mask<F>(int(k) != from);
      ways[k] = vertices[k].shadow_ray_to(way.wi, way.distance);
    }
    if (!sees) return;
    keep_open<F>(rays, std::span<const Ray<F>>(ways), std::span<Mask<F>>(open.get(), images.size()), counts);
    for (std::size_t k = 0; k < images.size(); ++k)
      if (int(k) != from) images[k].target = select(open[k], images[k].target, F(0.0f));
  }

 private:
  LightConnection<F> seen_from(int to, const LightPoint<F>& value, Mask<F> on) const {
    const ReuseVertex<F>& vertex = vertices[std::size_t(to)];
    LightConnection<F> way = connect(media, lights, vertex, value, on);
    if (!sees) return way;
    const Mask<F> open = is_open<F>(rays, vertex, way, on & (way.target > F(0.0f)), counts.shadow);
    way.target = select(open, way.target, F(0.0f));
    return way;
  }
};

}  // namespace montelux
