// Techniques whose terms are each a function of one point of the cube: f(x) times a Jacobian, at the points of some
// point set: uniform, stratified, antithetic, control and qmc.
#pragma once
#include "lab/integral/technique.h"
#include "mc/adaptive_map.h"

namespace montelux::lab {

// The map of the coordinates, trained for an integrand step by step: each step sees the integrand through the map of
// the one before. A training that stopped early goes on to the same map as one that did not.
class MapTraining {
 public:
  static constexpr int steps = 8;

  // In all about 1.4 times `samples` Sobol' points.
  MapTraining(const Integrand& integrand, std::uint64_t seed, std::uint64_t samples);
  void go_to(int step);
  const AdaptiveMap& map() const { return map_; }
  std::uint64_t evaluations() const { return evaluations_; }
  // The variance of one uniform sample over that of one through the map, as the last step saw both.
  double gain() const { return gain_; }

 private:
  std::uint64_t samples_of(int step) const;

  Integrand integrand_;
  std::uint64_t seed_, samples_, evaluations_ = 0;
  int step_ = 0;
  double gain_ = 1;
  AdaptiveMap map_;
};

// Methods that adapt take their map from the training, as far as it has gone; its evaluations count as theirs.
std::unique_ptr<Technique> make_sampled(const Problem& problem, const Method& method, const MapTraining* training);

}  // namespace montelux::lab
