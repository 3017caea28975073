// The exposure interval.
#pragma once
#include "math/functions.h"

namespace montelux {

// Opening and closing time of the shutter, relative to the start (0) and the end (1) of the moving transforms. Outside
// [0, 1] the transforms are those of the closer end.
struct Shutter {
  float open = 0, close = 0;

  // The time at which the share u in [0, 1] of the exposure has passed.
  template <class F>
  MONTELUX_INLINE F time(F u) const {
    return clamp(F(open) + u * (close - open), 0.0f, 1.0f);
  }
};

// Converts an interval in the scene's unit of time to times relative to the interval [start, end] of its transforms. If
// the latter is empty, everything stays at its start.
inline Shutter shutter_of(double open, double close, double start, double end) {
  if (!(end > start)) return {};
  return {float((open - start) / (end - start)), float((close - start) / (end - start))};
}

}  // namespace montelux
