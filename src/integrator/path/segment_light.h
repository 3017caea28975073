// Light of lamps at one point that a medium scatters along a segment of a path. The event that the path draws there is
// near the lamp by chance alone, and light sampling from it has no finite variance: the irradiance grows with the
// inverse square of the distance. So a second event is drawn by the angle at which the lamp sees the segment (Kulla and
// Fajardo 2012), for this light alone, and both are combined by the balance heuristic.
#pragma once
#include "mc/mis.h"
#include "medium/equiangular.h"
#include "transport/transmittance.h"

namespace montelux {

// Of the stream of a segment; it differs from the streams of materials, whose numbers are small.
inline constexpr std::uint32_t segment_light_stream = 0x5bd1e995u;

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
        on_(Mask<F>(false)),
        chooser_(no_side()) {
    const Uint<F> medium = segment.media.medium;
    on_ = on & (max_component(scene.media.scattering<F>(medium)) > F(0.0f));
    // Lamps are chosen as light sampling does it at a point in the middle of the part that is seen.
    const F mean_free_path = F(float(spectrum_size)) / max(sum(scene.media.extinction<F>(medium)), F(1e-30f));
    chooser_ = segment.ray.o + segment.ray.d * (0.5f * min(segment.hit.t, mean_free_path));
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
  static F sum(const Spectrum<F>& s) { return average(s) * float(spectrum_size); }
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
  const Segment<F> segment_;
  const Spectrum<F> throughput_;
  Mask<F> on_;
  Vec3<F> chooser_;
};

}  // namespace montelux
