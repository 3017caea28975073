// Weights of bidirectional strategies by recursion along both subpaths (Georgiev, Krivanek, Davidovic and Slusallek
// 2012, "Light Transport Simulation with Vertex Connection and Merging", and its technical report; van Antwerpen 2011).
//
// A path with the vertices x_0 (at a light) ... x_k (at the lens) can be found by connecting any s of its first
// vertices, drawn from the light, with the others, drawn from the eye; by merging it is found where both subpaths have
// drawn the same vertex except for a small distance. The weight of a strategy is mis(n p) over the sum of mis(n p) of
// all strategies, with their densities p and numbers of samples n; mis(x) = x, or x^2. The sum falls into the
// strategies with fewer vertices from the light and those with fewer from the eye, each relative to the one at hand,
// and each subpath carries what its own vertices contribute. These densities exclude roulette: what survives it
// counts accordingly more in every strategy, so the weights still sum to one.
#pragma once
#include "mc/density.h"

namespace montelux {

// What a subpath carries at a vertex. Multiplied by what depends on the next vertex of the other side: `vcm` stands for
// the strategy that replaces this vertex's own draw, `vc` for connections and `vm` for mergings further back.
template <class F>
struct PartialWeights {
  F vcm, vc, vm;
};
template <class F>
MONTELUX_INLINE PartialWeights<F> select_weights(Mask<F> m, const PartialWeights<F>& a, const PartialWeights<F>& b) {
  return {select(m, a.vcm, b.vcm), select(m, a.vc, b.vc), select(m, a.vm, b.vm)};
}

// A measure: the light's own, which is area on a surface, solid angle for light from beyond the scene, and the choice
// itself for a delta light; times area across the segment that starts there.
struct LightAndArea {};
// The end of a path at a light, as the next vertex sees it.
template <class F>
struct LightEnd {
  // By light sampling at the next vertex, the choice included; of a delta light the probability of its choice.
  Density<SolidAngle, F> sampled;
  Density<LightAndArea, F> emitted;  // by a path that starts there
  F solid_angle;                     // at the next vertex, over the light's own measure: cos / distance^2 on a surface
  Mask<F> delta;
};

// How a vertex scatters between the two segments that meet there: the densities with which it draws the direction of
// the one from the other.
template <class F>
struct BothDensities {
  Density<SolidAngle, F> forward;  // of the direction that leads on
  Density<SolidAngle, F> reverse;  // of the direction in which the subpath came
  Mask<F> merges = Mask<F>(true);  // the vertex may be merged with others: it is on a surface
};

// All cosines are those of geometric normals, absolute; 1 at vertices in media, whose densities are per volume.
//
// In media a subpath also draws the distance to its next vertex. The extinction there is a factor of both draws of a
// vertex and cancels, and the transmittance of a segment is a factor of every strategy but the one that connects its
// ends. So what is relative to a connection along one segment counts with the probability `passing` of no event along
// it, and the connection itself, as seen from other strategies, with one over it. `passing` is averaged over colour
// components: any function of the path gives weights that sum to one.
class StrategyWeights {
 public:
  // `power`: mis(x) = x^2. `merges`: the number of light paths that merge with a vertex times the area over which they
  // do; 0: none does. `connects`: whether there are connections beside mergings.
  explicit StrategyWeights(bool power, float merges = 0, bool connects = true)
      : power_(power),
        merging_(merges > 0 ? mis(merges) : 0),
        connecting_(merges > 0 && connects ? mis(1 / merges) : 0) {}

  // ---- along a subpath

  // The first vertex behind the lens, which sees so many pixels per area across the segment; each pixel has one path
  // from the eye, and `light_paths` are connected with the lens (0: none).
  template <class F>
  PartialWeights<F> first_from_lens(Density<Area, F> pixels, F cos, float light_paths, F passing = F(1.0f)) const {
    return {limited(mis(F(light_paths) / (pixels.value * not_zero(cos))) * unless_it_passes(passing)), F(0.0f),
            F(0.0f)};
  }
  // The first vertex behind a light.
  template <class F>
  PartialWeights<F> first_from_light(const LightEnd<F>& end, F cos, F passing = F(1.0f)) const {
    const F drawn = F(1.0f) / max(end.emitted.value * not_zero(cos), F(1e-30f));
    const F by_light_sampling = end.sampled.value * select(end.delta, F(1.0f), end.solid_angle);
    const F vc = select(end.delta, F(0.0f), mis(end.solid_angle * drawn));
    return limited(PartialWeights<F>{mis(by_light_sampling * drawn) * unless_it_passes(passing), vc, vc * connecting_});
  }
  // The subpath leaves a vertex in a direction whose cosine is `cos`; where the event is a delta, the densities do not
  // matter. What is returned is to be given to arrive().
  template <class F>
  PartialWeights<F> scatter(const PartialWeights<F>& w, const BothDensities<F>& p, F cos, Mask<F> delta) const {
    const F drawn = F(1.0f) / max(p.forward.value, F(1e-30f));
    const F onward = mis(cos * drawn), straight = mis(cos);
    const F here = select(p.merges, F(1.0f), F(0.0f));
    const F merged = limited(w.vm * mis(p.reverse.value) + w.vcm * connecting_ + here);
    return limited(PartialWeights<F>{select(delta, F(0.0f), mis(drawn)),
                                     select(delta, w.vc * straight, onward * behind(w, p)),
                                     select(delta, w.vm * straight, onward * merged)});
  }
  // The subpath arrives at the next vertex.
  template <class F>
  PartialWeights<F> arrive(const PartialWeights<F>& w, F distance_squared, F cos, F passing = F(1.0f)) const {
    const F over_cos = mis(F(1.0f) / not_zero(cos));
    return limited(PartialWeights<F>{w.vcm * mis(distance_squared) * over_cos * unless_it_passes(passing),
                                     w.vc * over_cos, w.vm * over_cos});
  }

