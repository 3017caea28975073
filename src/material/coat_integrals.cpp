#include "material/internal_reflectance.h"

#include "material/dielectric.h"
#include "mc/point_set.h"

namespace montelux {

float internal_reflectance(const CoatParameters& coat) {
  using F = NativeFloats;
  using U = Uint<F>;
  constexpr std::uint32_t points = 1u << 16;
  const PointSet set{PointSetKind::sobol, 0, 0, points};
  const Dielectric<F> face({F(coat.alpha.x), F(coat.alpha.y)}, F(coat.eta));
  const auto layer = [&](const Vec3<F>& w) { return exp(F(-coat.thickness) / max(abs(w.z), F(1e-10f))); };
  double sum = 0;
  for (std::uint32_t i = 0; i < points; i += native_lanes) {
    const Sampler<F> sampler(set, U(0u), U(0u), lane_index<F>() + U(i));
    const Vec3<F> up = sample_cosine_hemisphere(sampler.get2(U(0u)));
    const auto back =
        face.sample_lobes<Lobes::reflection>(-up, F(0.0f), sampler.get2(U(2u)), TransportMode::importance);
    const F part = back.weight * layer(up) * layer(back.wi);
    for_each_lane(back.valid, [&](int k) { sum += double(lane(part, k)); });
  }
  return float(sum / points);
}

}  // namespace montelux
