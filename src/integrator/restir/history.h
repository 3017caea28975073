// What a series of one picture leaves to a series of the next one, and which of its pixels showed a surface point
// before.
#pragma once
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "integrator/integrator.h"
#include "integrator/restir/path_sample.h"
#include "scene/scene.h"

namespace montelux {

// The vertices and reservoirs that the last frame of a picture ended with, pixels in row-major order.
struct ReuseMemory final : SeriesMemory {
  PixelBounds bounds;
  Shutter shutter;
  std::vector<ReuseVertex<float>> vertices;
  std::vector<LightReservoir<float>> lights;
  std::vector<PathReservoir<float>> paths;  // none where they are not reused

  std::size_t bytes() const override {
    return vertices.size() * sizeof(vertices[0]) + lights.size() * sizeof(lights[0]) + paths.size() * sizeof(paths[0]);
  }
  // Number of the pixel that holds a place of the raster; none outside of the bounds.
  std::optional<std::size_t> pixel_at(float x, float y) const {
    const float left = std::floor(x) - float(bounds.x0), top = std::floor(y) - float(bounds.y0);
    if (!(left >= 0 && top >= 0 && left < float(bounds.width()) && top < float(bounds.height()))) return std::nullopt;
    return std::size_t(top) * std::size_t(bounds.width()) + std::size_t(left);
  }
};

// The time in the previous picture at the same fraction of the exposure.
inline float earlier_time(float time, const Shutter& now, const Shutter& before) {
  const float exposed = now.close - now.open;
  const float share = exposed > 0 ? std::clamp((time - now.open) / exposed, 0.0f, 1.0f) : 0.0f;
  return before.time(share);
}

// How a path came to a vertex.
template <class F>
struct VertexOrigin {
  Ray<F> ray;
  Hit<F> hit;
  Mask<F> straight;  // from the camera, with nothing but interfaces in between
};

// Where the surface points of vertices were in the picture before: they move with their instance or with the form of
// their mesh, and the camera of the earlier time looks at them.
template <class F>
struct EarlierPlace {
  Projection<F> place;
  Vec3<F> ng;
};
template <class F>
EarlierPlace<F> earlier_place(const Scene& scene, const VertexOrigin<F>& origin, const F& time, Mask<F> on) {
  const SurfacePoint<F> then = surface_at<F>(scene.geometry, origin.ray, origin.hit, time, on).point;
  return {scene.camera.project(then.p, time), then.ng};
}

// The surface whose history is looked for. The choice sees objects, normals and distances, never what was found there:
// shares that depend on samples would not add up to one.
struct SoughtSurface {
  std::uint32_t object;
  Vec3f ng;
  float depth;

  bool is_like(const ReuseVertex<float>& other) const {
    return other.exists != 0 && other.object == object && are_normals_similar(std::abs(dot(ng, other.ng))) &&
           are_depths_similar(depth, other.depth);
  }
};

// The pixel of the memory that showed the surface, of the one that its place falls into and the next three, nearest
// first; none where it was hidden or outside of the picture.
inline std::optional<std::size_t> earlier_pixel(const ReuseMemory& memory, Vec2f raster, const SoughtSurface& sought) {
  const float dx = raster.x - std::floor(raster.x) - 0.5f, dy = raster.y - std::floor(raster.y) - 0.5f;
  const Vec2f across{dx < 0 ? -1.0f : 1.0f, 0}, down{0, dy < 0 ? -1.0f : 1.0f};
  const bool x_first = std::abs(dx) > std::abs(dy);
  for (const Vec2f& step : {Vec2f{0, 0}, x_first ? across : down, x_first ? down : across, across + down})
    if (const auto pixel = memory.pixel_at(raster.x + step.x, raster.y + step.y);
        pixel && sought.is_like(memory.vertices[*pixel]))
      return pixel;
  return std::nullopt;
}

}  // namespace montelux
