// Flight between the two faces of a coated surface: only depth is tracked, not position (Guo, Hasan and Zhao 2018).
#pragma once
#include "color/spectrum.h"
#include "mc/henyey_greenstein.h"
#include "mc/random.h"

namespace montelux {

// The numbers of one walk, by position: eight for each event, so that no lane's numbers depend on another lane's walk.
template <class F>
struct WalkDraws {
  RandomStream<F> stream;
  std::uint32_t place = 0;
  int depth = 0;  // of the event
  MONTELUX_INLINE F number(std::uint32_t i) const { return stream.at(Uint<F>(place + i)); }
  MONTELUX_INLINE Vec2<F> pair(std::uint32_t i) const { return {number(i), number(i + 1)}; }
  MONTELUX_INLINE WalkDraws event(int number_of_event) const {
    return {stream, place + 8u * std::uint32_t(number_of_event + 1), number_of_event};
  }
};

// The state of a walk: in flight towards w from the height z above the base, with the weight beta.
template <class F>
struct LayerWalk {
  Vec3<F> w;
  Spectrum<F> beta;
  F z;
  Mask<F> live;
};

// What ends a flight; exclusive, and only in live lanes.
template <class F>
struct LayerEvent {
  Mask<F> scatters, at_top, at_base;
};

// The medium between the faces: extinction 1 per unit of length. With albedo zero it only absorbs.
template <class F>
struct LayerMedium {
  F thickness, g;
  Spectrum<F> albedo;

  MONTELUX_INLINE Mask<F> has_scatterers() const { return max_component(albedo) > F(0.0f); }
  // The transmittance over the height `height` along w.
  MONTELUX_INLINE F transmittance(F height, Vec3<F> w) const { return exp(-abs(height) / max(abs(w.z), F(1e-10f))); }
  // Moves to the next event.
  MONTELUX_INLINE LayerEvent<F> fly(LayerWalk<F>& walk, F u) const {
    F free = -log(F(1.0f) - u) * abs(walk.w.z);
    F next = walk.z + copysign(free, walk.w.z);
    Mask<F> medium = has_scatterers();
    Mask<F> scatters = walk.live & medium & (next > F(0.0f)) & (next < thickness);
    Mask<F> up = walk.w.z > F(0.0f);
    // Without scatterers, all light that is not absorbed arrives.
    walk.beta = walk.beta * select(walk.live & !medium, transmittance(thickness, walk.w), F(1.0f));
    walk.z = select(scatters, next, select(up, thickness, F(0.0f)));
    Mask<F> arrives = walk.live & !scatters;
    return {scatters, Mask<F>(arrives & up), Mask<F>(arrives & !up)};
  }
  MONTELUX_INLINE void scatter(LayerWalk<F>& walk, Mask<F> on, Vec2<F> u) const {
    walk.w = select(on, sample_henyey_greenstein(walk.w, g, u), walk.w);
    walk.beta = select(on, walk.beta * albedo, walk.beta);
  }
};

// Russian roulette once a walk has lost three quarters of its weight after the first events.
template <class F>
MONTELUX_INLINE void layer_roulette(LayerWalk<F>& walk, int depth, F u) {
  if (depth <= 3) return;
  F largest = max_component(walk.beta);
  Mask<F> doubtful = walk.live & (largest < F(0.25f));
  walk.live = walk.live & !Mask<F>(doubtful & (u >= largest));
  walk.beta = walk.beta / select(doubtful, max(largest, F(1e-30f)), F(1.0f));
}

}  // namespace montelux
