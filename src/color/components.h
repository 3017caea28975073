// Arithmetic on a few numbers of the same kind, component by component: for what a path carries (spectrum.h) and for
// colours that are stored or shown (rgb.h). The two are different types, so that none becomes the other unnoticed.
#pragma once
#include <concepts>

#include "math/functions.h"

namespace montelux {

// How many components C<F> has; 0 of a template that is not for components.
template <template <class> class C>
inline constexpr int component_count = 0;

template <class T>
inline constexpr bool is_componentwise = false;
template <template <class> class C, class F>
inline constexpr bool is_componentwise<C<F>> = component_count<C> > 0;
template <class T>
concept Componentwise = is_componentwise<T>;

// Applies f to each component of the arguments.
template <class Function, class F, template <class> class C, std::same_as<C<F>>... Others>
requires Componentwise<C<F>> MONTELUX_INLINE C<F> per_component(Function f, const C<F>& a, const Others&... others) {
  C<F> r;
  for (int i = 0; i < component_count<C>; ++i) r.c[i] = f(a.c[i], others.c[i]...);
  return r;
}

// clang-format off
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F> operator+(C<F> a, C<F> b) { return per_component([](F x, F y) { return x + y; }, a, b); }
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F> operator-(C<F> a, C<F> b) { return per_component([](F x, F y) { return x - y; }, a, b); }
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F> operator*(C<F> a, C<F> b) { return per_component([](F x, F y) { return x * y; }, a, b); }
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F> operator*(C<F> a, std::type_identity_t<F> s) { return per_component([s](F x) { return x * s; }, a); }
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F> operator*(std::type_identity_t<F> s, C<F> a) { return a * s; }
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F> operator/(C<F> a, std::type_identity_t<F> s) { return per_component([s](F x) { return x / s; }, a); }
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F>& operator+=(C<F>& a, C<F> b) { return a = a + b; }
template <class F, template <class> class C> requires Componentwise<C<F>>
MONTELUX_INLINE C<F>& operator*=(C<F>& a, C<F> b) { return a = a * b; }
// clang-format on

template <class F, template <class> class C>
requires Componentwise<C<F>> MONTELUX_INLINE C<F> select(Mask<F> m, C<F> a, C<F> b) {
  C<F> r;
  for (int i = 0; i < component_count<C>; ++i) r.c[i] = select(m, a.c[i], b.c[i]);
  return r;
}
template <class F, template <class> class C>
requires Componentwise<C<F>> MONTELUX_INLINE F max_component(const C<F>& a) {
  F r = a.c[0];
  for (int i = 1; i < component_count<C>; ++i) r = max(r, a.c[i]);
  return r;
}
template <class F, template <class> class C>
requires Componentwise<C<F>> MONTELUX_INLINE F average(const C<F>& a) {
  F r = a.c[0];
  for (int i = 1; i < component_count<C>; ++i) r = r + a.c[i];
  return r * (1.0f / component_count<C>);
}
template <class F, template <class> class C>
requires Componentwise<C<F>> MONTELUX_INLINE Mask<F> is_black(const C<F>& a) { return max_component(a) <= F(0.0f); }
// The same constant in every lane.
template <class F, template <class> class C>
requires Componentwise<C<F>> MONTELUX_INLINE C<F> splat(const C<float>& a) {
  C<F> r;
  for (int i = 0; i < component_count<C>; ++i) r.c[i] = F(a.c[i]);
  return r;
}
template <class F, template <class> class C>
requires Componentwise<C<F>> MONTELUX_INLINE C<float> lane(const C<F>& a, int k) {
  C<float> r;
  for (int i = 0; i < component_count<C>; ++i) r.c[i] = lane(a.c[i], k);
  return r;
}
template <class F, template <class> class C>
requires Componentwise<C<F>> MONTELUX_INLINE void set_lane(C<F>& a, int k, const std::type_identity_t<C<float>>& x) {
  for (int i = 0; i < component_count<C>; ++i) set_lane(a.c[i], k, x.c[i]);
}

}  // namespace montelux
