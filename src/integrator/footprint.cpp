#include "integrator/footprint.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "integrator/random_eye_ray.h"
#include "transport/next_vertex.h"

namespace montelux {

float radius_by_footprint(const Scene& scene, const Accel& accel, int width, int height) {
  using F = float;
  constexpr std::uint32_t rays = 256;
  constexpr int deepest = 16;
  constexpr double pixels = 3;
  const RandomStream<float> all(0x510e527fu, 0x9b05688cu);
  std::vector<double> footprints;
  for (std::uint32_t i = 0; i < rays; ++i) {
    RandomStream<float> random = all.fork(i);
    const RandomEyeRay seen = random_eye_ray(scene, width, height, random);
    const Ray<float>& eye = seen.ray;
    std::uint64_t traced = 0;
    const auto [found, hit] = accel.trace<F>(eye, true, RayUse::camera);
    const NextVertex<F> first =
        follow_ray<F>(scene, accel, free_point(eye.o), eye, hit, found, random.fork(0), traced, NoWeight{});
    if (!first.found) continue;
    const float across = scene.camera.toward(first.x.point.p, seen.lens, eye.time).across.value;
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

}  // namespace montelux
