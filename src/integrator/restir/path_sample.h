// A path beyond a pixel's vertex as other pixels reuse it: the random numbers to replay up to the reconnection vertex,
// and what is kept from there (Lin et al. 2022, sec. 7: the hybrid shift).
//
// Paths are counted in a measure that all pixels share: the random numbers of the events that are scattered again, then
// the area of the surface (or the measure of the light point) to which the path is joined, then the solid angle in
// which it continues there. A shift leaves all of these as they are, so that its Jacobian is 1; the densities and
// cosines that other authors put into Jacobians are part of the target here.
#pragma once
#include "integrator/restir/settings.h"
#include "integrator/restir/vertex.h"
#include "transport/dimensions.h"

namespace montelux {

// How the part that is kept begins.
namespace path_end {
inline constexpr std::uint32_t surface = 0;  // at a surface, from which it continues in a kept direction
inline constexpr std::uint32_t light = 1;    // at a point of a light
inline constexpr std::uint32_t met = 2;  // nowhere: all is scattered again, and the last event, a delta, meets light
}  // namespace path_end

// Made of 32-bit words alone.
template <class F>
struct PathSample {
  RandomStream<F> numbers;  // of the events
  Uint<F> replayed;         // events that are scattered again
  Uint<F> events;           // in all, from the pixel's vertex to the light
  Uint<F> end;              // of path_end
  StoredSurface<F> at;      // path_end::surface: the surface, the direction from there, and what comes along it
  Vec3<F> wi;
  Spectrum<F> arriving;
  LightPoint<F> point;       // path_end::light
  F time;                    // at which all its rays are traced
  Spectrum<F> contribution;  // to the vertex of the pixel that has it, which the target is the mean of
};

// As for WeightedReservoir, in lanes.
template <class F>
MONTELUX_INLINE PathSample<F> select(Mask<F> m, const PathSample<F>& a,
                                     const PathSample<F>& b) requires(lanes_of<F> > 1) {
  return select_words(m, a, b);
}

template <class F>
using PathReservoir = Reservoir<PathSample<F>, F>;

// Which numbers of a path's stream decide what.
template <class F>
struct EventNumbers {
  RandomStream<F> stream;  // of one event
  EventNumbers(const RandomStream<F>& path, Uint<F> event) : stream(path.fork(event)) {}

  Vec3<F> direction() const { return {at(0), at(1), at(2)}; }
  F roulette() const { return at(3); }
  F choice(std::uint32_t candidate) const { return at(4 + candidate); }
  RandomStream<F> model() const { return stream.fork(Uint<F>(event_stream::model)); }
  RandomStream<F> light() const { return stream.fork(Uint<F>(event_stream::light)); }
  RandomStream<F> surface() const { return stream.fork(Uint<F>(event_stream::surface)); }

 private:
  F at(std::uint32_t place) const { return stream.at(Uint<F>(place)); }
};

// One scattering event.
template <class F>
struct PathEvent {
  Vec3<F> wi;                      // of the world
  Spectrum<F> f_cos;               // 0 for a delta
  Density<SolidAngle, F> density;  // 0 for a delta
  Spectrum<F> weight;              // f_cos / density, or that of the delta
  F eta_scale;
  Mask<F> valid, delta;
};

// `next` as the vertex has sampled it. A model whose value is an estimate has one value here, for all pixels.
template <class F>
PathEvent<F> event_at(const ReuseVertex<F>& vertex, const BsdfSample<F>& next, Mask<F> on) {
  const Vec3<F> wi = vertex.frame.to_world(next.wi);
  const Mask<F> valid = on & next.valid, spread = valid & !next.delta, delta = valid & next.delta;
  const BsdfValue<F> value = vertex.scattered(wi, spread);
  const F density = select(spread, value.density.value, F(0.0f));
  const Mask<F> has_density = density > F(0.0f), continues = delta | has_density;
  const Spectrum<F> weight = select(has_density, value.f_cos * (1.0f / select(has_density, density, F(1.0f))),
                                    select(delta, next.weight, gray(F(0.0f))));
  return {wi, select(spread, value.f_cos, gray(F(0.0f))), {density}, weight, next.eta_scale, continues, delta};
}

// Whether two pixels may share the surface to which a path is joined: both lobes, as wide as they are at the distance
// of the joined points, must cover much more than the distance between pixels, or the shared path would contribute next
// to nothing to any but its own (cf. Lin et al. 2022, sec. 7.3, by roughness and distance).
template <class F>
struct Leg {
  F squared_length;
  F spread;  // of the first lobe on the second surface, 1/area: density times cosine; infinite for a narrow one
  F pixels;  // squared distance that the lobes must cover

  Mask<F> is_wide(const Density<SolidAngle, F>& there) const {
    return (spread * pixels <= squared_length) & (there.value * pixels <= squared_length);
  }
};

// From a vertex to a surface; `density` is that of the direction at the vertex, in the lanes `spread`: others have a
// delta there, or cannot share the surface.
template <class F>
Leg<F> leg_between(const Vec3<F>& p, const Vec3<F>& to, const Vec3<F>& ng, const Vec3<F>& d,
                   const Density<SolidAngle, F>& density, Mask<F> spread, F pixels) {
  const F on_surface = density.value * abs(dot(ng, d));
  return {dot(to - p, to - p), select(spread, on_surface, F(std::numeric_limits<float>::infinity())), pixels};
}
// To a surface that turns to the ray there is no leg that could be joined: other pixels would meet another surface.
template <class F>
Leg<F> leg_between(const Vec3<F>& p, const SurfaceHit<F>& to, const Vec3<F>& d, const Density<SolidAngle, F>& density,
                   Mask<F> spread, F pixels) {
  return leg_between<F>(p, to.point.p, to.point.ng, d, density, spread & !to.ray_facing, pixels);
}

}  // namespace montelux
