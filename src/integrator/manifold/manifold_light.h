// Manifold next-event estimation: light of delta lights that reaches a rough surface by way of mirrors and glass,
// without bias (Zeltner, Georgiev and Jakob 2020, "Specular Manifold Sampling", sec. 4.2 and 4.3).
#pragma once
#include <memory>
#include <vector>

#include "integrator/manifold/chain_light.h"
#include "integrator/manifold/walk.h"
#include "integrator/smooth_walks.h"
#include "mc/discrete.h"

namespace montelux {

class ManifoldLight {
 public:
  // Null where the scene has no delta light or no surface with events of chains, so that there is none. Scene and accel
  // must outlive it; the scene must have no participating media.
  static std::shared_ptr<const ManifoldLight> make(const Scene& scene, const Accel& accel, const ChainLimits& limits);

  // Of chains at most.
  std::uint32_t length() const { return length_; }
  const ChainTracer& tracer() const { return tracer_; }

  // At a rough vertex, by chains of these lengths, with the numbers of the vertex. A walk from a
  // random start finds a chain with a probability that is unknown; the number of walks until another one finds the same
  // chain estimates its reciprocal. Adds the rays that are traced to `rays`.
  ChainLight<float> light(const StoredOrigin<float>& x, const ChainLengths<std::uint32_t>& lengths,
                          std::uint64_t& rays) const;

 private:
  // What is sought: chains of one kind to one light.
  struct Search {
    DeltaLight light;
    ChainKind kind;
    std::vector<Vec3f> ends;  // places where light has left such chains, on its way to some rough surface
  };
  ManifoldLight(const Scene& scene, const Accel& accel, const ChainLimits& limits);
  void list_searches();
  // By walks from the lights: how much light comes by each search to rough surfaces, roughly, which decides how often
  // it is made; and the ends of its chains, where most walks start.
  std::vector<double> learn_searches();

  std::optional<ChainSolution> solution(const StoredOrigin<float>& x, const Search& search, RandomStream<float> random,
                                        const RandomStream<float>& of_scene, std::uint64_t& rays) const;
  // An unbiased estimate of one over the probability with which solution() finds this one.
  double reciprocal_probability(const StoredOrigin<float>& x, const Search& search, const ChainSolution& found,
                                const RandomStream<float>& random, const RandomStream<float>& of_scene,
                                std::uint64_t& rays) const;

  std::uint32_t length_;
  ChainTracer tracer_;
  SmoothTargets casters_;
  std::vector<Search> searches_;
  std::optional<AliasTable> choice_;  // of a search
};

}  // namespace montelux
