// What a pixel finds by itself: candidates on lights by several techniques, combined by generalised balance weights.
#pragma once
#include "integrator/compensated_lights.h"
#include "integrator/resampled_light.h"
#include "integrator/restir/settings.h"
#include "integrator/restir/vertex.h"

namespace montelux {

// The ways to draw a light.
struct LightTechniques {
  const MediumSet& media;  // of the scene
  LightSet bvh;
  std::optional<LightSet> by_power;  // none: not used
  bool are_compensated = false;      // as LightSet has it

  LightTechniques(const Scene& scene, const Accel& accel, const RestirSettings& settings)
      : media(scene.media), bvh(scene.lights.with({LightSelection::bvh})) {
    if (settings.power_candidates > 0) by_power = scene.lights.with({LightSelection::power});
    if (!settings.bsdf_candidate) return;
    if (auto compensated = compensated_lights(bvh, scene, accel)) bvh = *std::move(compensated), are_compensated = true;
    if (by_power)
      if (auto compensated = compensated_lights(*by_power, scene, accel)) by_power = std::move(compensated);
  }
};

// A candidate that was taken, with the point's target at the vertex.
template <class F>
struct Candidate {
  LightPoint<F> point;
  F target;
};
template <class F>
MONTELUX_INLINE Candidate<F> select(Mask<F> m, const Candidate<F>& a, const Candidate<F>& b) requires(lanes_of<F> > 1) {
  return {select(m, a.point, b.point), select(m, a.target, b.target)};
}

// The stream of one vertex's candidates. First draw_lights(), then add_hit() and add_sky() for what a direction of the
// BSDF meets, then result().
//
// A point's share is its technique's number of samples times density over that of all (Veach and Guibas 1995), so its
// resampling weight is target / sum of these products, whichever technique drew it. The BSDF draws only what is open to
// the vertex, so a point on a light must have the whole of its share where something is in the way, or other pixels
// that see it would find too little light there. The visibility of the point that the lights' own techniques choose
// among themselves is therefore tested before it competes with the BSDF's. Lights with a place and those beyond the
// scene have a stream each, and each is tested by itself: where a sun is hidden, a pixel would otherwise find nothing
// but the sun.
template <class F, class Rays>
class FirstCandidates {
 public:
  FirstCandidates(const LightTechniques& lights, const Rays& rays, const RestirSettings& settings,
                  const ReuseVertex<F>& vertex, RayCounts& counts)
      : lights_(lights), rays_(rays), settings_(settings), vertex_(vertex), counts_(counts) {}

  void draw_lights(RandomStream<F>& stream, Mask<F> on) {
    const bool has_beyond = lights_.bvh.has_beyond();
    StreamChoice placed, beyond;
    const int all = settings_.candidates + settings_.power_candidates;
    for (int i = 0; i < all; ++i) {
      const bool is_power = i >= settings_.candidates;
      // Strata of the choice: the places of one technique's candidates are spread evenly.
      const int place = is_power ? i - settings_.candidates : i;
      const int among = is_power ? settings_.power_candidates : settings_.candidates;
      const F u_choice = min((stream.next() + float(place)) * (1.0f / float(among)), F(one_minus_epsilon));
      const Vec2<F> u = stream.next2();
      const F u_take = stream.next();
      const LightSet& technique = is_power ? *lights_.by_power : lights_.bvh;
      const LightChoice<F> choice = technique.choose(vertex_.p, vertex_.light_normal, u_choice, on);
      const Mask<F> queries = on & choice.valid;
      const LightPointDraw<F> draw =
          lights_.bvh.draw_light_point(choice.light, vertex_.p, vertex_.light_normal, u, queries);
      const Mask<F> good = queries & draw.valid;
      const LightConnection<F> to = connect(lights_.media, lights_.bvh, vertex_, draw.point, good);
      const F product = draw.density.value * products_of_choice(choice, is_power, good);
      const F w = weight(to, product, good);
      if (!has_beyond) {
        placed.add(draw.point, to, product, w, u_take);
        continue;
      }
      const Mask<F> far = good & lights_.bvh.template is_beyond<F>(choice.light, good);
      placed.add(draw.point, to, product, select(far, F(0.0f), w), u_take);
      beyond.add(draw.point, to, product, select(far, w, F(0.0f)), u_take);
    }
    end_stream(placed, stream, on);
    if (has_beyond) end_stream(beyond, stream, on);
  }

