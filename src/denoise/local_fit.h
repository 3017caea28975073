// Lines fitted to the colours around pixels: a pack of pixels at a time.
#pragma once
#include <array>
#include <cstddef>

#include "color/rgb.h"
#include "math/lanes.h"

namespace montelux {

// The value at a pixel of the linear function of features that fits the colours around it best, by weighted least
// squares (Bitterli et al. 2016). It is a weighted mean of those colours y_i: with the weights w_i, and x_i = (1, the
// features less those of the pixel), the colour is the sum of w_i (c . x_i) y_i for the coefficients c of which (sum of
// w_i x_i x_i^T) c = (1, 0, ..., 0). So where the features of the weights do not depend on the colours, the weights do
// not, and sum to 1. The pixel itself, whose weight in the fit is 1, has the weight c_0.
template <class F, std::size_t features, std::size_t channels = rgb_size>
struct LocalFit {
  static constexpr std::size_t unknowns = features + 1;
  static constexpr std::size_t moments = unknowns * (unknowns + 1) / 2;
  using Offsets = std::array<F, features>;  // of the features of another pixel
  using Coefficients = std::array<F, unknowns>;

  std::array<F, moments> moment;                          // of x x^T, row by row up to the diagonal
  std::array<std::array<F, unknowns>, channels> product;  // of x and each channel

  // Slopes are held back by this share of the weight of all pixels: where features hardly differ, they are only noise.
  static constexpr float ridge = 1e-3f;

  // Where the sum of the weights is zero, all coefficients are zero.
  Coefficients coefficients() const {
    // By Cholesky's factors L D L^T.
    const F total = moment[0];
    std::array<std::array<F, unknowns>, unknowns> factor;
    std::array<F, unknowns> diagonal, c;
    const F none = F(0.0f), one = F(1.0f);
    for (std::size_t j = 0; j < unknowns; ++j) {
      for (std::size_t i = 0; i <= j; ++i) {
        F sum = moment[j * (j + 1) / 2 + i];
        if (i == j && j > 0) sum += total * ridge;
        for (std::size_t k = 0; k < i; ++k) sum -= factor[j][k] * diagonal[k] * factor[i][k];
        if (i == j)
          diagonal[j] = sum;
        else
          factor[j][i] = sum * select(diagonal[i] > none, one / diagonal[i], none);
      }
    }
    // Forward, with the first unit vector, and back.
    for (std::size_t j = 0; j < unknowns; ++j) {
      c[j] = j == 0 ? one : none;
      for (std::size_t k = 0; k < j; ++k) c[j] -= factor[j][k] * c[k];
    }
    for (std::size_t j = unknowns; j-- > 0;) {
      c[j] = c[j] * select(diagonal[j] > none, one / diagonal[j], none);
      for (std::size_t k = j + 1; k < unknowns; ++k) c[j] -= factor[k][j] * c[k];
    }
    return c;
  }
  F color(const Coefficients& c, std::size_t channel) const {
    F sum(0.0f);
    for (std::size_t j = 0; j < unknowns; ++j) sum += c[j] * product[channel][j];
    return sum;
  }
};

// c . x, where the coefficients are those at a pixel.
template <class F, std::size_t features>
F weight_by_fit(const std::array<F, features + 1>& c, const std::array<F, features>& offsets) {
  F sum = c[0];
  for (std::size_t j = 0; j < features; ++j) sum += c[j + 1] * offsets[j];
  return sum;
}

}  // namespace montelux
