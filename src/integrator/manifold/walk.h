// Newton's method on the first direction of a specular chain, so that its last ray meets a light (Hanika, Droske and
// Fascione 2015, "Manifold Next Event Estimation", in the coordinates of the ray that leaves the rough surface).
#pragma once
#include <optional>

#include "integrator/manifold/chain.h"

namespace montelux {

// A light that no ray hits: one at a point, or a distant one.
struct DeltaLight {
  LightId id{};
  bool is_distant = false;
  Vec3d place{};  // of a distant light the unit direction toward it
};

// How far the last ray of a chain misses a light: for small misses the angle at the last vertex, and zero if the ray
// meets the light.
struct ChainMiss {
  std::array<double, 2> miss{};                     // orthogonal to the direction of the light
  std::array<std::array<double, 2>, 2> jacobian{};  // of miss[i] with respect to parameter j of the chain
  double size = 0;                                  // of miss
  double precision = 0;                             // that single precision allows

  double determinant() const { return jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0]; }
  // How little the miss may change where the parameters change by one: the smaller singular value.
  double min_stretch() const;
};
ChainMiss miss_of(const SpecularChain& chain, const DeltaLight& light);

// A chain that meets the light.
struct ChainSolution {
  SpecularChain chain;
  ChainMiss miss;
  // Whether two walks have found the same chain. Chains that merge, at the edge of a caustic, have opposite signs of
  // the determinant, so rounding does not confuse them.
  bool is_same(const ChainSolution& other) const;
};

// From the unit direction `start`. None: no such chain there, or the walk does not find it.
std::optional<ChainSolution> walk_to_light(const ChainTracer& tracer, const StoredOrigin<float>& from,
                                           const Vec3f& start, const ChainKind& kind, const DeltaLight& light,
                                           const RandomStream<float>& random, std::uint64_t& rays);

}  // namespace montelux
