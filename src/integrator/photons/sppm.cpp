#include "integrator/photons/sppm.h"

#include <algorithm>
#include <cmath>

#include "integrator/photons/gathering.h"
#include "integrator/photons/tracing.h"

namespace montelux {

namespace {

template <class F>
class SppmChain final : public Chain {
 public:
  // What is referred to must outlive the chain.
  SppmChain(const Scene& scene, const Accel& accel, const SppmSettings& settings,
            const std::optional<AliasTable>& by_power, const ChainPass& pass)
      : scene_(scene),
        accel_(accel),
        settings_(settings),
        by_power_(by_power),
        pass_(pass),
        paths_(std::uint32_t(settings.photons > 0 ? settings.photons : std::max(pass.bounds.area(), min_photons))),
        map_(2 * std::size_t(paths_), std::size_t(pass.bounds.area())) {}

  RayCounts run(const ChainStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    const std::size_t number = pixel_number(tile.x0, tile.y0);
    switch (step.stage) {
      case 0:
        return follow_light(step.frame, tile);
      case 1:
        if (number == 0) map_.lay_out(radius(step.frame));
        return {};
      case 2:
        map_.deal(number);
        return {};
      case 3:
        for (int y = tile.y0; y < tile.y1; ++y)
          map_.put_in_order(pixel_number(tile.x0, y), pixel_number(tile.x1, y), std::size_t(pass_.bounds.area()));
        return {};
      default:
        break;
    }
    const RayCounts counts =
        PhotonGathering<F, Accel>(scene_, accel_, settings_, map_)
            .run({tile, pass_.points, pass_.shutter, std::uint32_t(step.frame), moment(step.frame), pass_.grid}, out);
    // A flux that is not a number has no place in the picture: it shows in the first pixel.
    if (number == 0 && broken_.take() > 0) out[0].radiance = gray_rgb(std::numeric_limits<float>::quiet_NaN());
    return counts;
  }

 private:
  std::size_t pixel_number(int x, int y) const {
    return std::size_t(y - pass_.bounds.y0) * std::size_t(pass_.bounds.width()) + std::size_t(x - pass_.bounds.x0);
  }
  float radius(int frame) const { return float(sppm_radius(settings_.radius, settings_.alpha, frame)); }
  // Photons are of one moment: where surfaces move, a frame has one, spread over the exposure as the samples of a
  // pixel.
  std::optional<float> moment(int frame) const {
    if (!scene_.moves()) return std::nullopt;
    return Sampler<float>(pass_.points, 0, 0, std::uint32_t(frame)).get1(path_dimension::time);
  }

  RayCounts follow_light(int frame, const PixelBounds& tile) {
    RayCounts counts;
    std::vector<Photon>& box = map_.box(pixel_number(tile.x0, tile.y0));
    box.clear();
    if (!by_power_) return counts;
    const LightPathShare share(pass_.bounds, tile, paths_);
    const LightWalkScene<Accel> walk{scene_,
                                     accel_,
                                     *by_power_,
                                     photon_points(pass_.points, frame, paths_),
                                     pass_.shutter.value_or(scene_.shutter),
                                     moment(frame),
                                     settings_.max_depth,
                                     settings_.roulette_depth};
    PhotonSink<F> sink(box, settings_.nee ? 1 : 0, 1 / float(paths_));
    LightWalk<F, Accel, PhotonSink<F>>(walk, sink, counts).run(share.count(), [&](std::uint32_t i) {
      return PathSite<float>{0, 0, share[i]};
    });
    map_.count(box, radius(frame));
    if (sink.broken() > 0) broken_.next();
    return counts;
  }

  const Scene& scene_;
  const Accel& accel_;
  const SppmSettings& settings_;
  const std::optional<AliasTable>& by_power_;
  const ChainPass pass_;
  const std::uint32_t paths_;
  SharedCount broken_;  // tiles with a flux that is not a number
  PhotonMap map_;
};

}  // namespace

double sppm_radius(double radius, double alpha, int frame) {
  double squared = radius * radius;
  for (int i = 1; i <= frame; ++i) squared *= (i + alpha) / (i + 1);
  return std::sqrt(squared);
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
  const double most = std::max(0.01 * double(diagonal), 1e-6);
  if (footprints.empty()) return float(most);
  const auto middle = footprints.begin() + std::ptrdiff_t(footprints.size() / 2);
  std::nth_element(footprints.begin(), middle, footprints.end());
  return float(std::min(pixels * *middle, most));
}

SppmIntegrator::SppmIntegrator(const Scene& scene, const Accel& accel, const SppmSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  if (scene.lights.count() > 0) by_power_ = scene.lights.by_power();
}

std::unique_ptr<Chain> SppmIntegrator::begin(const ChainPass& pass) const {
  if (settings_.lanes == Lanes::one)
    return std::make_unique<SppmChain<float>>(scene_, accel_, settings_, by_power_, pass);
  return std::make_unique<SppmChain<NativeFloats>>(scene_, accel_, settings_, by_power_, pass);
}

}  // namespace montelux
