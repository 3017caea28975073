// What is known of a coat before the render: integrals over its facets.
#pragma once
#include <array>

#include "material/fresnel.h"
#include "math/chebyshev.h"
#include "mc/microfacet.h"

namespace montelux {

// A coat over an absorbing layer: the coat's facets and index, and the layer's thickness times extinction.
struct CoatParameters {
  Roughness<float> alpha;
  float eta, thickness;
};

// The fraction of light leaving the base by Lambert's law that returns to the base after one reflection at the
// coat. By quadrature with 2^16 points, relative error below 1e-3.
float internal_reflectance(const CoatParameters& coat);

// The transmittance of a coat, as a function of the cosine of the direction with the normal: that of a smooth coat plus
// a series of Chebyshev polynomials in a variable that stretches the directions near the horizon, where roughness
// matters most. Without factor of the indices: that of importance.
namespace coat_transmittance {

inline constexpr int terms = 10;
inline constexpr float max_alpha = 0.6f;
// The first term where there is no series. (Transmittances differ by less than 1.)
inline constexpr float none = 2;

// None if the facets have a direction, if alpha exceeds max_alpha, or if the index is not in [1.3, 4]. Else the
// absolute error is below 5e-4 where the cosine is above 0.02, elsewhere below 2e-3, and on average over the cosines
// below 1.5e-4. By quadrature with this many points for each term.
std::array<float, terms> series(const CoatParameters& coat, std::uint32_t points = 1u << 13);

// Of light from a direction of cosine c > 0 the part that passes a smooth coat and, once, the layer.
template <class F>
MONTELUX_INLINE F of_smooth(F c, F eta, F thickness) {
  const F sin2_t = (F(1.0f) - c * c) / (eta * eta);
  const F entering = F(1.0f) - fresnel_dielectric(c, eta);
  return entering * exp(-thickness / max(safe_sqrt(F(1.0f) - sin2_t), F(1e-10f)));
}

// The variable of the series, which grows from 0 at the horizon to 1, and its inverse.
template <class F>
MONTELUX_INLINE F stretch(F alpha) {
  return min(alpha * 2.0f + 0.01f, F(0.2f));
}
template <class F>
MONTELUX_INLINE F stretched(F c, F alpha) {
  return c * (F(1.0f) + stretch(alpha)) / (c + stretch(alpha));
}
template <class F>
MONTELUX_INLINE F unstretched(F x, F alpha) {
  return x * stretch(alpha) / (F(1.0f) + stretch(alpha) - x);
}

// At the cosine c > 0, of a coat whose facets have the roughness alpha in both directions.
template <class F>
MONTELUX_INLINE F at(F c, F alpha, F eta, F thickness, const std::array<F, terms>& series) {
  return of_smooth(c, eta, thickness) + chebyshev::value(stretched(c, alpha), series);
}

}  // namespace coat_transmittance

}  // namespace montelux
