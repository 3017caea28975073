#include "integrator/photons/pilot.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "integrator/photons/tracing.h"

namespace montelux {

namespace {

constexpr std::uint32_t pilot_paths = 4096;
constexpr std::size_t places = 256, neighbours = 8;

// Of photonmap's radii.
constexpr double usual = 64;   // photons, where all within the radius count
constexpr double spare = 1.5;  // of the radius, where the nearest photons are counted
constexpr float largest_share = 0.1f;
// Of sppm's first ball: radii shrink slowly in media, as the cube root, so that they begin small.
constexpr double held_by_first_ball = 2;
constexpr float largest_share_of_first_ball = 0.03f;

// The squared distance of the last of a photon's nearest neighbours; none if it has too few. On surfaces photons of
// other surfaces do not count.
std::optional<float> squared_distance_of_neighbours(const std::vector<Photon>& photons, const Photon& at,
                                                    bool in_media) {
  std::vector<float> distances;
  for (const Photon& other : photons) {
    if (!in_media && !(std::abs(dot(other.ng, at.ng)) > similar_normals)) continue;
    const Vec3f way = other.p - at.p;
    const float d2 = dot(way, way), height = in_media ? 0.0f : dot(way, at.ng);
    if (height * height <= similar_height * similar_height * d2) distances.push_back(d2);
  }
  if (distances.size() <= neighbours) return std::nullopt;
  const auto last = distances.begin() + neighbours;  // after the photon itself
  std::nth_element(distances.begin(), last, distances.end());
  return *last;
}

template <bool in_media>
void follow_paths(const LightWalkScene<Accel>& walk, PhotonSink<NativeFloats>& sink) {
  RayCounts counts;
  LightWalk<NativeFloats, Accel, PhotonSink<NativeFloats>, AdjointCorrection, in_media>(walk, sink, counts)
      .run(pilot_paths, [](std::uint32_t i) {
        return PathSite<float>{0, 0, i};
      });
}

}  // namespace

PhotonPilot::PhotonPilot(const Scene& scene, const Accel& accel, const PhotonPaths& paths)
    : diagonal_(scene.bounds.is_empty() ? 1.0f : length(scene.bounds.high - scene.bounds.low)),
      share_(double(pilot_paths) / double(paths.count)) {
  const PhotonLights lights = photon_lights(scene, accel);
  if (!lights.by_power) return;
  PointSet points;
  points.samples_per_pass = pilot_paths, points.seed = 0x510e527fu;
  const LightWalkScene<Accel> walk{scene,
                                   accel,
                                   *lights.by_power,
                                   points,
                                   scene.shutter,
                                   0.5f,
                                   paths.max_depth,
                                   paths.roulette_depth,
                                   Densities::for_weights,
                                   lights.media ? &*lights.media : nullptr};
  if (scene.has_participating_media()) {
    PhotonSink<NativeFloats> sink(surfaces_, paths.first_event, 1, nullptr, MediumBox{scene.media, media_});
    follow_paths<true>(walk, sink);
  } else {
    PhotonSink<NativeFloats> sink(surfaces_, paths.first_event, 1);
    follow_paths<false>(walk, sink);
  }
}

float PhotonPilot::radius_of(const std::vector<Photon>& photons, double held, int dimensions, float max_share) const {
  const float largest_radius = std::max(max_share * diagonal_, 1e-6f);
  // The squared radii around some photons that hold their nearest neighbours.
  std::vector<float> squared;
  for (std::size_t i = 0; i < std::min(places, photons.size()); ++i) {
    const Photon& at = photons[i * photons.size() / std::min(places, photons.size())];
    if (const auto one = squared_distance_of_neighbours(photons, at, dimensions == 3)) squared.push_back(*one);
  }
  if (squared.empty()) return largest_radius;
  const auto middle = squared.begin() + std::ptrdiff_t(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  const double share = share_ / double(neighbours);
  const double radius = dimensions == 3 ? std::sqrt(double(*middle)) * std::cbrt(share * held)
                                        : std::sqrt(double(*middle) * share * held);
  return float(std::clamp(radius, 1e-6 * double(diagonal_), double(largest_radius)));
}

float radius_by_photons(const PhotonPilot& pilot, const PhotonMapSettings& settings) {
  return settings.nearest > 0 ? pilot.radius(spare * spare * double(settings.nearest)) : pilot.radius(usual);
}
float medium_radius_by_photons(const PhotonPilot& pilot, const PhotonMapSettings& settings) {
  const double counted = spare * spare * spare * double(settings.nearest);
  return pilot.medium_radius(settings.nearest > 0 ? counted : usual, largest_share);
}
float medium_radius_by_photons(const PhotonPilot& pilot) {
  return pilot.medium_radius(held_by_first_ball, largest_share_of_first_ball);
}

}  // namespace montelux
