// Manifold next-event estimation: light of delta lights that reaches a rough surface by way of mirrors and smooth
// glass, without bias (Zeltner, Georgiev and Jakob 2020, "Specular Manifold Sampling", sec. 4.3).
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
  // Chains have up to `length` specular vertices. Null where the scene has no delta light or no surface with such
  // events, so that there is none. Scene and accel must outlive it; the scene must have no participating media.
  static std::shared_ptr<const ManifoldLight> make(const Scene& scene, const Accel& accel, int length);

  // At a rough vertex, whose light may scatter up to `max_events` times, with the numbers of the vertex. A walk from a
  // random start finds a chain with a probability that is unknown; the number of walks until another one finds the same
  // chain estimates its reciprocal. Adds the rays that are traced to `rays`.
  ChainLight<float> light(const StoredVertex<float>& x, std::uint32_t max_events, std::uint64_t& rays) const;

 private:
  // What is sought: chains of one kind to one light.
  struct Search {
    DeltaLight light;
    ChainKind kind;
    std::vector<Vec3f> ends;  // places where light has left such chains, on its way to some rough surface
  };
  ManifoldLight(const Scene& scene, const Accel& accel, const std::function<bool(std::size_t)>& is_caster);
  void list_searches(int length);
  // By walks from the lights: how much light comes by each search to rough surfaces, roughly, which decides how often
  // it is made; and the ends of its chains, where most walks start.
  std::vector<double> learn_searches();

  std::optional<ChainSolution> solution(const StoredVertex<float>& x, const Search& search, RandomStream<float> random,
                                        const RandomStream<float>& of_scene, std::uint64_t& rays) const;
  // An unbiased estimate of one over the probability with which solution() finds this one.
  double reciprocal_probability(const StoredVertex<float>& x, const Search& search, const ChainSolution& found,
                                const RandomStream<float>& random, const RandomStream<float>& of_scene,
                                std::uint64_t& rays) const;

  ChainTracer tracer_;
  SmoothTargets casters_;
  std::vector<Search> searches_;
  std::optional<AliasTable> choice_;  // of a search
};

}  // namespace montelux
