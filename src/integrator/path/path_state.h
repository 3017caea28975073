// All that a path carries from one vertex to the next, one path a lane.
#pragma once
#include <cstring>

#include "color/spectrum.h"
#include "scene/geometry_store.h"

namespace montelux {

// Made of 32-bit words alone, so that a lane can be filled word by word.
template <class F>
struct PathState {
  Vec3<F> o, d;            // the ray that led to `hit`
  Hit<F> hit;              // the vertex at hand
  Spectrum<F> throughput;  // product of the weights so far
  Spectrum<F> radiance;    // gathered so far
  Vec3<F> p, n;            // the previous vertex and its normal, as the lights' densities take them
  F density;            // of the direction d at the previous vertex, solid angle; 0: no other technique could draw it
  F weight;             // of the camera and the filter (which may be negative), for the result
  F eta_scale;          // squared relative indices of refraction crossed; roulette takes it out
  Uint<F> depth;        // scattering events so far
  Uint<F> x, y, index;  // pixel, and number of the sample there
  Uint<F> slot;         // where the result goes
};

// Copies a path into lane k.
template <class F>
MONTELUX_INLINE void set_lane(PathState<F>& state, int k, const PathState<float>& path) {
  static_assert(sizeof(PathState<F>) == sizeof(PathState<float>) * lanes_of<F>);
  constexpr std::size_t words = sizeof(PathState<float>) / 4;
  auto* to = reinterpret_cast<char*>(&state) + 4 * std::size_t(k);
  const auto* from = reinterpret_cast<const char*>(&path);
  for (std::size_t w = 0; w < words; ++w) std::memcpy(to + 4 * w * lanes_of<F>, from + 4 * w, 4);
}
// The path in lane k.
template <class F>
MONTELUX_INLINE PathState<float> lane(const PathState<F>& state, int k) {
  PathState<float> path;
  constexpr std::size_t words = sizeof(PathState<float>) / 4;
  const auto* from = reinterpret_cast<const char*>(&state) + 4 * std::size_t(k);
  for (std::size_t w = 0; w < words; ++w)
    std::memcpy(reinterpret_cast<char*>(&path) + 4 * w, from + 4 * w * lanes_of<F>, 4);
  return path;
}

}  // namespace montelux
