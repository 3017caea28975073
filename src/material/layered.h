// A surface under a clear coat with a medium in between: a random walk from face to face (Guo, Hasan and Zhao 2018;
// Pharr, Jakob and Humphreys 2023, sec. 14.3).
#pragma once
#include "material/dielectric.h"
#include "material/layer_walk.h"
#include "mc/mis.h"

namespace montelux {

// The slots of every coated model; those of its base start at `base`. Indices of a metallic base are relative to
// that of the coat.
struct LayeredSlots {
  static constexpr int alpha_x = 0, alpha_y = 1, eta = 2, thickness = 3, g = 4, albedo = 5,
                       max_depth = albedo + spectrum_size, samples = max_depth + 1, base = samples + 1;
  static_assert(fill_bsdf_row(base, {{alpha_x, 1},
                                     {alpha_y, 1},
                                     {eta, 1},
                                     {thickness, 1},
                                     {g, 1},
                                     {albedo, spectrum_size},
                                     {max_depth, 1},
                                     {samples, 1}}));
};

// Light enters through the coat, is reflected between base and coat and scattered in the medium, and leaves through the
// coat; both sides of the surface are equal. A walk has up to max_depth events between entry and exit.
//
// evaluate() is an unbiased estimate of f |cos| by `samples` walks from wo that are connected to wi. Directions come
// from the coat's facets and from Lobe, which approximates the directions of light that leaves after reaching the base,
// with exact densities; or from a walk that leaves, whose density is not known. For weights of multiple importance
// sampling beside walks, the density of facets and Lobe replaces it, as a function of (wo, wi). Of Lobe:
//   explicit Lobe(const BsdfRows<F>&): the rows of the whole model;
//   Vec3<F> sample(Vec3<F> wo, F u, Vec2<F> u2): directions of total probability at most 1; below the surface: none;
//   F density(Vec3<F> wo, Vec3<F> wi): their density; greater than zero for all wi above;
//   static constexpr float walks: zero if its directions always replace walks, since they have less noise. Else they do
//     where densities must be exact, and in weights this is the factor of its density: how much less noise walks have
//     than the values of samples of lights. Measured.
template <class F, class Base, class Lobe>
class Layered {
 public:
  static constexpr bool has_reflection = true, has_transmission = false;

  explicit Layered(const BsdfRows<F>& rows)
      : coat_({rows.number(LayeredSlots::alpha_x), rows.number(LayeredSlots::alpha_y)}, rows.number(LayeredSlots::eta)),
        base_(BsdfRows<F>{rows.slots, rows.first + LayeredSlots::base}),
        lobe_(rows),
        medium_{rows.number(LayeredSlots::thickness), rows.number(LayeredSlots::g),
                rows.spectrum(LayeredSlots::albedo)},
        max_depth_(rows.number(LayeredSlots::max_depth)),
        samples_(rows.number(LayeredSlots::samples)) {}

  Mask<F> is_delta() const {
    Mask<F> coat = coat_.is_delta(), base = base_.is_delta(), medium = medium_.has_scatterers();
    return coat & base & !medium;
  }
  BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const;
  BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const;

