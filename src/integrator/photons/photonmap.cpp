#include "integrator/photons/photonmap.h"

#include "integrator/photons/filling.h"
#include "integrator/photons/gathering.h"

namespace montelux {

namespace {

PhotonPaths caustic_paths(const PhotonMapSettings& settings, int pixels) {
  return {light_paths(settings.caustic_photons, pixels), settings.nee ? 1u : 0u, settings.max_depth,
          settings.roulette_depth, settings.glossy};
}

// `in_media`: the scene has participating media.
template <class F, bool in_media>
class PhotonMapSeries final : public FrameSeries {
 public:
  using Photons = PhotonFilling<F, Accel, in_media>;
  // What is referred to must outlive the series.
  PhotonMapSeries(const Scene& scene, const Accel& accel, const PhotonMapSettings& settings, const PhotonLights& lights,
                  const SeriesPass& pass)
      : scene_(scene),
        accel_(accel),
        settings_(settings),
        pass_(pass),
        global_(scene, accel, lights, pass, global_paths(settings, pass.bounds.area())) {
    if (settings.gather_rays > 0)
      caustics_.emplace(scene, accel, lights, pass, caustic_paths(settings, pass.bounds.area()));
  }

  // The units of the global map, then those of the map of caustics. Where nothing moves, all frames share the maps.
  std::optional<std::size_t> units(const SeriesStep& step) const override {
    if (step.stage >= Photons::stages) return std::nullopt;
    if (step.frame > 0 && !shutter_sample(step)) return 0;
    return global_.units(step.stage) + (caustics_ ? caustics_->units(step.stage) : 0);
  }
  RayCounts run_unit(const SeriesStep& step, std::size_t unit) override {
    const std::size_t of_global = global_.units(step.stage);
    if (unit < of_global) return global_.run_unit(photon_set(2 * step.frame, settings_.radius, step), step.stage, unit);
    return caustics_->run_unit(photon_set(2 * step.frame + 1, settings_.caustic_radius, step), step.stage,
                               unit - of_global);
  }
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return run_layers(step, tile, out, {});
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    const PhotonLookups global = lookups(global_);
    const TilePass pass{tile, pass_.points, pass_.shutter, std::uint32_t(step.frame), shutter_sample(step), pass_.grid};
    GatheringTallies tallies(pass_.layers, sums);
    PhotonGathering<F, Accel, in_media> gathering(scene_, accel_, settings_.gathering(),
                                                  caustics_ ? lookups(*caustics_) : global,
                                                  caustics_ ? std::optional(global) : std::nullopt, tallies.get());
    const RayCounts counts = gathering.run(pass, out);
    const bool is_first = tile.x0 == pass_.bounds.x0 && tile.y0 == pass_.bounds.y0;
    if (is_first && (global_.take_broken() || (caustics_ && caustics_->take_broken()))) show_broken(out, sums);
    return counts;
  }

 private:
  std::optional<float> shutter_sample(const SeriesStep& step) const {
    return shared_shutter_sample(scene_, pass_, step.frame);
  }
  PhotonSet photon_set(int number, float radius, const SeriesStep& step) const {
    return {number, radius, settings_.medium_radius, shutter_sample(step)};
  }
  PhotonLookups lookups(const Photons& photons) const { return photons.lookups(settings_.kernel, settings_.nearest); }

  const Scene& scene_;
  const Accel& accel_;
  const PhotonMapSettings& settings_;
  const SeriesPass pass_;
  Photons global_;
  std::optional<Photons> caustics_;  // of final gathering
};

}  // namespace

PhotonPaths global_paths(const PhotonMapSettings& settings, int pixels) {
  const bool direct = settings.gather_rays > 0 || !settings.nee;
  return {light_paths(settings.photons, pixels), direct ? 0u : 1u, settings.max_depth, settings.roulette_depth, {}};
}

PhotonMapIntegrator::PhotonMapIntegrator(const Scene& scene, const Accel& accel, const PhotonMapSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings), lights_(photon_lights(scene, accel)) {}

int PhotonMapIntegrator::stages() const { return PhotonFilling<float, Accel>::stages + 1; }

std::unique_ptr<FrameSeries> PhotonMapIntegrator::begin(const SeriesPass& pass) const {
  const auto make = [&]<class F, bool in_media>() -> std::unique_ptr<FrameSeries> {
    return std::make_unique<PhotonMapSeries<F, in_media>>(scene_, accel_, settings_, lights_, pass);
  };
  const bool one = settings_.lanes == Lanes::one;
  if (scene_.has_participating_media())
    return one ? make.template operator()<float, true>() : make.template operator()<NativeFloats, true>();
  return one ? make.template operator()<float, false>() : make.template operator()<NativeFloats, false>();
}

}  // namespace montelux
