// Lights at one point: each has a position and an intensity (W / sr) towards a unit direction.
#pragma once
#include <memory>

#include "light/image.h"
#include "light/row.h"
#include "math/square_maps.h"

namespace montelux {

// The same in all directions.
template <class F>
struct PointEmitter {
  Vec3<F> p;
  Spectrum<F> emission;

  explicit MONTELUX_INLINE PointEmitter(const LightRows<F>& r) : p(r.vec3(light_slot::shape)), emission(r.emission()) {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F>, Mask<F>) const { return emission; }
};

// 0 below `low`, 1 above `high`, between them t^2 (1 + bend - bend t): a bend of 2 gives a cubic with zero end slopes,
// 0 a square. A step if low and high are equal.
template <class F>
MONTELUX_INLINE F soft_step(F x, F low, F high, F bend) {
  F t = clamp((x - low) / max(high - low, F(1e-30f)), 0.0f, 1.0f);
  return t * t * (F(1.0f) + bend - bend * t);
}

// A cone with a soft edge, by the cosines of its whole half angle and of where the edge begins.
template <class F>
struct SpotEmitter {
  enum Slot { place = light_slot::shape, axis = place + 3, cos_end = axis + 3, cos_edge, bend };
  Vec3<F> p;
  LightRows<F> rows;

  explicit MONTELUX_INLINE SpotEmitter(const LightRows<F>& r) : p(r.vec3(place)), rows(r) {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F> w, Mask<F>) const {
    return rows.emission() *
           soft_step(dot(rows.vec3(axis), w), rows.number(cos_end), rows.number(cos_edge), rows.number(bend));
  }
};

// Lights whose intensity is given by an image, by direction: the images of all lights, and which of them a row uses.
template <class F>
struct ImagedLights {
  const std::shared_ptr<const LightImage>* images;
  LightRows<F> rows;

  // The emission times the result of f(image, lane), in the lanes that are on; other lanes are black.
  template <class Function>
  MONTELUX_INLINE Spectrum<F> times_image(Mask<F> on, Function f) const {
    Spectrum<F> e = rows.emission(), r = gray(F(0.0f));
    Uint<F> image = rows.bits(light_slot::image);
    for_each_lane(on, [&](int k) {
      std::uint32_t number = lane(image, k);
      set_lane(r, k, number == 0 ? lane(e, k) : lane(e, k) * f(*images[number - 1], k));
    });
    return r;
  }
};

// A measured luminaire: the mean of the components of a square equal-area image over the sphere of directions.
template <class F>
struct GoniometricEmitter {
  Vec3<F> p;
  ImagedLights<F> light;

  MONTELUX_INLINE GoniometricEmitter(const LightRows<F>& r, const std::shared_ptr<const LightImage>* images)
      : p(r.vec3(light_slot::shape)), light{images, r} {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F> w, Mask<F> on) const {
    Vec2<F> uv = square_from_sphere(normalize(light.rows.transform().direction_to_light(w)));
    return light.times_image(on,
                             [&](const LightImage& image, int k) { return gray(average(image.nearest(lane(uv, k)))); });
  }
};

// A slide projector along the light's +z: the image is on the plane z = 1, its shorter side within the field of view.
template <class F>
struct ProjectionEmitter {
  enum Slot { place = light_slot::shape, cotangent = place + 3, half_width, half_height };
  static constexpr float near = 1e-3f;  // minimum cosine to the axis at which a point is lit
  Vec3<F> p;
  ImagedLights<F> light;

  MONTELUX_INLINE ProjectionEmitter(const LightRows<F>& r, const std::shared_ptr<const LightImage>* images)
      : p(r.vec3(place)), light{images, r} {}
  MONTELUX_INLINE Spectrum<F> intensity(Vec3<F> w, Mask<F> on) const {
    Vec3<F> own = normalize(light.rows.transform().direction_to_light(w));
    F scale = light.rows.number(cotangent) / max(own.z, F(near));
    F u = 0.5f * (own.x * scale / light.rows.number(half_width) + 1.0f);
    F v = 0.5f * (own.y * scale / light.rows.number(half_height) + 1.0f);
    Mask<F> lit = (own.z >= F(near)) & (u >= F(0.0f)) & (u <= F(1.0f)) & (v >= F(0.0f)) & (v <= F(1.0f));
    return light.times_image(Mask<F>(on & lit), [&](const LightImage& image, int k) {
      return image.nearest({lane(u, k), lane(v, k)});
    });
  }
};

}  // namespace montelux