 protected:
  // With wo above the surface: by a walk, and by directions of known density.
  BsdfSample<F> sample_by_walk(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const;
  BsdfSample<F> sample_by_lobes(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const;
  F density_of_lobes(Vec3<F> wo, Vec3<F> wi, TransportMode mode) const;
  F density_for_weights(Vec3<F> wo, Vec3<F> wi, TransportMode mode) const;
  // Whether walks are sampled; else directions of known density.
  static bool samples_walks(const BsdfContext<F>& context) {
    return Lobe::walks > 0 && context.densities != Densities::exact;
  }
  F coat_share(Vec3<F> wo) const;
  F top_share(Vec3<F> wo) const;
  // Consists only of deltas, except for scattering in the medium.
  Mask<F> is_between_mirrors() const { return coat_.is_delta() & base_.is_delta(); }

  using CoatSample = typename Dielectric<F>::LobeSample;
  using CoatValue = typename Dielectric<F>::LobeValue;

  // The last segment of a walk: from the layers through the coat to wi.
  struct Exit {
    Vec3<F> wi;
    Vec3<F> up;         // a direction of flight in the layers that the coat refracts to wi
    F weight, density;  // what arrives along it, for f |cos|, over its density; zero weight: none was found
    const BsdfContext<F>& context;
  };
  Exit draw_exit(Vec3<F> wi, const WalkDraws<F>& draws, const BsdfContext<F>& context) const;
  Spectrum<F> connected_walk(Vec3<F> wo, const Exit& exit, const WalkDraws<F>& draws, Mask<F> on) const;
  Spectrum<F> meet_base(LayerWalk<F>& walk, const Exit& exit, const WalkDraws<F>& draws, Mask<F> on) const;
  Spectrum<F> meet_medium(LayerWalk<F>& walk, const Exit& exit, const WalkDraws<F>& draws, Mask<F> on) const;
  Spectrum<F> leave_between_mirrors(const LayerWalk<F>& walk, const Exit& exit, int depth, Mask<F> on) const;
  Spectrum<F> leave_by_chance(const LayerWalk<F>& walk, const Exit& exit, F density, Mask<F> on) const;

  Dielectric<F> coat_;
  Base base_;
  Lobe lobe_;
  LayerMedium<F> medium_;
  F max_depth_, samples_;
};

// Independent random numbers for the parts of a call.
enum LayerPurpose : std::uint32_t { evaluation_walk = 11, sampling_walk = 12, albedo_walk = 15 };

MONTELUX_INLINE TransportMode adjoint(TransportMode mode) {
  return mode == TransportMode::radiance ? TransportMode::importance : TransportMode::radiance;
}

template <class F, class Base, class Lobe>
BsdfValue<F> Layered<F, Base, Lobe>::evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const {
  F side = copysign(F(1.0f), wo.z);
  Vec3<F> o = wo * side, i = wi * side;
  Mask<F> delta = is_delta(), same = same_side(o, i), on = context.on & same & !delta;
  if (!any(on)) return {gray(F(0.0f)), {F(0.0f)}};

  Spectrum<F> sum = gray(F(0.0f));
  RandomStream<F> stream = context.random.fork(Uint<F>(evaluation_walk));
  for (int s = 0;; ++s) {
    Mask<F> more = on & (F(float(s)) < samples_);
    if (!any(more)) break;
    WalkDraws<F> draws{stream, std::uint32_t(s) << 16};
    sum += select(more, connected_walk(o, draw_exit(i, draws, context), draws, more), gray(F(0.0f)));
  }
  F coat = coat_.template evaluate_lobes<Lobes::reflection>(o, i, context.mode).f_cos;
  Spectrum<F> value = gray(coat) + sum / max(samples_, F(1.0f));
  const F density =
      samples_walks(context) ? density_for_weights(o, i, context.mode) : density_of_lobes(o, i, context.mode);
  return {select(on, value, gray(F(0.0f))), {select(on, density, F(0.0f))}};
}

template <class F, class Base, class Lobe>
auto Layered<F, Base, Lobe>::draw_exit(Vec3<F> wi, const WalkDraws<F>& draws, const BsdfContext<F>& context) const
    -> Exit {
  CoatSample s = coat_.template sample_lobes<Lobes::transmission>(wi, F(0.0f), draws.pair(2), adjoint(context.mode));
  F weight = s.weight * abs(wi.z) / max(abs(s.wi.z), F(1e-10f));
  return {wi, -s.wi, select(s.valid, weight, F(0.0f)), s.density, context};
}

template <class F, class Base, class Lobe>
Spectrum<F> Layered<F, Base, Lobe>::connected_walk(Vec3<F> wo, const Exit& exit, const WalkDraws<F>& draws,
                                                   Mask<F> on) const {
  const TransportMode mode = exit.context.mode;
  CoatSample entry = coat_.template sample_lobes<Lobes::transmission>(wo, F(0.0f), draws.pair(0), mode);
  LayerWalk<F> walk{entry.wi, gray(entry.weight), medium_.thickness, Mask<F>(on & entry.valid)};
  Spectrum<F> sum = gray(F(0.0f));
  for (int depth = 0;; ++depth) {
    walk.live = walk.live & (F(float(depth)) < max_depth_);
    if (!any(walk.live)) return sum;
    WalkDraws<F> event_draws = draws.event(depth);
    layer_roulette(walk, depth, event_draws.number(0));
    LayerEvent<F> event = medium_.fly(walk, event_draws.number(1));
    if (any(event.scatters)) sum += meet_medium(walk, exit, event_draws, event.scatters);
    if (any(event.at_base)) sum += meet_base(walk, exit, event_draws, event.at_base);
    if (any(event.at_top)) {
      CoatSample s = coat_.template sample_lobes<Lobes::reflection>(-walk.w, F(0.0f), event_draws.pair(3), mode);
      walk.w = select(event.at_top, s.wi, walk.w);
      walk.beta = select(event.at_top, walk.beta * s.weight, walk.beta);
      walk.live = walk.live & (s.valid | !event.at_top);
    }
  }
}

// At the base: the light that reaches wi by the exit sampled before and, through a rough coat, by the direction that
// the base samples; both weighted by the power heuristic.
template <class F, class Base, class Lobe>
Spectrum<F> Layered<F, Base, Lobe>::meet_base(LayerWalk<F>& walk, const Exit& exit, const WalkDraws<F>& draws,
                                              Mask<F> on) const {
  BsdfValue<F> value = base_.evaluate(-walk.w, exit.up, exit.context);
  Mask<F> rough = !coat_.is_delta();
  F share = select(rough, power_weight(exit.density, value.density.value), F(1.0f));
  F arrives = exit.weight * share * medium_.transmittance(medium_.thickness, exit.up);
  Spectrum<F> sum = select(on & (exit.weight > F(0.0f)), walk.beta * value.f_cos * arrives, gray(F(0.0f)));

  BsdfSample<F> s = base_.sample(-walk.w, draws.number(2), draws.pair(3), exit.context);
  walk.w = select(on, s.wi, walk.w);
  walk.beta = select(on, walk.beta * s.weight, walk.beta);
  walk.live = walk.live & (s.valid | !on);
  Mask<F> leaves = on & s.valid & rough;
  if (any(leaves)) sum += leave_by_chance(walk, exit, select(s.delta, F(1e30f), s.density.value), leaves);
  return sum;
}

// The same where the medium scatters.
template <class F, class Base, class Lobe>
Spectrum<F> Layered<F, Base, Lobe>::meet_medium(LayerWalk<F>& walk, const Exit& exit, const WalkDraws<F>& draws,
                                                Mask<F> on) const {
  F phase = henyey_greenstein(dot(walk.w, exit.up), medium_.g);
  Mask<F> rough = !coat_.is_delta();
  F share = select(rough, power_weight(exit.density, phase), F(1.0f));
  F arrives = exit.weight * share * phase * medium_.transmittance(medium_.thickness - walk.z, exit.up);
  Spectrum<F> sum = select(on & (exit.weight > F(0.0f)), walk.beta * medium_.albedo * arrives, gray(F(0.0f)));

  Mask<F> mirrors = on & base_.is_delta() & !rough;
  if (any(mirrors)) sum += leave_between_mirrors(walk, exit, draws.depth, mirrors);

  Vec3<F> before = walk.w;
  medium_.scatter(walk, on, draws.pair(3));
  Mask<F> leaves = on & rough & (walk.w.z > F(0.0f));
  F density = henyey_greenstein(dot(before, walk.w), medium_.g);
  if (any(leaves)) sum += leave_by_chance(walk, exit, density, leaves);
  return sum;
}

// If base and coat are both smooth, no event on them can be connected to wi: the walk is followed from where the
// medium scatters through all reflections, first down or first up, that end in the direction of the exit.
template <class F, class Base, class Lobe>
Spectrum<F> Layered<F, Base, Lobe>::leave_between_mirrors(const LayerWalk<F>& walk, const Exit& exit, int depth,
                                                          Mask<F> on) const {
  const F zero = F(0.0f);
  const Vec3<F> up = exit.up, down{up.x, up.y, -up.z};
  const Spectrum<F> base = base_.sample(-down, zero, {zero, zero}, exit.context).weight;
  const CoatSample coat = coat_.template sample_lobes<Lobes::reflection>(-up, zero, {zero, zero}, exit.context.mode);
  const Spectrum<F> round = base * (coat.weight * medium_.transmittance(2.0f * medium_.thickness, up));

  const Spectrum<F> scattered = walk.beta * medium_.albedo * exit.weight;
  const F way_up = medium_.transmittance(medium_.thickness - walk.z, up);
  const F way_down = medium_.transmittance(medium_.thickness + walk.z, up);
  Spectrum<F> first_up = scattered * (henyey_greenstein(dot(walk.w, up), medium_.g) * way_up);
  Spectrum<F> first_down = scattered * base * (henyey_greenstein(dot(walk.w, down), medium_.g) * way_down);
  Spectrum<F> sum = gray(zero);
  for (int events = depth + 2;; events += 2) {
    Mask<F> more = on & (exit.weight > zero) & (F(float(events)) <= max_depth_);
    if (!any(more)) return sum;
    sum += select(more, first_down, gray(zero));
    first_down *= round, first_up *= round;
    sum += select(more & (F(float(events + 1)) <= max_depth_), first_up, gray(zero));
  }
}

// What a walk that was scattered to walk.w with `density` contributes through the rough coat to wi.
template <class F, class Base, class Lobe>
Spectrum<F> Layered<F, Base, Lobe>::leave_by_chance(const LayerWalk<F>& walk, const Exit& exit, F density,
                                                    Mask<F> on) const {
  const TransportMode mode = exit.context.mode;
  CoatValue out = coat_.template evaluate_lobes<Lobes::transmission>(-walk.w, exit.wi, mode);
  CoatValue back = coat_.template evaluate_lobes<Lobes::transmission>(exit.wi, -walk.w, adjoint(mode));
  F share = power_weight(density, back.density);
  F arrives = out.f_cos * share * medium_.transmittance(medium_.thickness - walk.z, walk.w);
  return select(on, walk.beta * arrives, gray(F(0.0f)));
}

template <class F, class Base, class Lobe>
BsdfSample<F> Layered<F, Base, Lobe>::sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
  const F side = copysign(F(1.0f), wo.z);
  BsdfSample<F> s =
      samples_walks(context) ? sample_by_walk(wo * side, u, u2, context) : sample_by_lobes(wo * side, u, u2, context);
  s.wi = s.wi * side;
  return s;
}

// The probability with which a direction is reflected by the coat. What a coat mirrors may be bright, though it
// reflects little.
template <class F, class Base, class Lobe>
F Layered<F, Base, Lobe>::coat_share(Vec3<F> wo) const {
  return min(max(fresnel_dielectric(wo.z, coat_.eta()), F(0.1f)), F(0.75f));
}

// The probability with which sample_by_lobes() uses the coat or, if everything is smooth, the walks that meet only
// deltas.
template <class F, class Base, class Lobe>
F Layered<F, Base, Lobe>::top_share(Vec3<F> wo) const {
  const Mask<F> mirrors = is_between_mirrors(), delta = is_delta();
  return select(delta, F(1.0f), select(mirrors, F(0.5f), coat_share(wo)));
}

template <class F, class Base, class Lobe>
F Layered<F, Base, Lobe>::density_of_lobes(Vec3<F> wo, Vec3<F> wi, TransportMode mode) const {
  const F coat = coat_.template evaluate_lobes<Lobes::reflection>(wo, wi, mode).density;
  return lerp(top_share(wo), lobe_.density(wo, wi), coat);
}

template <class F, class Base, class Lobe>
F Layered<F, Base, Lobe>::density_for_weights(Vec3<F> wo, Vec3<F> wi, TransportMode mode) const {
  const F coat = coat_.template evaluate_lobes<Lobes::reflection>(wo, wi, mode).density;
  return lerp(coat_share(wo), lobe_.density(wo, wi) * Lobe::walks, coat);
}

template <class F, class Base, class Lobe>
BsdfSample<F> Layered<F, Base, Lobe>::sample_by_lobes(Vec3<F> wo, F u, Vec2<F> u2,
                                                      const BsdfContext<F>& context) const {
  const F share = top_share(wo);
  const Mask<F> by_top = u < share, delta = by_top & coat_.is_delta(),
                walks = context.on & by_top & is_between_mirrors();
  const F rest = min(select(by_top, u / share, (u - share) / max(F(1.0f) - share, F(1e-6f))), F(one_minus_epsilon));
  const CoatSample facet = coat_.template sample_lobes<Lobes::reflection>(wo, F(0.0f), u2, context.mode);
  const Vec3<F> wi = select(by_top, facet.wi, lobe_.sample(wo, rest, u2));
  const Mask<F> good = context.on & (wi.z > F(0.0f)) & (facet.valid | !by_top);
  BsdfSample<F> s{wi, gray(facet.weight / share), {F(0.0f)}, F(1.0f), good, delta};
  if (any(walks)) {
    const BsdfSample<F> walked = sample_by_walk(wo, rest, u2, context.in(walks));
    s.wi = select(walks, walked.wi, s.wi);
    s.weight = select(walks, walked.weight / share, s.weight);
    s.valid = (s.valid & !walks) | (walks & walked.valid & walked.delta);
  }
  if (const Mask<F> spread = s.valid & !delta; any(spread)) {
    const BsdfValue<F> v = evaluate(wo, s.wi, context.in(spread));
    const Mask<F> has_density = v.density.value > F(0.0f);
    s.density = v.density;
    s.weight = select(spread, v.f_cos * (F(1.0f) / select(has_density, v.density.value, F(1.0f))), s.weight);
    s.valid = s.valid & (delta | has_density);
  }
  return s;
}

template <class F, class Base, class Lobe>
BsdfSample<F> Layered<F, Base, Lobe>::sample_by_walk(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
  const F share = coat_share(wo);
  const Mask<F> by_coat = u < share;
  const CoatSample mirrored = coat_.template sample_lobes<Lobes::reflection>(wo, F(0.0f), u2, context.mode);
  CoatSample entry = coat_.template sample_lobes<Lobes::transmission>(wo, F(0.0f), u2, context.mode);
  entry.wi = select(by_coat, mirrored.wi, entry.wi);
  entry.weight = select(by_coat, mirrored.weight / share, entry.weight / (F(1.0f) - share));
  entry.valid = (mirrored.valid & by_coat) | (entry.valid & !by_coat);
  Mask<F> left = context.on & entry.valid & (entry.wi.z > F(0.0f));
  LayerWalk<F> walk{entry.wi, gray(entry.weight), medium_.thickness, Mask<F>(context.on & entry.valid & !left)};
  Mask<F> delta = coat_.is_delta();
  WalkDraws<F> draws{context.random.fork(Uint<F>(sampling_walk))};
  // One event more than max_depth, only for the way out through the coat.
  for (int depth = 0;; ++depth) {
    walk.live = walk.live & (F(float(depth)) <= max_depth_);
    if (!any(walk.live)) break;
    WalkDraws<F> event_draws = draws.event(depth);
    layer_roulette(walk, depth, event_draws.number(0));
    LayerEvent<F> event = medium_.fly(walk, event_draws.number(1));
    delta = delta & !event.scatters;
    if (any(event.scatters)) medium_.scatter(walk, event.scatters, event_draws.pair(3));
    if (any(event.at_base)) {
      BsdfSample<F> s = base_.sample(-walk.w, event_draws.number(2), event_draws.pair(3), context);
      walk.w = select(event.at_base, s.wi, walk.w);
      walk.beta = select(event.at_base, walk.beta * s.weight, walk.beta);
      walk.live = walk.live & (s.valid | !event.at_base);
      delta = delta & (s.delta | !event.at_base);
    }
    if (any(event.at_top)) {
      CoatSample s =
          coat_.template sample_lobes<Lobes::both>(-walk.w, event_draws.number(2), event_draws.pair(3), context.mode);
      walk.w = select(event.at_top, s.wi, walk.w);
      walk.beta = select(event.at_top, walk.beta * s.weight, walk.beta);
      Mask<F> leaves = event.at_top & s.valid & (s.wi.z > F(0.0f));
      left = left | leaves;
      walk.live = walk.live & (s.valid | !event.at_top) & !leaves;
    }
  }
  F density = F(0.0f);
  Mask<F> smooth = left & !delta;
  if (any(smooth)) density = density_for_weights(wo, walk.w, context.mode);
  return {walk.w, walk.beta, {density}, F(1.0f), left, delta};
}

}  // namespace montelux
