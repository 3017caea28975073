// Probability densities whose type states their measure. Only a named function converts to another measure.
#pragma once
#include "math/functions.h"

namespace montelux {

// Measures. A density is per unit of its measure.
struct Length {};               // per unit of a real line, or of [0, 1)
struct Area {};                 // per unit area: square scene units on a surface, or of a plane domain such as [0, 1)^2
struct SolidAngle {};           // per steradian
struct ProjectedSolidAngle {};  // per steradian weighted by |cos| to the surface normal
struct Volume {};               // per unit volume, or of a cube

// p(x) with respect to Measure, in every lane. Zero: the point cannot be sampled.
template <class Measure, class F = float>
struct Density {
  F value;
};

// Probability of a discrete outcome: an element of a set, or a direction drawn from a delta distribution.
template <class F = float>
struct Mass {
  F value;
};

// dA = dw d^2 / |cos|: `distance_squared` between the two points, `cos` at the surface where the area lies.
template <class F>
MONTELUX_INLINE Density<Area, F> to_area(Density<SolidAngle, F> p, F distance_squared, F cos) {
  return {p.value * abs(cos) / distance_squared};
}
// The inverse of to_area; zero where the surface is seen edge-on.
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> to_solid_angle(Density<Area, F> p, F distance_squared, F cos) {
  F c = abs(cos);
  return {select(c > F(0.0f), p.value * distance_squared / max(c, F(1e-30f)), F(0.0f))};
}
template <class F>
MONTELUX_INLINE Density<SolidAngle, F> to_solid_angle(Density<ProjectedSolidAngle, F> p, F cos) {
  return {p.value * abs(cos)};
}
// A value of an integrand over the density with which its point was drawn: an estimate of the integral, if the value is
// per unit of the same measure.
template <class Measure, class F>
MONTELUX_INLINE F operator/(F value, Density<Measure, F> p) {
  return value / p.value;
}
// The ratio of two densities at one point.
template <class Measure, class F>
MONTELUX_INLINE F operator/(Density<Measure, F> a, Density<Measure, F> b) {
  return a.value / b.value;
}
// Of `number` points together, each drawn with the density; or of points that count that much.
template <class Measure, class F>
MONTELUX_INLINE Density<Measure, F> operator*(F number, Density<Measure, F> p) {
  return {number * p.value};
}
template <class Measure, class F>
MONTELUX_INLINE Density<Measure, F> select(Mask<F> m, Density<Measure, F> a, Density<Measure, F> b) {
  return {select(m, a.value, b.value)};
}
// A discrete choice, then a point with the density.
template <class Measure, class F>
MONTELUX_INLINE Density<Measure, F> operator*(Mass<F> choice, Density<Measure, F> p) {
  return {choice.value * p.value};
}

}  // namespace montelux
