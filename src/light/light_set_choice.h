// The choice of a light: implementation of LightSet's templates.
#pragma once
#include "light/light_set.h"

namespace montelux {

template <class F>
Mask<F> LightSet::is_beyond(Uint<F> light, Mask<F> on) const {
  const Uint<F> kinds = gather(tables_.kinds.data(), select(on, light, Uint<F>(0u)));
  return on & (kinds >= Uint<F>(std::uint32_t(LightKind::distant)));
}

template <class F>
F LightSet::unbounded_mass(Vec3<F> p, Vec3<F> n) const {
  // Equal for all lights without a place and for the hierarchy as a whole, as in pbrt; less where the hierarchy's
  // lights are brighter, but not less than a third, since they may be hidden. All of it where none of those emits to p.
  constexpr float min_of_equal = 1.0f / 3.0f;
  const F equal(equal_mass_);
  if (unbounded_.empty() || bvh_.empty()) return equal;
  const F placed = bvh_.irradiance<F>(p, n), sum = max(placed + unbounded_irradiance_, F(1e-37f));
  const F number(float(unbounded_.size()));
  const F mass = clamp(F(unbounded_irradiance_) / (sum * number), equal * min_of_equal, equal);
  return select(placed > F(0.0f), mass, F(1.0f) / number);
}

template <class F>
LightChoice<F> LightSet::choose(Vec3<F> p, Vec3<F> n, F u, Mask<F> on) const {
  if (count() == 0) return {Uint<F>(0u), {F(0.0f)}, Mask<F>(false)};
  if (settings_.selection == LightSelection::uniform) {
    Uint<F> light = min(to_uint(u * float(count())), Uint<F>(count() - 1));
    return {light, {F(1.0f / float(count()))}, on};
  }
  if (power_table_) {
    DiscreteSample<F> s = power_table_->sample(u);
    return {s.index, s.mass, on};
  }
  // Unbounded lights have equal shares at the start of [0, 1); the hierarchy has the rest.
  auto unbounded = std::uint32_t(unbounded_.size());
  const F each = unbounded_mass(p, n), front = each * float(unbounded);
  Mask<F> among_unbounded = Mask<F>(unbounded > 0) & ((u < front) | Mask<F>(bvh_.empty()));
  LightChoice<F> r{Uint<F>(0u), {F(0.0f)}, Mask<F>(false)};
  if (!bvh_.empty()) {
    F share = F(1.0f) - front;
    F rest = clamp((u - front) / share, F(0.0f), F(one_minus_epsilon));
    const Mask<F> among_placed = on & !among_unbounded;
    r = clusters_ ? choose_by_clusters(p, n, rest, among_placed) : bvh_.choose(p, n, rest, among_placed);
    r.mass.value = r.mass.value * share;
  }
  if (any(on & among_unbounded)) {
    Uint<F> place = min(to_uint(u / each), Uint<F>(unbounded - 1));
    Uint<F> light = gather(unbounded_.data(), select(among_unbounded, place, Uint<F>(0u)));
    r.light = select(among_unbounded, light, r.light);
    r.mass.value = select(among_unbounded, each, r.mass.value);
    r.valid = r.valid | (on & among_unbounded);
  }
  return r;
}

template <class F>
Mass<F> LightSet::choice_mass(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on) const {
  if (count() == 0) return {F(0.0f)};
  light = select(on, light, Uint<F>(0u));
  if (settings_.selection == LightSelection::uniform) return {F(1.0f / float(count()))};
  if (power_table_) return power_table_->mass<F>(light);
  Mask<F> unbounded = is_beyond<F>(light, on);
  const F each = unbounded_mass(p, n), share = F(1.0f) - each * float(unbounded_.size());
  const Mask<F> placed = on & !unbounded;
  const Mass<F> bounded = clusters_ ? mass_by_clusters(light, p, n, placed) : bvh_.mass(light, p, n, placed);
  return {select(unbounded, each, bounded.value * share)};
}

}  // namespace montelux
