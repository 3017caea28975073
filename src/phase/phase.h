// Phase functions: how a point of a medium scatters. Directions are unit; wo and wi point away from the vertex. The
// value of a phase function equals the density of its samples: it integrates to 1 over the sphere.
#pragma once
#include <array>
#include <string_view>
#include <tuple>
#include <utility>

#include "phase/henyey_greenstein.h"
#include "phase/rayleigh.h"

namespace montelux {

// The closed set, in the order of PhaseFunctions.
enum class PhaseKind : std::uint32_t { henyey_greenstein, rayleigh };
inline constexpr std::array<std::string_view, 2> phase_names{"henyey-greenstein", "rayleigh"};
template <class F>
using PhaseFunctions = std::tuple<HenyeyGreenstein<F>, Rayleigh<F>>;
static_assert(phase_names.size() == std::tuple_size_v<PhaseFunctions<float>>);

// The phase function of each lane.
template <class F>
struct PhaseFunction {
  Uint<F> kind;  // a PhaseKind
  F parameter;   // what the kind is made from: the mean cosine of Henyey and Greenstein's

  MONTELUX_INLINE Density<SolidAngle, F> evaluate(const Vec3<F>& wo, const Vec3<F>& wi) const {
    Density<SolidAngle, F> value{F(0.0f)};
    for_each_present([&](const auto& phase, Mask<F> same) {
      value.value = select(same, phase.evaluate(wo, wi).value, value.value);
    });
    return value;
  }
  MONTELUX_INLINE PhaseSample<F> sample(const Vec3<F>& wo, Vec2<F> u) const {
    PhaseSample<F> s{wo, {F(0.0f)}};
    for_each_present([&](const auto& phase, Mask<F> same) {
      const PhaseSample<F> own = phase.sample(wo, u);
      s = {select(same, own.wi, s.wi), select(same, own.density, s.density)};
    });
    return s;
  }

 private:
  // Calls f(phase, lanes) once for each kind among the lanes.
  template <class Function>
  MONTELUX_INLINE void for_each_present(Function f) const {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      const auto visit = [&]<std::size_t i>() {
        const Mask<F> same = kind == Uint<F>(std::uint32_t(i));
        if (any(same)) f(std::tuple_element_t<i, PhaseFunctions<F>>(parameter), same);
      };
      (visit.template operator()<I>(), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<PhaseFunctions<F>>>());
  }
};

}  // namespace montelux
