// Counter-based random numbers: each is a pure function of its key and its counter. No state is shared.
#pragma once
#include "math/functions.h"

namespace montelux {

// A bijection of 32-bit words that changes about half of the output bits for each input bit
// (lowbias32, C. Wellons 2018, bias 0.17).
template <class U>
MONTELUX_INLINE U mix_bits(U x) {
  x = x ^ (x >> 16);
  x = x * U(0x7feb352du);
  x = x ^ (x >> 15);
  x = x * U(0x846ca68bu);
  return x ^ (x >> 16);
}

// A uniform real in [0, 1): 24 bits.
template <class F>
MONTELUX_INLINE F unit_float(Uint<F> x) {
  return to_float(Uint<F>(x >> 8)) * 0x1p-24f;
}

// A stream of independent uniform numbers, distinguished from every other stream by a key of 64 bits.
template <class F>
class RandomStream {
 public:
  using U = Uint<F>;
  RandomStream() = default;
  MONTELUX_INLINE RandomStream(U key_low, U key_high) : low_(key_low), high_(key_high), counter_(0u) {}

  // The number at a position of the stream, in [0, 1).
  MONTELUX_INLINE F at(U place) const { return unit_float<F>(bits_at(place)); }
  MONTELUX_INLINE U bits_at(U place) const { return mix_bits(U(high_ ^ mix_bits(U(low_ + place * U(0x9e3779b9u))))); }
  // The next number, in [0, 1), in every lane.
  MONTELUX_INLINE F next() {
    F x = at(counter_);
    counter_ = counter_ + U(1u);
    return x;
  }
  MONTELUX_INLINE Vec2<F> next2() {
    F x = next();
    F y = next();
    return {x, y};
  }
  // A separate stream for each `purpose`.
  MONTELUX_INLINE RandomStream fork(U purpose) const {
    return RandomStream(mix_bits(U(low_ ^ purpose * U(0x85ebca6bu))), mix_bits(U(high_ + purpose)));
  }

 private:
  U low_, high_, counter_;
};

}  // namespace montelux
