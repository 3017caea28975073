// One-dimensional profiles of the separable reconstruction filters. A profile is zero outside [-radius, radius] and
// need not integrate to one.
#pragma once
#include "math/functions.h"

namespace montelux {

// A Gaussian minus its value at the radius, so that it ends at zero.
struct GaussianProfile {
  float radius = 1.5f, sigma = 0.5f;

  template <class F>
  F operator()(F x) const {
    float a = -0.5f / (sigma * sigma);
    return max(exp(x * x * a) - montelux::exp(radius * radius * a), F(0.0f));
  }
};

// The cubic of Mitchell and Netravali 1988 (eq. 8), stretched from [-2, 2] to the radius. Negative in its outer lobes.
struct MitchellProfile {
  float radius = 2.0f, b = 1.0f / 3.0f, c = 1.0f / 3.0f;

  template <class F>
  F operator()(F x) const {
    F t = abs(x) * (2.0f / radius);
    F inner = ((12 - 9 * b - 6 * c) * t + (-18 + 12 * b + 6 * c)) * t * t + (6 - 2 * b);
    F outer = (((-b - 6 * c) * t + (6 * b + 30 * c)) * t + (-12 * b - 48 * c)) * t + (8 * b + 24 * c);
    return select(t >= F(2.0f), F(0.0f), select(t > F(1.0f), outer, inner)) * (1.0f / 6.0f);
  }
};

// sin(pi x) / (pi x) under the Lanczos window sin(pi x / tau) / (pi x / tau), cut off at the radius. Signed.
struct SincProfile {
  float radius = 4.0f, tau = 3.0f;

  template <class F>
  F operator()(F x) const {
    return select(abs(x) > F(radius), F(0.0f), sinc(x) * sinc(x * (1.0f / tau)));
  }

 private:
  template <class F>
  static F sinc(F x) {
    F a = abs(x) * pi;
    // Near zero the series, whose next term is below rounding.
    F series = F(1.0f) - a * a * (1.0f / 6.0f);
    return select(a < F(0.01f), series, sin_cos(a).sin / max(a, F(0.01f)));
  }
};

}  // namespace montelux
