#include "integrator/light_paths/light_media.h"

#include "transport/vertex.h"

namespace montelux {

namespace {

// The medium at the end of a straight line from the camera, through everything.
std::uint32_t medium_at(const Scene& scene, const Accel& accel, const Vec3f& end, const RandomStream<float>& random) {
  const float time = scene.moves() ? scene.shutter.time(0.5f) : 0.0f;
  const CameraRay<float> camera = scene.camera.generate({0.0f, 0.0f}, {0.5f, 0.5f}, time);
  const Vec3f way = end - camera.ray.o;
  const float distance = length(way);
  if (!(distance > 0)) return scene.camera_medium;
  Segment<float> segment{{camera.ray.o, way * (1 / distance), distance * (1 - shadow_shortening), time},
                         {},
                         media_of<float>(scene.media, scene.camera_medium)};
  for (std::uint32_t crossings = 0; segment.ray.t_max > 0; ++crossings) {
    const auto [found, hit] = accel.trace<float>(segment.ray, true);
    if (!found) break;
    segment.hit = hit;
    const Vertex<float> v(scene, segment, {true, true}, {TransportMode::radiance, random.fork(crossings)});
    cross_interface(segment, v, true);
    segment.ray.t_max -= hit.t;
  }
  return segment.media.medium;
}

}  // namespace

LightMedia::LightMedia(const Scene& scene, const Accel& accel) : sides_(2 * std::size_t(scene.lights.count())) {
  std::vector<bool> is_stated(scene.lights.count());
  for (const GeometryRow& row : scene.geometry.rows) {
    if (row.first_light == 0 || (row.flags & GeometryRow::bounds_media) == 0) continue;
    const std::uint32_t lights = row.kind == GeometryKind::triangles ? row.count : 1;
    for (std::uint32_t i = row.first_light - 1; i < row.first_light - 1 + lights; ++i)
      sides_[2 * std::size_t(i)] = row.inside, sides_[2 * std::size_t(i) + 1] = row.outside, is_stated[i] = true;
  }
  const RandomStream<float> random(0x27d4eb2fu, 0);
  for (std::uint32_t i = 0; i < scene.lights.count(); ++i) {
    if (is_stated[i]) continue;
    const Vec3f p = scene.lights.emit<float>(i, {0.5f, 0.5f}, {0.5f, 0.5f}, true).p;
    sides_[2 * std::size_t(i)] = sides_[2 * std::size_t(i) + 1] =
        medium_at(scene, accel, p, random.fork(Uint<float>(i)));
  }
}

std::optional<LightMedia> light_media(const Scene& scene, const Accel& accel) {
  if (scene.media.empty() || scene.lights.count() == 0) return std::nullopt;
  return LightMedia(scene, accel);
}

bool shines_through_endless_medium(const Scene& scene, const Accel& accel) {
  const std::optional<LightMedia> media = light_media(scene, accel);
  if (!media) return false;
  for (std::uint32_t i = 0; i < scene.lights.count(); ++i)
    if (scene.lights.is_beyond<float>(i, true) && media->outside(i) != empty_space) return true;
  return false;
}

}  // namespace montelux
