// Genz's six families of integrands on the unit cube with their closed forms (Genz 1984, "Testing Multidimensional
// Integration Routines"; difficulties of Genz 1987, "A Package for Testing Multiple Integration Subroutines").
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include "lab/integral/integrand.h"
#include "mc/random.h"

namespace montelux::test {

enum class GenzFamily : std::uint8_t { oscillatory, product_peak, corner_peak, gaussian, c0, discontinuous };
inline constexpr std::array<GenzFamily, 6> genz_families{GenzFamily::oscillatory, GenzFamily::product_peak,
                                                         GenzFamily::corner_peak, GenzFamily::gaussian,
                                                         GenzFamily::c0,          GenzFamily::discontinuous};
inline constexpr std::array<std::string_view, 6> genz_names{"oscillatory", "product peak", "corner peak",
                                                            "Gaussian",    "C0",           "discontinuous"};
inline std::string_view name_of(GenzFamily family) { return genz_names[std::size_t(family)]; }

// One integrand: `a` says how hard it is in each coordinate, `w` where its feature lies.
struct Genz {
  GenzFamily family;
  std::vector<double> a, w;

  std::size_t dimension() const { return a.size(); }

  // Random parameters: w uniform in (0, 1), a uniform and then scaled to the family's difficulty h / d^e.
  static Genz make(GenzFamily family, std::size_t dimension, std::uint32_t seed) {
    constexpr std::array<double, 6> h{110, 600, 600, 100, 150, 100}, e{1.5, 2, 2, 1, 2, 2};
    RandomStream<float> stream(seed, std::uint32_t(family) * 131u + std::uint32_t(dimension));
    Genz g{family, {}, {}};
    double sum = 0;
    for (std::size_t d = 0; d < dimension; ++d) {
      g.a.push_back(0.05 + 0.95 * double(stream.next())), g.w.push_back(double(stream.next()));
      sum += g.a.back();
    }
    const double wanted = h[std::size_t(family)] / std::pow(double(dimension), e[std::size_t(family)]);
    for (double& x : g.a) x *= wanted / sum;
    return g;
  }

  double operator()(const double* x) const {
    const std::size_t n = dimension();
    double s = 0, p = 1;
    switch (family) {
      case GenzFamily::oscillatory:
        for (std::size_t d = 0; d < n; ++d) s += a[d] * x[d];
        return std::cos(2 * std::numbers::pi * w[0] + s);
      case GenzFamily::product_peak:
        for (std::size_t d = 0; d < n; ++d) p *= 1 / (a[d] * a[d]) + (x[d] - w[d]) * (x[d] - w[d]);
        return 1 / p;
      case GenzFamily::corner_peak: {
        s = 1;
        for (std::size_t d = 0; d < n; ++d) s += a[d] * x[d];
        for (std::size_t d = 0; d <= n; ++d) p *= s;
        return 1 / p;
      }
      case GenzFamily::gaussian:
        for (std::size_t d = 0; d < n; ++d) s += a[d] * a[d] * (x[d] - w[d]) * (x[d] - w[d]);
        return std::exp(-s);
      case GenzFamily::c0:
        for (std::size_t d = 0; d < n; ++d) s += a[d] * std::abs(x[d] - w[d]);
        return std::exp(-s);
      case GenzFamily::discontinuous:
        break;
    }
    for (std::size_t d = 0; d < std::min<std::size_t>(2, n); ++d)
      if (x[d] > w[d]) return 0;
    for (std::size_t d = 0; d < n; ++d) s += a[d] * x[d];
    return std::exp(s);
  }

