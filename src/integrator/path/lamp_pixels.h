// Where lamps are in view.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "accel/accel.h"
#include "integrator/path/filter_parts.h"
#include "math/shared_byte.h"
#include "scene/scene.h"

namespace montelux {

// The pixels of a picture in which the light of emitters that the camera sees directly may differ from ray to ray:
// those of small emitters, and those at the rims of large ones. A pixel that is missing costs nothing but noise.
class LampPixels {
 public:
  // Of a picture of this size. Null where there are none; and where boxes do not say in which pixels emitters are seen:
  // for cameras that move or look along all directions, and for rays through the centres of pixels. Rims of large
  // emitters behind interfaces are not looked for.
  static std::shared_ptr<const LampPixels> of(const Scene& scene, const Accel& accel, int width, int height);

  // The lanes whose pixels are among them. Looks at a pixel of a large emitter when it is first wanted. Thread-safe,
  // and a pure function of the scene.
  template <class F, class Rays>
  Mask<F> at(const Scene& scene, const Rays& rays, const Uint<F>& x, const Uint<F>& y, Mask<F> on) const;
  // The part of these pixels' filters beyond which no emitter is seen; of pixels that are among them.
  template <class F>
  FilterPart<F> part(const Uint<F>& x, const Uint<F>& y, Mask<F> on) const {
    return parts_.of<F>(x, y, on);
  }

 private:
  enum State : std::uint8_t { none, unknown, some };

  LampPixels(const Filter& filter, int width, int height);
  std::size_t index(std::uint32_t x, std::uint32_t y) const { return std::size_t(y) * width_ + x; }

  std::uint32_t width_, height_;
  FilterParts parts_;
  mutable std::vector<SharedByte> states_;
};

// Camera rays that show emitters alone: so many for each sample of such a pixel, instead of the sample's own ray, to
// which all other light of the sample belongs. They are in the part of the pixel's filter that may show emitters. Rims
// of lamps and lamps that are smaller than a pixel make much of the noise of a picture, and such a ray costs a small
// part of a path.
struct LampRays {
  const LampPixels* pixels = nullptr;  // null: none
  std::uint32_t count = 0;
};

// Lanes whose hit is on an emitter.
template <class F>
Mask<F> meets_emitter(const Scene& scene, const Hit<F>& hit, Mask<F> found) {
  std::uint32_t emits = 0;
  for_each_lane(
      found, [&](int k) { emits |= std::uint32_t(scene.geometry.rows[lane(hit.geometry, k)].first_light != 0) << k; });
  return mask_of_bits<F>(emits);
}

template <class F, class Rays>
Mask<F> LampPixels::at(const Scene& scene, const Rays& rays, const Uint<F>& x, const Uint<F>& y, Mask<F> on) const {
  std::uint32_t found = 0, open = 0;
  for_each_lane(on, [&](int k) {
    if (lane(x, k) >= width_ || lane(y, k) >= height_) return;
    const std::uint8_t state = states_[index(lane(x, k), lane(y, k))].get();
    found |= std::uint32_t(state == some) << k, open |= std::uint32_t(state == unknown) << k;
  });
  if (open == 0) return mask_of_bits<F>(found);
  // All of the pixel shows one emitter, or none, where nine points of its filter do.
  const Mask<F> wanted = mask_of_bits<F>(open);
  Mask<F> any_emits(false), all_alike = wanted;
  Uint<F> geometry(0u);
  const Vec2f reach = scene.filter.radius();
  std::uint32_t point = 0;
  for (const float v : {-1.0f, 0.0f, 1.0f})
    for (const float u : {-1.0f, 0.0f, 1.0f}) {
      const Vec2<F> raster{to_float(x) + (0.5f + u * reach.x), to_float(y) + (0.5f + v * reach.y)};
      const Ray<F> ray = scene.camera.generate(raster, Vec2<F>{F(0.5f + 0.499f * v), F(0.5f - 0.499f * u)}).ray;
      // Each at a moment of its own of the exposure.
      const F time = scene.moves() ? scene.shutter.time(F((float(4 * point % 9) + 0.5f) / 9)) : F(0.0f);
      const auto [meets, hit] = rays.template trace<F>({ray.o, ray.d, F(ray_infinity), time}, wanted, RayUse::camera);
      const Mask<F> emits = meets_emitter<F>(scene, hit, meets);
      if (point == 0) geometry = hit.geometry;
      any_emits = any_emits | emits, all_alike = all_alike & emits & (hit.geometry == geometry);
      ++point;
    }
  const Mask<F> shows = any_emits & !all_alike;
  const std::uint32_t now = bits(shows);
  for_each_lane(wanted, [&](int k) { states_[index(lane(x, k), lane(y, k))].set((now >> k) & 1u ? some : none); });
  return mask_of_bits<F>(found | now);
}

}  // namespace montelux
