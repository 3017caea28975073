// What a film accepts of one sample.
#pragma once
#include <algorithm>

namespace montelux {

// The number clamped to the bounds; 0 for NaN.
inline double within(double x, double bound) { return x >= -bound ? std::min(x, bound) : x < -bound ? -bound : 0; }

}  // namespace montelux
