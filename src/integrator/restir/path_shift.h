// The shift of paths: another pixel scatters with the same numbers, and then reconnects to the same surface or light
// (Lin et al. 2022, sec. 7: the hybrid shift). Without replayed events it is the reconnection shift; with reconnection
// at the light only, the random replay shift.
#pragma once
#include "integrator/restir/path_sample.h"
#include "transport/next_vertex.h"

namespace montelux {

// What the reuse of paths needs to know and never changes.
template <class Rays>
struct PathScene {
  const Scene& scene;
  const LightSet& lights;
  const Rays& rays;
  const PathReuse& reuse;
  std::uint32_t max_events;  // of a whole path
};

// Pixels are distinguished at a distance from the camera or the vertex before.
template <class F>
F squared_distance_of_pixels(const PathReuse& reuse, const ReuseVertex<F>& first) {
  return first.depth * first.depth * reuse.footprint;
}

template <class F, class Rays>
class PathReplay {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  PathReplay(const PathScene<Rays>& shared, const ReuseVertex<F>& first, const PathSample<F>& sample, M on,
             RayCounts& counts)
      : shared_(shared),
        sample_(sample),
        counts_(counts),
        at_(&first),
        pixels_(squared_distance_of_pixels(shared.reuse, first)),
        alive_(on) {}

  // The contribution of the path to the first vertex, per unit of the shared measure; black where it is no path of this
  // vertex.
  Spectrum<F> contribution() {
    const M met = sample_.end == U(path_end::met);
    Spectrum<F> radiance = gray(F(0.0f));
    for (std::uint32_t event = 0;; ++event) {
      const M scatters = alive_ & (U(event) < sample_.replayed);
      if (!any(scatters)) break;
      const Spectrum<F> seen = scatter(event, scatters, met & (sample_.replayed == U(event + 1)));
      radiance += seen;
    }
    const M surface = alive_ & (sample_.end == U(path_end::surface)),
            point = alive_ & (sample_.end == U(path_end::light));
    if (any(surface)) radiance += select(surface, through_surface(surface), gray(F(0.0f)));
    if (any(point)) radiance += select(point, through_light(point), gray(F(0.0f)));
    return select(is_finite(average(radiance)), radiance, gray(F(0.0f)));
  }

 private:
  // Scatters once more, to the next surface; in the lanes `last`, to the light that is met there, which is the result.
  Spectrum<F> scatter(std::uint32_t event, M on, M last) {
    const EventNumbers<F> numbers(sample_.numbers, U(event));
    const BsdfSample<F> next = at_->sampled(numbers.direction(), numbers.model(), on);
    const PathEvent<F> taken = event_at(*at_, next, on);
    // The same samples come back only if the path could not have been joined before.
    const M spread = taken.valid & !taken.delta;
    const M stays = taken.valid & !(spread & (may_join(taken.density) | last));
    weight_ = select(stays, weight_ * taken.weight, weight_);

    const NextVertex<F> at =
        next_vertex<F>(shared_.scene, shared_.rays, at_->reference_toward(shared_.scene.media, taken.wi),
                       at_->ray_toward(taken.wi), stays, numbers.surface(), counts_.scattered, NoWeight{});
    Spectrum<F> radiance = gray(F(0.0f));
    if (const M ends = stays & last; any(ends)) {
      const M emits = ends & at.found & (at.x.light != U(0u)), left = ends & !at.found;
      radiance = select(emits,
                        shared_.lights.template hit_radiance<F>(select(emits, at.x.light - U(1u), U(0u)), at.x.point.ng,
                                                                at.x.point.uv, taken.wi, emits),
                        gray(F(0.0f)));
      radiance = select(left, shared_.lights.template escaped_radiance<F>(taken.wi, left), radiance);
      const Spectrum<F> far = at_->media_toward(shared_.scene.media, taken.wi).left(F(ray_infinity));
      radiance = select(ends, weight_ * select(left, far, at.left) * radiance, gray(F(0.0f)));
    }
    const M moved = stays & !last & at.found;
    weight_ = select(moved, weight_ * at.left, weight_);
    const F pixels = pixels_;
    const Leg<F> leg = leg_between<F>(at_->p, at.x, taken.wi, taken.density, taken.valid & !taken.delta, pixels);
    leg_ = {select(moved, leg.squared_length, leg_.squared_length), select(moved, leg.spread, leg_.spread), pixels};
    if (any(moved)) moved_ = select_words(moved, vertex_behind<F>(*at_, at), *at_), at_ = &moved_;
    has_leg_ = has_leg_ | moved;
    alive_ = alive_ & (moved | !on);
    return radiance;
  }

