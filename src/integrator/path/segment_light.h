// Light of lamps at one point that a medium scatters along a segment of a path. The event that the path draws there is
// near the lamp by chance alone, and light sampling from it has no finite variance: the irradiance grows with the
// inverse square of the distance. So a second event is drawn by equiangular sampling of the segment (Kulla and
// Fajardo 2012), for this light alone, and both are combined by the balance heuristic.
#pragma once
#include <optional>

#include "mc/mis.h"
#include "medium/equiangular.h"
#include "transport/dimensions.h"
#include "transport/next_vertex.h"
#include "transport/transmittance.h"

namespace montelux {

template <class F>
class SegmentLight {
 public:
  // What the second event contributes to the path, in the lanes `on`.
  struct Sample {
    Spectrum<F> contribution;
    Uint<F> light;
    Mask<F> on;
  };

  // The segment, the throughput of the path at its start, and the lanes in which the path may scatter on it. Scene and
  // lights, some of which are at one point, must outlive this.
  SegmentLight(const Scene& scene, const LightSet& lights, const Segment<F>& segment, const Spectrum<F>& throughput,
               Mask<F> on)
      : scene_(scene),
        lights_(lights),
        segment_(segment),
        throughput_(throughput),
        on_(on & (max_component(scene.media.scattering<F>(segment.media.medium)) > F(0.0f))),
        chooser_(middle()) {}

  // The rays of these lanes are on their next segment, that of `next`, which differs from the present one there alone.
  void replace(Mask<F> on, const SegmentLight& next) {
    const Media<F> media = select_media<F>(on, next.segment_.media, segment_.media);
    segment_ = next.segment_, segment_.media = media;
    throughput_ = select(on, next.throughput_, throughput_);
    on_ = (on & next.on_) | (on_ & !on);
    chooser_ = select<F>(on, next.chooser_, chooser_);
  }

  // The share of the path's own event, at this distance from the segment's start, in the light of the lamp that
  // u_choice has chosen there: both densities are those of the event per unit of length, times the probability of the
  // lamp. 1 for other lights.
  __attribute__((noinline)) F share(const Vec3<F>& event, F distance, const LightSample<F>& light, F u_choice,
                                    Mask<F> on) const {
    Mask<F> two_ways = on & on_ & light.valid & light.delta;
    if (!any(two_ways)) return F(1.0f);
    const LightChoice<F> chosen = lights_.template choose<F>(event, no_side(), u_choice, two_ways);
    const LightPosition<F> lamp = lights_.template position<F>(chosen.light, two_ways & chosen.valid);
    two_ways = two_ways & lamp.exists;
    if (!any(two_ways)) return F(1.0f);
    return select(two_ways,
                  balance_weight(event_density(distance) * chosen.mass.value,
                                 along(lamp.p).density(distance) * mass(chosen.light, chooser_, two_ways)),
                  F(1.0f));
  }

