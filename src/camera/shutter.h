// When the shutter is open.
#pragma once
#include "math/functions.h"

namespace montelux {

// Its opening and closing as places on the way from the start (0) to the end (1) of the transforms that move. What
// lies outside of [0, 1] sees the maps of the nearer end.
struct Shutter {
  float open = 0, close = 0;

  // The moment at which a share u in [0, 1] of the time of exposure has gone by.
  template <class F>
  MONTELUX_INLINE F time(F u) const {
    return clamp(F(open) + u * (close - open), 0.0f, 1.0f);
  }
};

// An interval in the unit of time of a scene, seen from the interval [start, end] of its transforms. Where the latter
// is empty, everything stands at its start.
inline Shutter shutter_of(double open, double close, double start, double end) {
  if (!(end > start)) return {};
  return {float((open - start) / (end - start)), float((close - start) / (end - start))};
}

}  // namespace montelux
