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
LightSet::BeyondChoice<F> LightSet::choose_beyond(Vec3<F> p, Vec3<F> n, F u, const NoFactors&) const {
  const auto unbounded = std::uint32_t(unbounded_.size());
  const F each = unbounded_mass(p, n), front = each * float(unbounded), share = F(1.0f) - front;
  const Mask<F> chosen = Mask<F>(unbounded > 0) & ((u < front) | Mask<F>(bvh_.empty()));
  BeyondChoice<F> r{Uint<F>(0u), each, chosen, share, clamp((u - front) / share, F(0.0f), F(one_minus_epsilon))};
  if (!any(r.chosen)) return r;
  const Uint<F> place = min(to_uint(u / each), Uint<F>(unbounded - 1));
  r.light = gather(unbounded_.data(), select(r.chosen, place, Uint<F>(0u)));
  return r;
}

template <class F>
LightSet::BeyondMass<F> LightSet::beyond_mass(Uint<F>, Vec3<F> p, Vec3<F> n, const NoFactors&) const {
  const F each = unbounded_mass(p, n);
  return {each, F(1.0f) - each * float(unbounded_.size())};
}

template <class F, class Take>
Mask<F> LightSet::for_each_known_mass(Vec3<F> p, Vec3<F> n, const ClusterFactors<F>& factors, Take take) const {
  // In proportion to what each is known to send; a tenth of the choices are equal, since something may not be known.
  constexpr float equal_share = 0.1f;
  const auto unbounded = std::uint32_t(unbounded_.size());
  const auto known = [&](std::uint32_t j) {
    return F(unbounded_irradiances_[j]) * gather(factors.values, Uint<F>(factors.of_whole + Uint<F>(j + 1)));
  };
  const F placed = bvh_.empty() ? F(0.0f) : bvh_.irradiance<F>(p, n) * gather(factors.values, factors.of_whole);
  const Mask<F> has_rest = placed > F(0.0f);
  F sum = placed;
  for (std::uint32_t j = 0; j < unbounded; ++j) sum = sum + known(j);
  const F equal = F(1.0f) / (F(float(unbounded)) + select(has_rest, F(1.0f), F(0.0f)));
  const F scale = F(1 - equal_share) / max(sum, F(1e-37f));
  for (std::uint32_t j = 0; j < unbounded; ++j) take(j, known(j) * scale + equal * equal_share);
  return has_rest;
}

template <class F>
LightSet::BeyondChoice<F> LightSet::choose_beyond(Vec3<F> p, Vec3<F> n, F u, const ClusterFactors<F>& factors) const {
  BeyondChoice<F> r{Uint<F>(0u), F(0.0f), Mask<F>(false), F(1.0f), u};
  if (unbounded_.empty()) return r;
  F front(0.0f), last(0.0f);
  const Mask<F> has_rest = for_each_known_mass(p, n, factors, [&](std::uint32_t j, F mass) {
    front = front + mass, last = mass;
    const Mask<F> takes = (!r.chosen) & (u < front);
    r.light = select(takes, Uint<F>(unbounded_[j]), r.light), r.mass = select(takes, mass, r.mass);
    r.chosen = r.chosen | takes;
  });
  // Where the hierarchy has nothing, rounding may leave a rest.
  const Mask<F> takes = (!r.chosen) & (!has_rest);
  r.light = select(takes, Uint<F>(unbounded_.back()), r.light), r.mass = select(takes, last, r.mass);
  r.chosen = r.chosen | takes;
  r.share = F(1.0f) - front;
  r.u_rest = clamp((u - front) / max(r.share, F(1e-37f)), F(0.0f), F(one_minus_epsilon));
  return r;
}

template <class F>
LightSet::BeyondMass<F> LightSet::beyond_mass(Uint<F> light, Vec3<F> p, Vec3<F> n,
                                              const ClusterFactors<F>& factors) const {
  F own(0.0f), front(0.0f);
  if (!unbounded_.empty())
    for_each_known_mass(p, n, factors, [&](std::uint32_t j, F mass) {
      own = select(light == Uint<F>(unbounded_[j]), mass, own), front = front + mass;
    });
  return {own, F(1.0f) - front};
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
  return clusters_ ? choose_by_clusters(p, n, u, on) : choose_by_bvh(p, n, u, on, NoFactors{});
}

template <class F, class Factors>
LightChoice<F> LightSet::choose_by_bvh(Vec3<F> p, Vec3<F> n, F u, Mask<F> on, const Factors& factors) const {
  const BeyondChoice<F> beyond = choose_beyond(p, n, u, factors);
  LightChoice<F> r{Uint<F>(0u), {F(0.0f)}, Mask<F>(false)};
  if (!bvh_.empty()) {
    r = bvh_.choose(p, n, beyond.u_rest, on & !beyond.chosen, factors);
    r.mass.value = r.mass.value * beyond.share;
  }
  r.light = select(beyond.chosen, beyond.light, r.light);
  r.mass.value = select(beyond.chosen, beyond.mass, r.mass.value);
  r.valid = r.valid | (on & beyond.chosen);
  return r;
}

template <class F>
Mass<F> LightSet::choice_mass(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on) const {
  if (count() == 0) return {F(0.0f)};
  light = select(on, light, Uint<F>(0u));
  if (settings_.selection == LightSelection::uniform) return {F(1.0f / float(count()))};
  if (power_table_) return power_table_->mass<F>(light);
  return clusters_ ? mass_by_clusters(light, p, n, on) : mass_by_bvh(light, p, n, on, NoFactors{});
}

template <class F, class Factors>
Mass<F> LightSet::mass_by_bvh(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on, const Factors& factors) const {
  const Mask<F> unbounded = is_beyond<F>(light, on);
  const BeyondMass<F> beyond = beyond_mass(light, p, n, factors);
  const Mass<F> placed = bvh_.mass(light, p, n, on & !unbounded, factors);
  return {select(unbounded, beyond.of_light, placed.value * beyond.share)};
}

}  // namespace montelux