  // Whether the path would have been joined to the vertex at hand, if it leaves it with this density.
  M may_join(const Density<SolidAngle, F>& density) const {
    return shared_.reuse.joins ? has_leg_ & leg_.is_wide(density) : M(false);
  }

  Spectrum<F> through_surface(M on) {
    const StoredSurface<F>& at = sample_.at;
    const auto [wi, distance, squared] = line_to<F>(at_->p, at.p);
    M good = on & (squared > F(1e-30f));
    const BsdfValue<F> here = at_->scattered(wi, good);
    good = good & (here.density.value > F(0.0f)) & !may_join(here.density);
    const BsdfValue<F> there = at.scattered(-wi, sample_.wi, good);
    const Leg<F> leg = leg_between<F>(at_->p, at.p, at.ng, wi, here.density, good, pixels_);
    good = good & (there.density.value > F(0.0f)) & leg.is_wide(there.density);
    const F geometry = abs(dot(at.ng, wi)) / squared;
    const Spectrum<F> left = at.boundary().before(at_->media_toward(shared_.scene.media, wi), wi).left(distance);
    const Spectrum<F> radiance = weight_ * here.f_cos * there.f_cos * left * sample_.arriving * geometry;
    good = good & (average(radiance) > F(0.0f));
    return select(unblocked<F>(shared_.rays, at_->shadow_ray_to(wi, distance), good, counts_.shadow), radiance,
                  gray(F(0.0f)));
  }

  Spectrum<F> through_light(M on) {
    const LightConnection<F> to = connect(shared_.scene.media, shared_.lights, *at_, sample_.point, on);
    const M good = on & (to.target > F(0.0f)) & !may_join(to.scattered.density);
    return select(is_open<F>(shared_.rays, *at_, to, good, counts_.shadow), weight_ * to.value, gray(F(0.0f)));
  }

  const PathScene<Rays>& shared_;
  const PathSample<F>& sample_;
  RayCounts& counts_;
  const ReuseVertex<F>* at_;  // at hand: the first one, or
  ReuseVertex<F> moved_;      // one to which the path has moved
  const F pixels_;
  Leg<F> leg_{F(0.0f), F(0.0f), F(0.0f)};  // that led there
  M has_leg_ = M(false), alive_;
  Spectrum<F> weight_ = gray(F(1.0f));  // of the events so far
};

// What differs from domain to domain: what the path contributes.
template <class F>
struct PathImage {
  F jacobian, target;
  Spectrum<F> contribution;
};
template <class F>
MONTELUX_INLINE PathImage<F> select(Mask<F> m, const PathImage<F>& a, const PathImage<F>& b) requires(lanes_of<F> > 1) {
  return {select(m, a.jacobian, b.jacobian), select(m, a.target, b.target), select(m, a.contribution, b.contribution)};
}

// The domains of a combination of path reservoirs: the paths behind each of `vertices`. Targets know what is in the
// way.
template <class F, class Rays>
struct PathDomains {
  const PathScene<Rays>& shared;
  std::span<const ReuseVertex<F>> vertices;
  RayCounts& counts;

  Shifted<PathSample<F>, F> shift(int, const PathSample<F>& value, Mask<F> on) const {
    PathSample<F> there = value;
    there.contribution = contribution_at(0, value, on);
    return {there, F(1.0f), usable_weight(average(there.contribution))};
  }
  PathImage<F> own(int, const PathSample<F>& value, Mask<F>) const { return of_contribution(value.contribution); }
  PathImage<F> image(int, int to, const PathSample<F>& value, Mask<F> on) const {
    return of_contribution(contribution_at(to, value, on));
  }
  F target_at(int to, const PathSample<F>& value, Mask<F> on) const {
    return usable_weight(average(contribution_at(to, value, on)));
  }

 private:
  static PathImage<F> of_contribution(const Spectrum<F>& contribution) {
    return {F(1.0f), usable_weight(average(contribution)), contribution};
  }
  Spectrum<F> contribution_at(int to, const PathSample<F>& value, Mask<F> on) const {
    const ReuseVertex<F>& first = vertices[std::size_t(to)];
    // Where surfaces move, a path with a different time cannot be shifted.
    const Mask<F> fits = on & ((value.time == first.time) | Mask<F>(!shared.scene.geometry.moves())) &
                         (first.events + value.events <= Uint<F>(shared.max_events));
    if (!any(fits)) return gray(F(0.0f));
    return PathReplay<F, Rays>(shared, first, value, fits, counts).contribution();
  }
};

}  // namespace montelux
