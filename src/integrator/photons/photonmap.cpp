#include "integrator/photons/photonmap.h"

#include <algorithm>
#include <cmath>

#include "integrator/photons/filling.h"
#include "integrator/photons/gathering.h"

namespace montelux {

namespace {

// Photons of the global map: where it is looked up beyond the surfaces in view, direct light is among them.
PhotonPaths global_paths(const PhotonMapSettings& settings, int pixels) {
  const bool direct = settings.gather_rays > 0 || !settings.nee;
  return {light_paths(settings.photons, pixels), direct ? 0u : 1u, settings.max_depth, settings.roulette_depth, {}};
}
PhotonPaths caustic_paths(const PhotonMapSettings& settings, int pixels) {
  return {light_paths(settings.caustic_photons, pixels), settings.nee ? 1u : 0u, settings.max_depth,
          settings.roulette_depth, settings.glossy};
}

template <class F>
class PhotonMapSeries final : public FrameSeries {
 public:
  using Photons = PhotonFilling<F, Accel>;
  // What is referred to must outlive the series.
  PhotonMapSeries(const Scene& scene, const Accel& accel, const PhotonMapSettings& settings,
                  const std::optional<AliasTable>& by_power, const SeriesPass& pass)
      : scene_(scene),
        accel_(accel),
        settings_(settings),
        pass_(pass),
        global_(scene, accel, by_power, pass, global_paths(settings, pass.bounds.area())) {
    if (settings.gather_rays > 0)
      caustics_.emplace(scene, accel, by_power, pass, caustic_paths(settings, pass.bounds.area()));
  }

  // The units of the global map, then those of the map of caustics. Where nothing moves, all frames share the maps.
  std::optional<std::size_t> units(const SeriesStep& step) const override {
    if (step.stage >= Photons::stages) return std::nullopt;
    if (step.frame > 0 && !shutter_sample(step)) return 0;
    return global_.units(step.stage) + (caustics_ ? caustics_->units(step.stage) : 0);
  }
  RayCounts run_unit(const SeriesStep& step, std::size_t unit) override {
    const std::size_t of_global = global_.units(step.stage);
    if (unit < of_global)
      return global_.run_unit({2 * step.frame, settings_.radius, shutter_sample(step)}, step.stage, unit);
    return caustics_->run_unit({2 * step.frame + 1, settings_.caustic_radius, shutter_sample(step)}, step.stage,
                               unit - of_global);
  }
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return run_layers(step, tile, out, {});
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    const PhotonLookup global = lookup(global_);
    const TilePass pass{tile, pass_.points, pass_.shutter, std::uint32_t(step.frame), shutter_sample(step), pass_.grid};
    GatheringTallies tallies(pass_.layers, sums);
    PhotonGathering<F, Accel> gathering(scene_, accel_, settings_.gathering(), caustics_ ? lookup(*caustics_) : global,
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
  PhotonLookup lookup(const Photons& photons) const {
    return {photons.map(), settings_.kernel, settings_.nearest, photons.light_of_path()};
  }

  const Scene& scene_;
  const Accel& accel_;
  const PhotonMapSettings& settings_;
  const SeriesPass pass_;
  Photons global_;
  std::optional<Photons> caustics_;  // of final gathering
};

}  // namespace

float radius_by_photons(const Scene& scene, const Accel& accel, const PhotonMapSettings& settings, int pixels) {
  using F = NativeFloats;
  constexpr std::uint32_t pilot_paths = 4096;
  constexpr std::size_t places = 256, neighbours = 8;
  constexpr double usual = 64;   // photons, where all within the radius count
  constexpr double spare = 1.5;  // of the radius, where the nearest photons are counted
  const float diagonal = scene.bounds.is_empty() ? 1.0f : length(scene.bounds.high - scene.bounds.low);
  const float largest_radius = std::max(0.1f * diagonal, 1e-6f);
  if (scene.lights.count() == 0) return largest_radius;

  const PhotonPaths wanted = global_paths(settings, pixels);
  const AliasTable by_power = scene.lights.by_power();
  PointSet points;
  points.samples_per_pass = pilot_paths, points.seed = 0x510e527fu;
  const LightWalkScene<Accel> walk{scene,         accel, by_power,         points,
                                   scene.shutter, 0.5f,  wanted.max_depth, wanted.roulette_depth};
  std::vector<Photon> photons;
  PhotonSink<F> sink(photons, wanted.first_event, 1);
  RayCounts counts;
  LightWalk<F, Accel, PhotonSink<F>>(walk, sink, counts).run(pilot_paths, [](std::uint32_t i) {
    return PathSite<float>{0, 0, i};
  });

  // The areas of the disks around some photons that hold their nearest neighbours.
  std::vector<float> squared;
  for (std::size_t i = 0; i < std::min(places, photons.size()); ++i) {
    const Photon& at = photons[i * photons.size() / std::min(places, photons.size())];
    std::vector<float> distances;
    for (const Photon& other : photons)
      if (std::abs(dot(other.ng, at.ng)) > similar_normals) {
        const Vec3f way = other.p - at.p;
        const float d2 = dot(way, way), height = dot(way, at.ng);
        if (height * height <= similar_height * similar_height * d2) distances.push_back(d2);
      }
    if (distances.size() <= neighbours) continue;
    const auto last = distances.begin() + neighbours;  // after the photon itself
    std::nth_element(distances.begin(), last, distances.end());
    squared.push_back(*last);
  }
  if (squared.empty()) return largest_radius;
  const auto middle = squared.begin() + std::ptrdiff_t(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  const double share = double(pilot_paths) / double(wanted.count) / double(neighbours);
  const bool counted = settings.nearest > 0;
  const double held = counted ? double(settings.nearest) : usual;
  const double radius = (counted ? spare : 1) * std::sqrt(double(*middle) * share * held);
  return float(std::clamp(radius, 1e-6 * double(diagonal), double(largest_radius)));
}

PhotonMapIntegrator::PhotonMapIntegrator(const Scene& scene, const Accel& accel, const PhotonMapSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  if (scene.lights.count() > 0) by_power_ = scene.lights.by_power();
}

int PhotonMapIntegrator::stages() const { return PhotonFilling<float, Accel>::stages + 1; }

std::unique_ptr<FrameSeries> PhotonMapIntegrator::begin(const SeriesPass& pass) const {
  if (settings_.lanes == Lanes::one)
    return std::make_unique<PhotonMapSeries<float>>(scene_, accel_, settings_, by_power_, pass);
  return std::make_unique<PhotonMapSeries<NativeFloats>>(scene_, accel_, settings_, by_power_, pass);
}

}  // namespace montelux
