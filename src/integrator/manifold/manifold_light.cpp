#include "integrator/manifold/manifold_light.h"

#include <cmath>

#include "mc/hemisphere.h"
#include "scene/smoothness.h"
#include "transport/connection.h"
#include "transport/dimensions.h"
#include "transport/path_state.h"

namespace montelux {

namespace {

// The forks of the stream: the choice of the search, the mixtures of the scene, the end of counting, and the walks.
enum Stream : std::uint32_t { choosing, of_the_scene, ending, walking };

// Walks start toward the ends of chains of other light, and with these probabilities in any direction, so that every
// chain can be found, also where surfaces move, or toward any surface with such events.
constexpr float undirected = 1.0f / 16, toward_any = 3.0f / 16;

// Walks by the light that learn the shares of searches, and the part of the choice that does not depend on them.
constexpr std::uint32_t learning_walks = 4096;
constexpr double unlearned = 0.1;
constexpr std::size_t max_ends = 1024;  // of one search

// Walks that are counted without roulette.
constexpr std::uint32_t sure_walks = 256;

}  // namespace

std::shared_ptr<const ManifoldLight> ManifoldLight::make(const Scene& scene, const Accel& accel,
                                                         const ChainLimits& limits) {
  if (!scene.lights.has_delta() || limits.length < 1) return nullptr;
  const std::shared_ptr<ManifoldLight> made(new ManifoldLight(scene, accel, limits));
  if (made->casters_.empty()) return nullptr;
  made->list_searches();
  if (made->searches_.empty()) return nullptr;
  made->choice_.emplace(made->learn_searches());
  return made;
}

ManifoldLight::ManifoldLight(const Scene& scene, const Accel& accel, const ChainLimits& limits)
    : length_(std::uint32_t(limits.length)),
      tracer_(scene, accel, limits.max_roughness),
      casters_(scene, [&](std::size_t material) { return tracer_.caster(material) != Caster::none; }) {}

void ManifoldLight::list_searches() {
  const LightSet& lights = tracer_.scene().lights;
  for (std::uint32_t i = 0; i < lights.count(); ++i) {
    const LightKind kind = lights.kind(LightId(i));
    if (!is_delta(kind)) continue;
    const LightEmission<float> sent = lights.emit<float>(i, {0.5f, 0.5f}, {0.5f, 0.5f}, true);
    const bool is_distant = kind == LightKind::distant;
    const DeltaLight light{LightId(i), is_distant, is_distant ? unit(-to_double(sent.d)) : to_double(sent.p)};
    for (std::uint32_t n = 1; n <= length_; ++n)
      for (std::uint32_t reflections = 0; reflections < (1u << n); ++reflections)
        searches_.push_back({light, {n, reflections}, {}});
  }
}

std::vector<double> ManifoldLight::learn_searches() {
  const Scene& scene = tracer_.scene();
  std::vector<double> learned(searches_.size(), 0.0), shares(searches_.size());
  double sum = 0, powers = 0;
  const AliasTable by_power = scene.lights.by_power();
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    shares[i] = double(by_power.mass<float>(std::uint32_t(searches_[i].light.id)).value);
    powers += shares[i];
  }
  const auto counts = [&](const SmoothChain& chain) { return chain.is_plain && chain.reflects.size() <= length_; };
  const auto passes = [&](std::size_t material) { return tracer_.caster(material) == Caster::rough; };
  const RandomStream<float> all(0x452821e6u, 0x38d01377u);
  for (std::uint32_t i = 0; i < learning_walks; ++i) {
    RandomStream<float> random = all.fork(i);
    const auto which = std::size_t(double(random.next()) * double(searches_.size()));  // of each light as many
    const Search& any = searches_[std::min(which, searches_.size() - 1)];
    const Vec3f target = casters_.point(random);
    const auto chain = follow_light(scene, tracer_.accel(), any.light.id, target, random, counts, passes);
    if (!chain) continue;
    const std::size_t length = chain->reflects.size();
    std::uint32_t reflections = 0;  // in the order of a path from the eye
    for (std::size_t k = 0; k < length; ++k)
      if (chain->reflects[length - 1 - k]) reflections |= 1u << k;
    for (std::size_t k = 0; k < searches_.size(); ++k) {
      Search& s = searches_[k];
      if (s.light.id != any.light.id || s.kind.length != length || s.kind.reflections != reflections) continue;
      learned[k] += double(chain->irradiance), sum += double(chain->irradiance);
      if (s.ends.size() < max_ends) s.ends.push_back(chain->last);
    }
  }
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double plain = powers > 0 ? shares[i] / powers : 1 / double(shares.size());
    shares[i] = sum > 0 ? unlearned * plain + (1 - unlearned) * learned[i] / sum : plain;
  }
  return shares;
}

std::optional<ChainSolution> ManifoldLight::solution(const StoredOrigin<float>& x, const Search& search,
                                                     RandomStream<float> random, const RandomStream<float>& of_scene,
                                                     std::uint64_t& rays) const {
  const float u = random.next();
  Vec3f start = sample_sphere(random.next2());
  if (u >= undirected) {
    const auto end = std::size_t(double(random.next()) * double(search.ends.size()));
    const bool learned = u >= undirected + toward_any && !search.ends.empty();
    const Vec3f way = (learned ? search.ends[std::min(end, search.ends.size() - 1)] : casters_.point(random)) - x.p;
    if (const float distance = montelux::length(way); distance > 0) start = way * (1 / distance);
  }
  return walk_to_light(tracer_, x, start, search.kind, search.light, of_scene, rays);
}

