#include "render/motion.h"

#include <algorithm>
#include <cmath>

#include "integrator/restir/history.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

using F = NativeFloats;
using U = Uint<F>;

float middle(const Shutter& shutter) { return shutter.time(0.5f); }

// The earlier places of the points of a pack of pixels.
Projection<F> earlier_places(const Scene& scene, const Accel& accel, const MotionRequest& request,
                             const Vec2<F>& raster, Mask<F> on) {
  const F now = middle(request.now), before = middle(request.before);
  const Ray<F> ray = scene.camera.generate(raster, Vec2<F>{F(0.5f), F(0.5f)}, now).ray;
  const auto [found, hit] = accel.trace<F>({ray.o, ray.d, F(ray_infinity), ray.time}, on, RayUse::camera);
  const Mask<F> meets = on & found;
  const VertexOrigin<F> origin{{ray.o, ray.d, hit.t, ray.time}, hit, meets};
  Projection<F> place = earlier_place<F>(scene, origin, before, meets).place;
  // Distant points move only by the camera's rotation.
  const float size = scene.bounds.is_empty() ? 1.0f : length(scene.bounds.high - scene.bounds.low);
  const float far = 1e5f * std::max(size, 1.0f);
  const Projection<F> sky = scene.camera.project(ray.o + ray.d * far, before);
  place.raster = select<F>(meets, place.raster, sky.raster);
  place.seen = (meets & place.seen) | (sky.seen & !meets);
  return place;
}

void fill_row(const Scene& scene, const Accel& accel, const MotionRequest& request, int y, PixelBuffer& out) {
  const PixelBounds& b = request.bounds;
  const float turn = scene.camera.turn_in_pixels();
  for (int x0 = 0; x0 < b.width(); x0 += lanes_of<F>) {
    const U x = lane_index<F>() + U(std::uint32_t(x0));
    const Mask<F> on = x < U(std::uint32_t(b.width()));
    const Vec2<F> raster{to_float(x) + (float(b.x0) + 0.5f), F(float(b.y0 + y) + 0.5f)};
    const Projection<F> then = earlier_places(scene, accel, request, raster, on);
    for_each_lane(Mask<F>(on & then.seen), [&](int k) {
      const Vec2f here = lane(raster, k), there = lane(then.raster, k);
      const float way = there.x - here.x;
      out.at(x0 + k, y, 0) = turn > 0 ? way - turn * std::round(way / turn) : way;
      out.at(x0 + k, y, 1) = here.y - there.y;
    });
  }
}

}  // namespace

PixelBuffer motion_vectors(const Scene& scene, const Accel& accel, const MotionRequest& request) {
  PixelBuffer out = make_pixel_buffer(request.bounds.width(), request.bounds.height(), {"X", "Y"});
  Scheduler(request.threads).run(std::size_t(out.height), [&](std::size_t y, int) {
    fill_row(scene, accel, request, int(y), out);
  });
  return out;
}

}  // namespace montelux
