// Series of Chebyshev polynomials over [0, 1].
#pragma once
#include <array>
#include <cmath>
#include <numbers>

#include "math/lanes.h"

namespace montelux::chebyshev {

// The series that agrees with f(x) at the zeros of the polynomial that follows the last one.
template <std::size_t terms, class Function>
std::array<float, terms> interpolation(const Function& f) {
  const auto angle = [](std::size_t j) { return std::numbers::pi * (double(j) + 0.5) / double(terms); };
  std::array<double, terms> values;
  for (std::size_t j = 0; j < terms; ++j) values[j] = f(0.5 + 0.5 * std::cos(angle(j)));
  std::array<float, terms> result;
  for (std::size_t k = 0; k < terms; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < terms; ++j) sum += values[j] * std::cos(double(k) * angle(j));
    result[k] = float(sum * (k == 0 ? 1 : 2) / double(terms));
  }
  return result;
}

// Its value at x, by Clenshaw's recurrence.
template <class F, std::size_t terms>
MONTELUX_INLINE F value(F x, const std::array<F, terms>& series) {
  const F y = x * 2.0f - F(1.0f), y2 = y + y;
  F next(0.0f), after_next(0.0f);
  for (std::size_t k = terms - 1; k > 0; --k) {
    const F sum = series[k] + (y2 * next - after_next);
    after_next = next, next = sum;
  }
  return series[0] + (y * next - after_next);
}

}  // namespace montelux::chebyshev