  // ---- weights of strategies

  // The eye's subpath meets a light; `w` is what scatter() gave.
  template <class F>
  F met(const PartialWeights<F>& w, const LightEnd<F>& end, F passing = F(1.0f)) const {
    const F emitted = end.emitted.value / max(end.solid_angle, F(1e-30f));
    return share(limited(mis(end.sampled.value) * w.vcm * unless_it_passes(passing)) + mis(emitted) * w.vc);
  }
  // A vertex of the eye's subpath is connected with a light drawn there.
  template <class F>
  F light_sample(const PartialWeights<F>& eye, const LightEnd<F>& end, const BothDensities<F>& at_eye, F cos,
                 F passing = F(1.0f)) const {
    const F drawn = F(1.0f) / max(end.sampled.value, F(1e-30f));
    const F own = drawn / max(select(end.delta, F(1.0f), end.solid_angle), F(1e-30f));
    const F fewer = select(end.delta, F(0.0f), mis(at_eye.forward.value * drawn));
    return share(mis(passing) * (fewer + mis(end.emitted.value * cos * own) * behind(eye, at_eye)));
  }
  // A vertex of the light's subpath is connected with the lens, which sees so many pixels per area across the segment.
  template <class F>
  F lens(const PartialWeights<F>& light, const BothDensities<F>& at_light, Density<Area, F> pixels, F cos,
         float light_paths, F passing = F(1.0f)) const {
    return share(mis(passing) * mis(pixels.value * cos / light_paths) * behind(light, at_light));
  }
  // Two vertices are connected; cosines with the segment between them.
  template <class F>
  F connection(const PartialWeights<F>& eye, const BothDensities<F>& at_eye, F cos_eye, const PartialWeights<F>& light,
               const BothDensities<F>& at_light, F cos_light, F distance_squared, F passing = F(1.0f)) const {
    const Density<Area, F> by_eye = to_area(at_eye.forward, distance_squared, cos_light);
    const Density<Area, F> by_light = to_area(at_light.forward, distance_squared, cos_eye);
    return share(mis(passing) *
                 (mis(by_eye.value) * behind(light, at_light) + mis(by_light.value) * behind(eye, at_eye)));
  }
  // Two vertices are merged. `at_eye`: forward is the direction in which the light's subpath came.
  template <class F>
  F merging(const PartialWeights<F>& eye, const PartialWeights<F>& light, const BothDensities<F>& at_eye) const {
    return share(light.vcm * connecting_ + light.vm * mis(at_eye.forward.value) + eye.vcm * connecting_ +
                 eye.vm * mis(at_eye.reverse.value));
  }

 private:
  template <class F>
  MONTELUX_INLINE F mis(F x) const {
    x = min(x, F(1e18f));
    return power_ ? x * x : x;
  }
  // All strategies that draw this vertex, or one further back, from the other side, over that density.
  template <class F>
  MONTELUX_INLINE F behind(const PartialWeights<F>& w, const BothDensities<F>& p) const {
    return limited(select(p.merges, F(merging_), F(0.0f)) + w.vcm + w.vc * mis(p.reverse.value));
  }
  // Over the density with which a segment is passed, which a connection along it does not have.
  template <class F>
  MONTELUX_INLINE F unless_it_passes(F passing) const {
    return mis(F(1.0f) / max(passing, F(1e-18f)));
  }
  template <class F>
  MONTELUX_INLINE static F share(F others) {
    return F(1.0f) / (F(1.0f) + others);
  }
  template <class F>
  MONTELUX_INLINE static F not_zero(F cos) {
    return max(cos, F(1e-6f));
  }
  // Infinity times zero would be no number.
  template <class F>
  MONTELUX_INLINE static F limited(F x) {
    return min(x, F(1e30f));
  }
  template <class F>
  MONTELUX_INLINE static PartialWeights<F> limited(const PartialWeights<F>& w) {
    return {limited(w.vcm), limited(w.vc), limited(w.vm)};
  }

  bool power_;
  float merging_, connecting_;
};

}  // namespace montelux