  // The same function of many points, axis by axis.
  void operator()(lab::PointBatch x, std::span<double> v) const {
    const std::size_t n = dimension(), count = x.count;
    double* __restrict out = v.data();
    const auto start = [&](double c) {
      for (std::size_t i = 0; i < count; ++i) out[i] = c;
    };
    const auto each_axis = [&](auto f) {
      for (std::size_t d = 0; d < n; ++d) {
        const double* __restrict y = x.coordinates.data() + d * count;
        const double ad = a[d], wd = w[d];
        for (std::size_t i = 0; i < count; ++i) out[i] = f(out[i], y[i], ad, wd);
      }
    };
    const auto finish = [&](auto f) {
      for (std::size_t i = 0; i < count; ++i) out[i] = f(out[i]);
    };
    switch (family) {
      case GenzFamily::oscillatory:
        start(2 * std::numbers::pi * w[0]);
        each_axis([](double s, double y, double ad, double) { return s + ad * y; });
        return finish([](double s) { return std::cos(s); });
      case GenzFamily::product_peak:
        start(1);
        each_axis([](double p, double y, double ad, double wd) { return p * (1 / (ad * ad) + (y - wd) * (y - wd)); });
        return finish([](double p) { return 1 / p; });
      case GenzFamily::corner_peak:
        start(1);
        each_axis([](double s, double y, double ad, double) { return s + ad * y; });
        return finish([n](double s) {
          double p = 1;
          for (std::size_t d = 0; d <= n; ++d) p *= s;
          return 1 / p;
        });
      case GenzFamily::gaussian:
        start(0);
        each_axis([](double s, double y, double ad, double wd) { return s + ad * ad * (y - wd) * (y - wd); });
        return finish([](double s) { return std::exp(-s); });
      case GenzFamily::c0:
        start(0);
        each_axis([](double s, double y, double ad, double wd) { return s + ad * std::abs(y - wd); });
        return finish([](double s) { return std::exp(-s); });
      case GenzFamily::discontinuous:
        break;
    }
    start(0);
    each_axis([](double s, double y, double ad, double) { return s + ad * y; });
    for (std::size_t i = 0; i < count; ++i) {
      bool outside = false;
      for (std::size_t d = 0; d < std::min<std::size_t>(2, n); ++d) outside |= x[d][i] > w[d];
      out[i] = outside ? 0 : std::exp(out[i]);
    }
  }

  double integral() const {
    const std::size_t n = dimension();
    double p = 1, s = 0;
    switch (family) {
      case GenzFamily::oscillatory:
        for (double ad : a) p *= 2 * std::sin(0.5 * ad) / ad, s += 0.5 * ad;
        return p * std::cos(2 * std::numbers::pi * w[0] + s);
      case GenzFamily::product_peak:
        for (std::size_t d = 0; d < n; ++d) p *= a[d] * (std::atan(a[d] * (1 - w[d])) + std::atan(a[d] * w[d]));
        return p;
      case GenzFamily::corner_peak: {
        // Inclusion and exclusion over the corners of the cube.
        for (std::uint32_t corner = 0; corner < 1u << n; ++corner) {
          double at = 1;
          for (std::size_t d = 0; d < n; ++d) at += corner >> d & 1u ? a[d] : 0;
          s += (std::popcount(corner) % 2 == 0 ? 1 : -1) / at;
        }
        for (std::size_t d = 0; d < n; ++d) p *= a[d] * double(d + 1);
        return s / p;
      }
      case GenzFamily::gaussian:
        for (std::size_t d = 0; d < n; ++d)
          p *= std::sqrt(std::numbers::pi) / (2 * a[d]) * (std::erf(a[d] * (1 - w[d])) + std::erf(a[d] * w[d]));
        return p;
      case GenzFamily::c0:
        for (std::size_t d = 0; d < n; ++d) p *= (2 - std::exp(-a[d] * w[d]) - std::exp(-a[d] * (1 - w[d]))) / a[d];
        return p;
      case GenzFamily::discontinuous:
        break;
    }
    for (std::size_t d = 0; d < n; ++d) p *= std::expm1(a[d] * (d < 2 ? w[d] : 1.0)) / a[d];
    return p;
  }

  lab::Integrand integrand() const {
    return {dimension(), [g = *this](lab::PointBatch x, std::span<double> v) { g(x, v); }};
  }
};

}  // namespace montelux::test
