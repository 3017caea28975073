// Gauss-Legendre quadrature over intervals divided into panels.
#pragma once
#include <array>

namespace montelux {

// The integral of f over [a, b] by the five-point rule on each of `panels` equal parts (DLMF table 3.5.2).
template <class Function>
double integrate_panels(double a, double b, int panels, Function f) {
  constexpr std::array<double, 5> x{-0.906179845938663992798, -0.538469310105683091036, 0, 0.538469310105683091036,
                                    0.906179845938663992798};
  constexpr std::array<double, 5> w{0.236926885056189087514, 0.478628670499366468041, 0.568888888888888888889,
                                    0.478628670499366468041, 0.236926885056189087514};
  double half = (b - a) / (2 * panels), sum = 0;
  for (int i = 0; i < panels; ++i)
    for (int k = 0; k < 5; ++k) sum += w[k] * f(a + half * (2 * i + 1 + x[k]));
  return sum * half;
}

}  // namespace montelux