  // The surface of light number `light` that the direction d of the BSDF met in `on`.
  // `stream` belongs to this surface alone.
  void add_hit(const SurfaceHit<F>& x, const Vec3<F>& d, const RandomStream<F>& stream, Mask<F> on) {
    const Uint<F> light = select(on, x.light - Uint<F>(1u), Uint<F>(0u));
    const LightHit<F> hit =
        lights_.bvh.template hit<F>(light, vertex_.p, vertex_.light_normal, x.point.p, x.point.ng, x.point.uv, d, on);
    const Mask<F> shines = on & !is_black(hit.radiance);
    F product = hit.density.value * float(settings_.candidates);
    if (lights_.by_power)
      product =
          product + float(settings_.power_candidates) * lights_.by_power
                                                            ->template hit<F>(light, vertex_.p, vertex_.light_normal,
                                                                              x.point.p, x.point.ng, x.point.uv, d, on)
                                                            .density.value;
    add_met(lights_.bvh.point_of_hit(light, x.point.p, x.point.ng, hit.radiance, shines), product,
            stream.at(Uint<F>(0u)), shines);
  }
  // The lights beyond the scene, where d meets nothing.
  void add_sky(const Vec3<F>& d, const RandomStream<F>& stream, Mask<F> on) {
    const LightSet& lights = lights_.bvh;
    for (int i = 0; i < lights.infinite_count() && any(on); ++i) {
      const LightHit<F> sky = lights.template escaped<F>(i, vertex_.p, vertex_.light_normal, d, on);
      F product = sky.density.value * float(settings_.candidates);
      if (lights_.by_power)
        product = product +
                  float(settings_.power_candidates) *
                      lights_.by_power->template escaped<F>(i, vertex_.p, vertex_.light_normal, d, on).density.value;
      const LightPoint<F> point{d, d, sky.radiance, Uint<F>(std::uint32_t(lights.infinite_light(i))),
                                in_lanes<F>(LightPlace::infinite)};
      add_met(point, product, stream.at(Uint<F>(std::uint32_t(i))), on & !is_black(sky.radiance));
    }
  }

  LightReservoir<F> result() const {
    const F target = all_.value.target;
    const Mask<F> found = (all_.weight_sum > F(0.0f)) & (target > F(0.0f));
    return {all_.value.point, select(found, usable_weight<F>(all_.weight_sum / target), F(0.0f)), F(1.0f), target};
  }
  // Lanes where a candidate's weight was not a number.
  Mask<F> broken() const { return broken_; }

 private:
  // What a stream of points on lights has chosen.
  struct StreamChoice {
    WeightedReservoir<Candidate<F>, F> chosen;
    LightConnection<F> way{};
    F by_light = 0.0f;  // the products of its techniques

    StreamChoice() { chosen.value.point.place = in_lanes<F>(LightPlace::surface), chosen.value.target = F(0.0f); }
    void add(const LightPoint<F>& point, const LightConnection<F>& to, F product, F w, F u) {
      const Mask<F> taken = chosen.add({point, to.target}, w, u);
      way.wi = select(taken, to.wi, way.wi), way.distance = select(taken, to.distance, way.distance);
      way.by_bsdf = select(taken, to.by_bsdf, way.by_bsdf);
      by_light = select(taken, product, by_light);
    }
  };
  // Joins a stream's winner to the rest, with the share that the BSDF leaves.
  void end_stream(const StreamChoice& winner, RandomStream<F>& stream, Mask<F> on) {
    const Mask<F> found = on & (winner.chosen.weight_sum > F(0.0f));
    F share = 1.0f;
    if (settings_.bsdf_candidate || settings_.visibility_reuse) {
      const Mask<F> open = is_open<F>(rays_, vertex_, winner.way, found, counts_.shadow);
      if (settings_.bsdf_candidate)
        share = select(open, balance_weight(winner.by_light, winner.way.by_bsdf.value), share);
      if (settings_.visibility_reuse) share = select(open, share, F(0.0f));
    }
    all_.add(winner.chosen.value, select(found, winner.chosen.weight_sum * share, F(0.0f)), stream.next());
  }
  void add_met(const LightPoint<F>& point, F product, F u, Mask<F> on) {
    if (!any(on)) return;
    const LightConnection<F> to = connect(lights_.media, lights_.bvh, vertex_, point, on);
    all_.add({point, to.target}, weight(to, product + to.by_bsdf.value, on), u);
  }
  // Numbers of samples times probabilities of the choice, over the lights' techniques.
  F products_of_choice(const LightChoice<F>& choice, bool is_power, Mask<F> on) const {
    const auto mass = [&](const LightSet& technique, bool is_own) {
      return is_own ? choice.mass.value
                    : technique.choice_mass(choice.light, vertex_.p, vertex_.light_normal, on).value;
    };
    F sum = 0.0f;
    if (settings_.candidates > 0) sum = float(settings_.candidates) * mass(lights_.bvh, !is_power);
    if (lights_.by_power) sum = sum + float(settings_.power_candidates) * mass(*lights_.by_power, is_power);
    return sum;
  }
  // target / (sum of products), both in the point's own measure.
  F weight(const LightConnection<F>& to, F products, Mask<F> on) {
    const Mask<F> counts = on & (to.target > F(0.0f));
    const F w = to.target / (products * to.geometry);
    const Mask<F> known = is_finite(average(to.value)), weighs = is_finite(w);
    broken_ = broken_ | (on & !known) | (counts & !weighs);
    return select(counts, usable_weight(w), F(0.0f));
  }

  const LightTechniques& lights_;
  const Rays& rays_;
  const RestirSettings& settings_;
  const ReuseVertex<F>& vertex_;
  RayCounts& counts_;
  WeightedReservoir<Candidate<F>, F> all_ = StreamChoice().chosen;
  Mask<F> broken_ = Mask<F>(false);
};

}  // namespace montelux
