// A photon map that fills: in stages, each by many threads, with a barrier between two.
#pragma once
#include <algorithm>
#include <optional>

#include "integrator/photons/settings.h"
#include "integrator/photons/tracing.h"

namespace montelux {

// The light paths of one map.
struct PhotonPaths {
  std::uint32_t count;
  std::uint32_t first_event;     // photons that fewer events have scattered are not stored
  std::optional<int> max_depth;  // scattering events between the light and the camera
  int roulette_depth;
  // Paths end at events in directions which paths from the eye would not follow backwards, those whose density is below
  // this: their photons are those of caustics. None: all paths continue.
  std::optional<float> caustics{};
};

// As many light paths as a setting states; 0: one for each pixel, and at least min_photons.
inline std::uint32_t light_paths(int setting, int pixels) {
  return std::uint32_t(setting > 0 ? setting : std::max(pixels, min_photons));
}

// The photons of one set of light paths.
struct PhotonSet {
  int number = 0;                         // sets of different numbers have different paths
  float radius = 0;                       // within which photons are looked up
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

template <class F, class Rays>
class PhotonFilling {
 public:
  static constexpr int stages = PhotonMap::stages;

  // What is referred to must outlive this.
  PhotonFilling(const Scene& scene, const Rays& rays, const std::optional<AliasTable>& by_power, const SeriesPass& pass,
                const PhotonPaths& paths)
      : scene_(scene),
        rays_(rays),
        by_power_(by_power),
        pass_(pass),
        paths_(paths),
        map_(2 * std::size_t(paths.count), units_of_light_paths(paths.count), pass.layers != nullptr),
        light_of_path_(pass.layers ? paths.count : 0) {}

  // The units of a stage, and one of them.
  std::size_t units(int stage) const { return map_.units(stage); }
  RayCounts run_unit(const PhotonSet& set, int stage, std::size_t unit) {
    return map_.run_unit(stage, unit, set.radius,
                         [&](std::vector<Photon>& box) { return follow_light(set, unit, box); });
  }
  const PhotonMap& map() const { return map_; }
  // By the number of a light path the light where it starts; null in a pass without layers.
  const std::uint32_t* light_of_path() const { return light_of_path_.empty() ? nullptr : light_of_path_.data(); }
  // Whether the flux of a path was not a number since the last time.
  bool take_broken() { return broken_.take() > 0; }

 private:
  RayCounts follow_light(const PhotonSet& set, std::size_t unit, std::vector<Photon>& box) {
    RayCounts counts;
    if (!by_power_) return counts;
    const LightPathPart part = light_path_part(unit, paths_.count);
    const LightWalkScene<Rays> walk{scene_,
                                    rays_,
                                    *by_power_,
                                    photon_points(pass_.points, set.number, paths_.count),
                                    pass_.shutter.value_or(scene_.shutter),
                                    set.shutter_sample,
                                    paths_.max_depth,
                                    paths_.roulette_depth};
    const auto follow = [&](auto sink) {
      LightWalk<F, Rays, decltype(sink)>(walk, sink, counts).run(part.count, [&](std::uint32_t i) {
        return PathSite<float>{0, 0, part.first + i};
      });
      if (sink.broken() > 0) broken_.next();
    };
    PhotonSink<F> all(box, paths_.first_event, 1 / float(paths_.count),
                      light_of_path_.empty() ? nullptr : light_of_path_.data());
    if (paths_.caustics)
      follow(CausticSink<F>(all, *paths_.caustics));
    else
      follow(all);
    return counts;
  }

  const Scene& scene_;
  const Rays& rays_;
  const std::optional<AliasTable>& by_power_;
  const SeriesPass pass_;
  const PhotonPaths paths_;
  SharedCount broken_;  // parts with a flux that is not a number
  PhotonMap map_;
  std::vector<std::uint32_t> light_of_path_;
};

}  // namespace montelux