// 1 / p is the sum over n >= 0 of the probability that n walks do not find the chain. Beyond sure_walks roulette
// decides whether the sum continues: it gets to n walks with the probability (sure_walks / n)^2, so that less than 2
// sure_walks are expected however small p is, and each term is divided by its probability.
double ManifoldLight::reciprocal_probability(const StoredOrigin<float>& x, const Search& search,
                                             const ChainSolution& found, const RandomStream<float>& random,
                                             const RandomStream<float>& of_scene, std::uint64_t& rays) const {
  const RandomStream<float> ends = random.fork(ending);
  double sum = 0, probability = 1;
  for (std::uint32_t n = 0;; ++n) {
    if (n > sure_walks) {
      const double share = double(n - 1) / double(n), survival = share * share;
      if (!(double(ends.at(n)) < survival)) return sum;
      probability *= survival;
    }
    sum += 1 / probability;
    const auto again = solution(x, search, random.fork(walking + 1 + n), of_scene, rays);
    if (again && again->is_same(found)) return sum;
  }
}

ChainLight<float> ManifoldLight::light(const StoredOrigin<float>& x, const ChainLengths<std::uint32_t>& lengths,
                                       std::uint64_t& rays) const {
  const LightSet& lights = tracer_.scene().lights;
  const RandomStream<float> random = x.random.fork(vertex_stream::manifold), of_scene = random.fork(of_the_scene);
  const DiscreteSample<float> chosen = choice_->sample(random.fork(choosing).next());
  const Search& search = searches_[chosen.index];
  const std::uint32_t number = std::uint32_t(search.light.id), events = search.kind.length + 1;
  const ChainLight<float> none{gray(0.0f), number, events};
  if (search.kind.length < lengths.min || search.kind.length > lengths.max) return none;
  const auto found = solution(x, search, random.fork(walking), of_scene, rays);
  if (!found) return none;

  // The irradiance of the light where its direct light arrives, over how the chain spreads it: the determinant is that
  // of the angle (for a light at a point, of the place over the distance) at the light's end by the first direction.
  const SpecularChain& chain = found->chain;
  const StoredOrigin<float>& last = chain.last;
  const LightSample<float> light = lights.sample_light<float>(number, last.p, {0, 0, 0}, {0.5f, 0.5f}, true);
  const double spread = std::abs(found->miss.determinant());
  if (!light.valid || !(spread > 1e-30)) return none;
  Spectrum<float> arriving = x.scattered(chain.w, true).f_cos * chain.left * light.radiance;
  arriving = arriving * float(1 / (spread * double(chosen.mass.value)));
  if (!(max_component(arriving) > 0)) return none;
  const Arriving<float> seen = arriving_from<float>(tracer_.scene(), tracer_.accel(), last, light.wi, light.distance,
                                                    true, random.fork(Uint<float>(vertex_stream::shadow)), rays);
  if (!seen.on) return none;
  arriving *= seen.left;
  // Surfaces with an alpha mask may be open to this ray by chance, which is in the probability of the chain, but not in
  // its light: another ray, by the last digit, decides for that.
  if (tracer_.scene().geometry.has_half_open()) {
    SpecularChain again;
    if (!tracer_.trace(x, chain.w * (1 + 0x1p-22f), search.kind, of_scene, again, rays)) return none;
    if (!(again.at == chain.at)) return none;
  }
  const double reciprocal = reciprocal_probability(x, search, *found, random, of_scene, rays);
  return {arriving * float(reciprocal), number, events};
}

template <class F>
ChainLight<F> chain_light(const ManifoldLight& lights, const StoredOrigin<F>& x, Mask<F> on,
                          const ChainLengths<Uint<F>>& lengths, std::uint64_t& rays) {
  ChainLight<F> all{gray(F(0.0f)), Uint<F>(0u), Uint<F>(1u)};
  for_each_lane(on, [&](int k) {
    StoredOrigin<float> one;
    get_lane_words(x, k, one);
    const ChainLight<float> light = lights.light(one, {lane(lengths.min, k), lane(lengths.max, k)}, rays);
    set_lane(all.scattered, k, light.scattered), set_lane(all.number, k, light.number),
        set_lane(all.events, k, light.events);
  });
  return all;
}

std::uint32_t chain_length(const ManifoldLight* lights) { return lights ? lights->length() : 0; }

template <class F>
Mask<F> casts(const ManifoldLight& lights, const SurfaceHit<F>& x, Mask<F> is_delta, Mask<F> on) {
  return lights.tracer().caster_at(x, is_delta, on) != Uint<F>(std::uint32_t(Caster::none));
}

template ChainLight<float> chain_light(const ManifoldLight&, const StoredOrigin<float>&, bool,
                                       const ChainLengths<std::uint32_t>&, std::uint64_t&);
template ChainLight<NativeFloats> chain_light(const ManifoldLight&, const StoredOrigin<NativeFloats>&,
                                              Mask<NativeFloats>, const ChainLengths<Uint<NativeFloats>>&,
                                              std::uint64_t&);
template bool casts(const ManifoldLight&, const SurfaceHit<float>&, bool, bool);
template Mask<NativeFloats> casts(const ManifoldLight&, const SurfaceHit<NativeFloats>&, Mask<NativeFloats>,
                                  Mask<NativeFloats>);

}  // namespace montelux
