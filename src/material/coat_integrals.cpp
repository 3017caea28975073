#include "material/coat_integrals.h"

#include <cmath>

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

namespace coat_transmittance {

namespace {

// At the cosine c, by sampled facets.
double by_facets(float c, const CoatParameters& coat, std::uint32_t points) {
  using F = NativeFloats;
  using U = Uint<F>;
  const PointSet set{PointSetKind::sobol, 0, 0, points};
  const Dielectric<F> face({F(coat.alpha.x), F(coat.alpha.y)}, F(coat.eta));
  const Vec3<F> w{F(std::sqrt(std::max(0.0f, 1 - c * c))), F(0.0f), F(c)};
  double sum = 0;
  for (std::uint32_t i = 0; i < points; i += native_lanes) {
    const Sampler<F> sampler(set, U(0u), U(0u), lane_index<F>() + U(i));
    const auto in = face.sample_lobes<Lobes::transmission>(w, F(0.0f), sampler.get2(U(0u)), TransportMode::importance);
    const F part = in.weight * exp(F(-coat.thickness) / max(abs(in.wi.z), F(1e-10f)));
    for_each_lane(in.valid, [&](int k) { sum += double(lane(part, k)); });
  }
  return sum / points;
}

}  // namespace

std::array<float, terms> series(const CoatParameters& coat, std::uint32_t points) {
  // Near 1 the light of the horizon determines the function, and below there is a critical angle.
  constexpr float min_eta = 1.3f, max_eta = 4;
  const float alpha = coat.alpha.x;
  if (coat.alpha.y != alpha || !(alpha <= max_alpha)) return {none};
  if (!(coat.eta >= min_eta && coat.eta <= max_eta)) return {none};
  if (GgxFacets<float>(alpha, alpha).is_smooth()) return {};
  return chebyshev::interpolation<terms>([&](double x) {
    const float c = unstretched(float(x), alpha);
    return by_facets(c, coat, points) - double(of_smooth(c, coat.eta, coat.thickness));
  });
}

}  // namespace coat_transmittance

}  // namespace montelux
