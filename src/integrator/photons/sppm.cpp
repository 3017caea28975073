#include "integrator/photons/sppm.h"

#include <algorithm>
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

float radius_by_footprint(const Scene& scene, const Accel& accel, int width, int height) {
  using F = float;
  constexpr std::uint32_t rays = 256;
  constexpr int deepest = 16;
  constexpr double pixels = 3;
  const RandomStream<float> all(0x510e527fu, 0x9b05688cu);
  std::vector<double> footprints;
  for (std::uint32_t i = 0; i < rays; ++i) {
    RandomStream<float> random = all.fork(i);
    const Vec2f place = random.next2(), lens = random.next2();
    const float time = scene.shutter.time(random.next());
    const Ray<float> eye =
        scene.camera.generate(Vec2f{place.x * float(width), place.y * float(height)}, lens, time).ray;
    std::uint64_t traced = 0;
    const auto [found, hit] = accel.trace<F>(eye, true, RayUse::camera);
    const NextVertex<F> first =
        follow_ray<F>(scene, accel, free_point(eye.o), eye, hit, found, random.fork(0), traced, NoWeight{});
    if (!first.found) continue;
    const float across = scene.camera.toward(first.x.point.p, lens, time).across.value;
    float way = first.distance;
    std::optional<NextVertex<F>> at = first;
    for (int depth = 1; at->found && at->bsdf.is_delta && depth <= deepest; ++depth) {
      const Vec2f u = random.next2();
      const BsdfSample<F> next = sample<F>(at->bsdf.lanes(true), at->wo, {random.next(), u.x, u.y}, at->context);
      if (!next.valid) break;
      const Ray<F> ray = at->ray_toward(at->bsdf.frame.to_world(next.wi));
      at.emplace(next_vertex<F>(scene, accel, free_point(ray.o), ray, true, random.fork(std::uint32_t(depth)), traced,
                                NoWeight{}));
      if (at->found) way += at->distance;
    }
    // Flat mirrors continue the cone of a pixel.
    const double growth = scene.camera.sees_directions() ? double(way) / double(first.distance) : 1;
    if (across > 0 && first.distance > 0) footprints.push_back(growth / std::sqrt(double(across)));
  }
  const float diagonal = scene.bounds.is_empty() ? 1.0f : length(scene.bounds.high - scene.bounds.low);
  const double largest_radius = std::max(0.01 * double(diagonal), 1e-6);
  if (footprints.empty()) return float(largest_radius);
  const auto middle = footprints.begin() + std::ptrdiff_t(footprints.size() / 2);
  std::nth_element(footprints.begin(), middle, footprints.end());
  return float(std::min(pixels * *middle, largest_radius));
}

SppmIntegrator::SppmIntegrator(const Scene& scene, const Accel& accel, const SppmSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings), lights_(photon_lights(scene, accel)) {}

std::unique_ptr<FrameSeries> SppmIntegrator::begin(const SeriesPass& pass) const {
  const auto make = [&]<class F, bool in_media>() -> std::unique_ptr<FrameSeries> {
    return std::make_unique<SppmSeries<F, in_media>>(scene_, accel_, settings_, lights_, pass);
  };
  const bool one = settings_.lanes == Lanes::one;
  if (!scene_.media.empty())
    return one ? make.template operator()<float, true>() : make.template operator()<NativeFloats, true>();
  return one ? make.template operator()<float, false>() : make.template operator()<NativeFloats, false>();
}

}  // namespace montelux