  // `random` belongs to the segment. Adds the rays that are traced to `traced`.
  template <class Rays>
  __attribute__((noinline)) Sample sample(const Rays& rays, RandomStream<F> random, std::uint64_t& traced) const {
    const F u_choice = random.next(), u_distance = random.next();
    const LightChoice<F> chosen = lights_.template choose<F>(chooser_, no_side(), u_choice, on_);
    const LightPosition<F> lamp = lights_.template position<F>(chosen.light, on_ & chosen.valid);
    Sample s{gray(F(0.0f)), chosen.light, lamp.exists};
    if (!any(s.on)) return s;
    const EquiangularDistances<F> distances = along(lamp.p);
    const F distance = distances.sample(u_distance);
    const Vec3<F> event = segment_.ray.o + segment_.ray.d * distance;
    const LightSample<F> light =
        lights_.template sample_light<F>(chosen.light, event, no_side(), Vec2<F>{F(0.0f), F(0.0f)}, s.on);
    s.on = s.on & light.valid;
    const MediumSet& media = scene_.media;
    const Uint<F> medium = segment_.media.medium;
    const F density = distances.density(distance) * chosen.mass.value;
    const F share = balance_weight(density, event_density(distance) * mass(chosen.light, event, s.on));
    const F phase = media.phase<F>(medium).evaluate(-segment_.ray.d, light.wi).value;
    s.contribution = throughput_ * media.scattering<F>(medium) * segment_.media.left(distance) * light.radiance *
                     (phase * share / density);
    s.on = s.on & (max_component(s.contribution) > F(0.0f));
    if (!any(s.on)) return s;
    const Vec3<F> exact{F(0.0f), F(0.0f), F(0.0f)};
    const Ray<F> ray = shadow_ray(event, exact, exact, light.wi, light.distance, segment_.ray.time);
    s.contribution = s.contribution * transmittance<F>(scene_, rays, ray, segment_.media, s.on, random, traced);
    s.on = s.on & !is_black(s.contribution);
    return s;
  }

 private:
  static Vec3<F> no_side() { return {F(0.0f), F(0.0f), F(0.0f)}; }
  // Of the part of the segment that is seen. Lamps are chosen as light sampling does it there.
  Vec3<F> middle() const {
    const F extinction = average(scene_.media.extinction<F>(segment_.media.medium)) * float(spectrum_size);
    const F mean_free_path = F(float(spectrum_size)) / max(extinction, F(1e-30f));
    return segment_.ray.o + segment_.ray.d * (0.5f * min(segment_.hit.t, mean_free_path));
  }
  F mass(Uint<F> light, const Vec3<F>& p, Mask<F> on) const {
    return lights_.template choice_mass<F>(light, p, no_side(), on).value;
  }
  EquiangularDistances<F> along(const Vec3<F>& lamp) const {
    return {segment_.ray.o, segment_.ray.d, segment_.hit.t, lamp};
  }
  F event_density(F distance) const {
    return scene_.media.event_density<F>(segment_.media.medium, throughput_, distance);
  }

  const Scene& scene_;
  const LightSet& lights_;
  Segment<F> segment_;
  Spectrum<F> throughput_;
  Mask<F> on_;
  Vec3<F> chooser_;
};

// The second events on all segments of rays that go straight on through interfaces up to one vertex, as
// ReportedDistances has them. add(SegmentLight<F>::Sample) receives what each event contributes.
template <class F, class Rays, class Add>
class RaySegmentLights {
 public:
  // `on`: where paths may scatter. Without lights at one point nothing happens. What is referred to must outlive this;
  // rays that are traced are added to `traced`.
  RaySegmentLights(const Scene& scene, const Rays& rays, Mask<F> on, std::uint64_t& traced, Add add)
      : scene_(scene), rays_(rays), on_(on), traced_(traced), add_(add) {}

  void begin(const Segment<F>& segment, const Spectrum<F>& throughput, Mask<F> on, const RandomStream<F>& random) {
    if (!scene_.lights.has_points()) return;
    const SegmentLight<F> light(scene_, scene_.lights, segment, throughput, on & on_);
    if (const auto sample = light.sample(rays_, random.fork(Uint<F>(vertex_stream::segment_light)), traced_);
        any(sample.on))
      add_(sample);
    if (last_)
      last_->replace(on, light);
    else
      last_.emplace(light);
  }
  // As SegmentLight::share(), of an event on a ray's last segment.
  F share(const Vec3<F>& event, F distance, const LightSample<F>& light, F u_choice, Mask<F> on) const {
    return last_ ? last_->share(event, distance, light, u_choice, on) : F(1.0f);
  }

 private:
  const Scene& scene_;
  const Rays& rays_;
  const Mask<F> on_;
  std::uint64_t& traced_;
  Add add_;
  std::optional<SegmentLight<F>> last_;
};

}  // namespace montelux
