// Techniques whose terms are functions of one point of the cube: f(x) times a Jacobian, at the points of a
// point set: uniform, stratified, antithetic, control and qmc.
#pragma once
#include "lab/integral/technique.h"
#include "mc/adaptive_map.h"

namespace montelux::lab {

// The map of the coordinates, trained for an integrand in steps: each step uses the map of the previous one. An
// interrupted training continues to the same map.
class MapTraining {
 public:
  static constexpr int steps = 8;

  // Uses about 1.4 times `samples` Sobol' points in total.
  MapTraining(const Integrand& integrand, std::uint64_t seed, std::uint64_t samples);
  void go_to(int step);
  const AdaptiveMap& map() const { return map_; }
  std::uint64_t evaluations() const { return evaluations_; }
  // The ratio of the variances of one uniform sample and one through the map, from the last step.
  double gain() const { return gain_; }

 private:
  std::uint64_t samples_of(int step) const;

  Integrand integrand_;
  std::uint64_t seed_, samples_, evaluations_ = 0;
  int step_ = 0;
  double gain_ = 1;
  AdaptiveMap map_;
};

// Adaptive methods use the map of the training in its current state; its evaluations count as theirs.
std::unique_ptr<Technique> make_sampled(const Problem& problem, const Method& method, const MapTraining* training);

}  // namespace montelux::lab
