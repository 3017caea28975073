// A photon map that fills: in stages, each by many threads, with a barrier between two.
#pragma once
#include <algorithm>
#include <optional>

#include "integrator/photons/lights.h"
#include "integrator/photons/lookup.h"
#include "integrator/photons/settings.h"
#include "integrator/photons/tracing.h"

namespace montelux {

// The photons of one set of light paths.
struct PhotonSet {
  int number = 0;                         // sets of different numbers have different paths
  float radius = 0;                       // within which photons of surfaces are looked up
  float medium_radius = 0;                // the same in media
  std::optional<float> shutter_sample{};  // in [0, 1), of the exposure; none: each path has its own
};

// All photons of a frame have one time where surfaces move. The times of the frames are spread over the exposure as
// the samples of a pixel are.
inline std::optional<float> shared_shutter_sample(const Scene& scene, const SeriesPass& pass, int frame) {
  if (!scene.moves()) return std::nullopt;
  return Sampler<float>(pass.points, 0, 0, std::uint32_t(frame)).get1(path_dimension::time);
}

// A flux that is not a number has no place in the picture: it shows in the first pixel.
// `sums`: of the layers of the tile, as FrameSeries::run_layers() has them; empty without layers.
inline void show_broken(std::span<PixelSample> out, std::span<ExactRgb> sums) {
  out[0].radiance = gray_rgb(std::numeric_limits<float>::quiet_NaN());
  std::fill_n(sums.begin(), sums.size() / out.size(), ExactRgb{});
}

// `in_media`: the scene has participating media, whose photons fill a map of their own.
template <class F, class Rays, bool in_media = false>
class PhotonFilling {
 public:
  static constexpr int stages = PhotonMap::stages;

  // What is referred to must outlive this.
  PhotonFilling(const Scene& scene, const Rays& rays, const PhotonLights& lights, const SeriesPass& pass,
                const PhotonPaths& paths)
      : scene_(scene),
        rays_(rays),
        lights_(lights),
        pass_(pass),
        paths_(paths),
        map_(units_of_light_paths(paths.count), pass.layers != nullptr),
        light_of_path_(pass.layers ? paths.count : 0) {
    if constexpr (in_media) of_media_.emplace(units_of_light_paths(paths.count), pass.layers != nullptr);
  }

  // The units of a stage, and one of them.
  std::size_t units(int stage) const { return map_.units(stage); }
  RayCounts run_unit(const PhotonSet& set, int stage, std::size_t unit) {
    const auto surfaces = [&](const std::optional<MediumBox>& events) {
      return map_.run_unit(stage, unit, set.radius,
                           [&](std::vector<Photon>& box) { return follow_light(set, unit, box, events); });
    };
    if constexpr (!in_media) return surfaces({});
    // One walk fills a box of each map, in the first stage; the others have nothing in common.
    if (stage > 0) surfaces({});
    return of_media_->run_unit(stage, unit, set.medium_radius, [&](std::vector<Photon>& box) {
      return surfaces(MediumBox{scene_.media, box});
    });
  }
  const PhotonMap& map() const { return map_; }
  // As paths from the eye look the photons up; the arguments are those of PhotonLookup.
  PhotonLookups lookups(PhotonKernel kernel, int nearest = 0) const {
    PhotonLookups all{PhotonLookup(map_, kernel, nearest, light_of_path())};
    if (of_media_) all.media.emplace(*of_media_, kernel, nearest, light_of_path());
    return all;
  }
  // By the number of a light path the light where it starts; null in a pass without layers.
  const std::uint32_t* light_of_path() const { return light_of_path_.empty() ? nullptr : light_of_path_.data(); }
  // Whether the flux of a path was not a number since the last time.
  bool take_broken() { return broken_.take() > 0; }

 private:
  RayCounts follow_light(const PhotonSet& set, std::size_t unit, std::vector<Photon>& box,
                         const std::optional<MediumBox>& events) {
    RayCounts counts;
    if (!lights_.by_power) return counts;
    const LightPathPart part = light_path_part(unit, paths_.count);
    const LightWalkScene<Rays> walk{scene_,
                                    rays_,
                                    *lights_.by_power,
                                    photon_points(pass_.points, set.number, paths_.count),
                                    pass_.shutter.value_or(scene_.shutter),
                                    set.shutter_sample,
                                    paths_.max_depth,
                                    paths_.roulette_depth,
                                    Densities::for_weights,
                                    lights_.media ? &*lights_.media : nullptr};
    const auto follow = [&](auto sink) {
      using Walk = LightWalk<F, Rays, decltype(sink), AdjointCorrection, in_media>;
      Walk(walk, sink, counts).run(part.count, [&](std::uint32_t i) { return PathSite<float>{0, 0, part.first + i}; });
      if (sink.broken() > 0) broken_.next();
    };
    PhotonSink<F> all(box, paths_.first_event, 1 / float(paths_.count),
                      light_of_path_.empty() ? nullptr : light_of_path_.data(), events);
    if (paths_.caustics)
      follow(CausticSink<F, in_media>(scene_, all, *paths_.caustics));
    else
      follow(all);
    return counts;
  }

  const Scene& scene_;
  const Rays& rays_;
  const PhotonLights& lights_;
  const SeriesPass pass_;
  const PhotonPaths paths_;
  SharedCount broken_;  // parts with a flux that is not a number
  PhotonMap map_;
  std::optional<PhotonMap> of_media_;  // events; if in_media
  std::vector<std::uint32_t> light_of_path_;
};

}  // namespace montelux
