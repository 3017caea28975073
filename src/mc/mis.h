// Multiple importance sampling: weights for samples that several techniques could have made (Veach and Guibas 1995,
// "Optimally Combining Sampling Techniques for Monte Carlo Rendering"). Technique i takes n_i samples of density p_i,
// all densities in one measure; what counts is the product n_i p_i. The weights of all techniques at a point sum to 1.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "mc/density.h"

namespace montelux {

// ---- two techniques, in lanes
// -----------------------------------------------------------------------------------------

// n_i p_i / sum of all; 0 where the technique cannot make the sample.
template <class F>
MONTELUX_INLINE F balance_weight(F own, std::type_identity_t<F> other) {
  return select(own > F(0.0f), F(1.0f) / (F(1.0f) + other / max(own, F(1e-37f))), F(0.0f));
}
// The squares of the products instead.
template <class F>
MONTELUX_INLINE F power_weight(F own, std::type_identity_t<F> other) {
  F ratio = min(other / max(own, F(1e-37f)), F(1e18f));
  return select(own > F(0.0f), F(1.0f) / (F(1.0f) + ratio * ratio), F(0.0f));
}
// With the measure in the type: n_own samples of density `own` against n_other of `other`.
template <class Measure, class F>
MONTELUX_INLINE F balance_weight(F n_own, Density<Measure, F> own, F n_other, Density<Measure, F> other) {
  return balance_weight(n_own * own.value, n_other * other.value);
}
template <class Measure, class F>
MONTELUX_INLINE F power_weight(F n_own, Density<Measure, F> own, F n_other, Density<Measure, F> other) {
  return power_weight(n_own * own.value, n_other * other.value);
}

// One sample of each.
template <class Measure, class F>
MONTELUX_INLINE F balance_weight(Density<Measure, F> own, Density<Measure, F> other) {
  return balance_weight(own.value, other.value);
}
template <class Measure, class F>
MONTELUX_INLINE F power_weight(Density<Measure, F> own, Density<Measure, F> other) {
  return power_weight(own.value, other.value);
}

// ---- any number of techniques
// -------------------------------------------------------------------------------------------

enum class MisHeuristic : std::uint8_t { balance, power, maximum, cutoff };

struct NamedMisHeuristic {
  std::string_view name;
  MisHeuristic heuristic;
  std::string_view description;
};
inline constexpr std::array<NamedMisHeuristic, 4> mis_heuristic_names{{
    {"balance", MisHeuristic::balance, "in proportion to the number of samples times the density"},
    {"power", MisHeuristic::power, "in proportion to the square of that"},
    {"maximum", MisHeuristic::maximum, "all weight on the largest"},
    {"cutoff", MisHeuristic::cutoff, "balance among those of at least a tenth of the largest"},
}};

inline std::optional<MisHeuristic> mis_heuristic_named(std::string_view name) {
  for (const NamedMisHeuristic& entry : mis_heuristic_names)
    if (entry.name == name) return entry.heuristic;
  return std::nullopt;
}

inline constexpr float mis_cutoff = 0.1f;

// The weight of technique i at a point where products[j] = n_j p_j; 0 where products[i] is 0. Ties of the maximum go to
// the first.
template <class F>
F mis_weight(MisHeuristic heuristic, std::span<const F> products, std::size_t i) {
  F largest = products[0];
  for (F p : products) largest = max(largest, p);
  const F scale = F(1.0f) / max(largest, F(1e-37f));
  const auto share = [&](std::size_t j) {
    F x = products[j] * scale;
    switch (heuristic) {
      case MisHeuristic::balance:
        return x;
      case MisHeuristic::power:
        return x * x;
      case MisHeuristic::cutoff:
        return select(x >= F(mis_cutoff), x, F(0.0f));
      case MisHeuristic::maximum:
        break;
    }
    Mask<F> first = products[j] >= largest;
    for (std::size_t k = 0; k < j; ++k) first = first & (products[k] < largest);
    return select(first, F(1.0f), F(0.0f));
  };
  F sum = 0.0f;
  for (std::size_t j = 0; j < products.size(); ++j) sum = sum + share(j);
  return select(products[i] > F(0.0f), share(i) / max(sum, F(1e-37f)), F(0.0f));
}

}  // namespace montelux
