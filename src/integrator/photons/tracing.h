// Photons: what light paths leave at rough surfaces and at events in media.
#pragma once
#include <algorithm>
#include <limits>
#include <optional>

#include "integrator/light_paths/walk.h"
#include "integrator/photons/photon_map.h"

namespace montelux {

// Where photons of events in media go.
struct MediumBox {
  const MediumSet& media;
  std::vector<Photon>& box;
};

// Stores the photons of paths that the walk shows.
template <class F>
class PhotonSink {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // Photons that fewer events have scattered are not stored. `scale`: one over the number of paths. `light_of_path`:
  // receives by the number of a path the light where it starts; null: nobody needs it. `in_media`: none: the walk has
  // no events in media.
  PhotonSink(std::vector<Photon>& box, std::uint32_t first_event, float scale, std::uint32_t* light_of_path = nullptr,
             const std::optional<MediumBox>& in_media = {})
      : box_(box), first_event_(first_event), scale_(scale), light_of_path_(light_of_path), in_media_(in_media) {}

  struct Query {
    Vec3<F> toward;
    M on;
  };
  void leave(const LightPathStart<F>& s, M on) {
    if (!light_of_path_) return;
    for_each_lane(on, [&](int k) { light_of_path_[lane(s.site.index, k)] = lane(s.choice.index, k); });
  }
  Query query(const LightPathVertex<F>& v, M) const { return {v.at.wo, M(false)}; }
  void visit(const LightPathVertex<F>& v, const Query&, const BsdfValue<F>&, M on) {
    const M stored = on & !v.at.bsdf.is_delta & (v.path.depth >= U(first_event_));
    const Spectrum<F> flux = v.path.flux * scale_;
    store(v, flux, stored & !v.at.in_medium, box_);
    if (!in_media_) return;
    const Spectrum<F> scattering = in_media_->media.template scattering<F>(v.at.media.along_wo().medium);
    Spectrum<F> over_scattering;
    for (int c = 0; c < spectrum_size; ++c)
      over_scattering.c[c] = select(scattering.c[c] > F(0.0f), flux.c[c] / scattering.c[c], F(0.0f));
    store(v, over_scattering, stored & v.at.in_medium, in_media_->box);
  }
  void broken(F, const PathSite<F>&, M on) { broken_ += std::uint64_t(count(on)); }
  // Paths ended because their flux was not finite.
  std::uint64_t broken() const { return broken_; }

 private:
  static void store(const LightPathVertex<F>& v, const Spectrum<F>& flux, M on, std::vector<Photon>& box) {
    for_each_lane(on, [&](int k) {
      box.push_back({lane(v.at.x.point.p, k), lane(-v.at.d, k), lane(v.at.x.point.ng, k), lane(flux, k),
                     lane(v.path.depth, k), lane(v.path.site.index, k)});
    });
  }

  std::vector<Photon>& box_;
  const std::uint32_t first_event_;
  const float scale_;
  std::uint32_t* light_of_path_;
  const std::optional<MediumBox> in_media_;
  std::uint64_t broken_ = 0;
};

// Stores the photons of caustics: those that came to their surface by events alone in directions which a path from the
// eye would follow, at mirrors, smooth glass and glossy surfaces. Other events end the path.
// `in_media`: the scene has participating media.
template <class F, bool in_media = false>
class CausticSink : public PhotonSink<F> {
 public:
  // `glossy`: density per steradian above which paths from the eye follow a direction.
  CausticSink(const Scene& scene, const PhotonSink<F>& all, float glossy)
      : PhotonSink<F>(all), scene_(scene), glossy_(glossy) {}

  Mask<F> follows(const LightPathVertex<F>& v, const BsdfSample<F>& next, Mask<F> on) const {
    // A path from the eye arrives along `next` and samples the direction toward the light.
    BsdfContext<F> context = v.at.context;
    context.mode = TransportMode::radiance;
    const Density<SolidAngle, F> reverse =
        evaluate_at<F, in_media>(scene_, v.at, next.wi, v.at.wo, context, on & !next.delta).density;
    return next.delta | (reverse.value > F(glossy_));
  }

 private:
  const Scene& scene_;
  const float glossy_;
};

// Light paths are traced in parts of so many, each a unit of work.
inline constexpr std::uint32_t light_paths_per_unit = 1024;
inline std::size_t units_of_light_paths(std::uint32_t paths) {
  return (std::size_t(paths) + light_paths_per_unit - 1) / light_paths_per_unit;
}
// The paths of one of these parts.
struct LightPathPart {
  std::uint32_t first, count;
};
inline LightPathPart light_path_part(std::size_t unit, std::uint32_t paths) {
  const std::uint32_t first = std::uint32_t(unit) * light_paths_per_unit;
  return {first, std::min(light_paths_per_unit, paths - first)};
}

// The points of the light paths of a frame: one set for all of them, and none of those of the paths from the eye.
inline PointSet photon_points(PointSet points, int frame, std::uint32_t paths) {
  if (points.kind != PointSetKind::independent && !is_fixed(points.kind)) points.kind = PointSetKind::padded_sobol;
  points.samples_per_pass = paths;
  points.seed = mix_bits(points.seed ^ mix_bits(std::uint32_t(frame) + 0x3c6ef372u));
  return points;
}

}  // namespace montelux
