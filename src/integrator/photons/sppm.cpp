#include "integrator/photons/sppm.h"

#include <cmath>

#include "integrator/photons/filling.h"
#include "integrator/photons/gathering.h"

namespace montelux {

namespace {

// `in_media`: the scene has participating media.
template <class F, bool in_media>
class SppmSeries final : public FrameSeries {
 public:
  // What is referred to must outlive the series.
  SppmSeries(const Scene& scene, const Accel& accel, const SppmSettings& settings, const PhotonLights& lights,
             const SeriesPass& pass)
      : scene_(scene),
        accel_(accel),
        settings_(settings),
        pass_(pass),
        photons_(scene, accel, lights, pass, sppm_paths(settings, pass.bounds.area())) {}

  std::optional<std::size_t> units(const SeriesStep& step) const override {
    return step.stage < Photons::stages ? std::optional(photons_.units(step.stage)) : std::nullopt;
  }
  RayCounts run_unit(const SeriesStep& step, std::size_t unit) override {
    return photons_.run_unit(set_of(step.frame), step.stage, unit);
  }
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return run_layers(step, tile, out, {});
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    const PhotonSet set = set_of(step.frame);
    GatheringTallies tallies(pass_.layers, sums);
    const RayCounts counts =
        PhotonGathering<F, Accel, in_media>(scene_, accel_, settings_.gathering(), photons_.lookups(settings_.kernel),
                                            {}, tallies.get())
            .run({tile, pass_.points, pass_.shutter, std::uint32_t(step.frame), set.shutter_sample, pass_.grid}, out);
    const bool is_first = tile.x0 == pass_.bounds.x0 && tile.y0 == pass_.bounds.y0;
    if (is_first && photons_.take_broken()) show_broken(out, sums);
    return counts;
  }

 private:
  PhotonSet set_of(int frame) const {
    return {frame, float(sppm_radius(settings_.radius, settings_.alpha, frame)),
            float(sppm_radius(settings_.medium_radius, settings_.alpha, frame, 3)),
            shared_shutter_sample(scene_, pass_, frame)};
  }

  using Photons = PhotonFilling<F, Accel, in_media>;
  const Scene& scene_;
  const Accel& accel_;
  const SppmSettings& settings_;
  const SeriesPass pass_;
  Photons photons_;
};

}  // namespace

PhotonPaths sppm_paths(const SppmSettings& settings, int pixels) {
  return {light_paths(settings.photons, pixels), settings.nee ? 1u : 0u, settings.max_depth, settings.roulette_depth};
}

double sppm_radius(double radius, double alpha, int frame, int dimensions) {
  double content = dimensions == 3 ? radius * radius * radius : radius * radius;
  for (int i = 1; i <= frame; ++i) content *= (i + alpha) / (i + 1);
  return dimensions == 3 ? std::cbrt(content) : std::sqrt(content);
}

SppmIntegrator::SppmIntegrator(const Scene& scene, const Accel& accel, const SppmSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings), lights_(photon_lights(scene, accel)) {}

int SppmIntegrator::stages() const { return PhotonMap::stages + 1; }

std::unique_ptr<FrameSeries> SppmIntegrator::begin(const SeriesPass& pass) const {
  const auto make = [&]<class F, bool in_media>() -> std::unique_ptr<FrameSeries> {
    return std::make_unique<SppmSeries<F, in_media>>(scene_, accel_, settings_, lights_, pass);
  };
  const bool one = settings_.lanes == Lanes::one;
  if (scene_.has_participating_media())
    return one ? make.template operator()<float, true>() : make.template operator()<NativeFloats, true>();
  return one ? make.template operator()<float, false>() : make.template operator()<NativeFloats, false>();
}

}  // namespace montelux
