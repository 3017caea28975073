// Cameras: from a point on the image and a point on the lens to a ray in the world. Camera space is left-handed, with
// x to the right, y up and the view along +z; raster y points down.
#pragma once
#include <optional>
#include <variant>

#include "camera/description.h"
#include "camera/importance.h"
#include "geometry/ray.h"
#include "math/motion.h"
#include "math/square_maps.h"
#include "math/transform.h"
#include "mc/regular_polygon.h"

namespace montelux {

// A ray in world space with unit direction and without an end (t_max is 1e30). weight multiplies what it carries.
template <class F>
struct CameraRay {
  Ray<F> ray;
  F weight;
};

inline constexpr float camera_ray_end = 1e30f;

// The projection of a world point onto the image: the raster position of the ray through the centre of the lens that
// passes through the point. The raster position may be outside the image.
template <class F>
struct Projection {
  Vec2<F> raster;
  F distance;    // from the origin of that ray, in world space
  Mask<F> seen;  // false: behind the camera; the other members are meaningless
};

// A point of world space that depends affinely on the raster: corner + x dx + y dy.
struct RasterPlane {
  Vec3f corner, dx, dy;

  template <class F>
  MONTELUX_INLINE Vec3<F> operator()(Vec2<F> raster) const {
    return splat<F>(corner) + splat<F>(dx) * raster.x + splat<F>(dy) * raster.y;
  }
};

// A lens of zero thickness in the plane z = 0 of camera space.
struct ThinLens {
  Vec3f x{0, 0, 0}, y{0, 0, 0};  // its radii along the axes of camera space, in world space
  float inverse_distance = 0;    // of the plane in focus, along z of camera space
  bool open = false;             // false: a pinhole
  int blades = 0;                // corners of the aperture, the first one at x; 0: it is round

  template <class F>
  MONTELUX_INLINE CameraRay<F> through(Vec3<F> o, Vec3<F> d, Vec2<F> u) const {
    if (open) {
      Vec3<F> offset = place(u);
      o = o + offset;
      // d reaches the plane z = 1: all rays of the lens meet on that plane scaled to the plane in focus.
      d = d - offset * inverse_distance;
    }
    return {{o, normalize(d), F(camera_ray_end)}, F(1.0f)};
  }
  // A point of the lens from its centre; zero for a pinhole.
  template <class F>
  MONTELUX_INLINE Vec3<F> place(Vec2<F> u) const {
    if (!open) return {F(0.0f), F(0.0f), F(0.0f)};
    Vec2<F> disk = blades == 0 ? sample_disk_concentric(u) : sample_regular_polygon(u, blades);
    return splat<F>(x) * disk.x + splat<F>(y) * disk.y;
  }
  // With which place() draws points; 1 for a pinhole.
  Density<Area> density() const {
    if (!open) return {1.0f};
    const float unit = blades == 0 ? pi : 0.5f * float(blades) * sin_cos_two_pi(1.0f / float(blades)).sin;
    return {1.0f / (unit * length(cross(x, y)))};
  }
};

// The coordinates x, y, z of q along three axes, by Cramer's rule.
template <class F>
MONTELUX_INLINE Vec3<F> along(const Vec3<F>& q, const Vec3<F>& x, const Vec3<F>& y, const Vec3<F>& z) {
  const Vec3<F> xy = cross(x, y);
  return Vec3<F>{dot(cross(y, z), q), dot(cross(z, x), q), dot(xy, q)} / dot(xy, z);
}

struct PerspectiveCamera {
  Vec3f origin;
  RasterPlane direction;  // to the plane z = 1 of camera space
  ThinLens lens;

  template <class F>
  CameraRay<F> generate(Vec2<F> raster, Vec2<F> lens_u) const {
    return lens.through(splat<F>(origin), direction(raster), lens_u);
  }
  template <class F>
  Projection<F> project(const Vec3<F>& p) const {
    const Vec3<F> x = splat<F>(direction.dx), y = splat<F>(direction.dy), corner = splat<F>(direction.corner);
    const Vec3<F> v = p - splat<F>(origin), normal = cross(x, y);
    // The point projected through the camera onto the plane z = 1.
    const F scale = dot(normal, corner) / dot(normal, v);
    const Vec3<F> place = along<F>(v * scale - corner, x, y, normal);
    return {{place.x, place.y}, length(v), scale > F(0.0f)};
  }
  template <class F>
  LensDirection<F> toward_direction(const Vec3<F>& w, Vec2<F> lens_u) const {
    const Vec3<F> x = splat<F>(direction.dx), y = splat<F>(direction.dy), corner = splat<F>(direction.corner);
    const Vec3<F> normal = cross(x, y), offset = lens.place(lens_u);
    // To the plane z = 1, where area is proportional to that of the raster.
    const F height = dot(normal, corner);
    const Vec3<F> to_plane = w * (height / dot(normal, w));
    const Vec3<F> place = along<F>(to_plane + offset * lens.inverse_distance - corner, x, y, normal);
    const F l = length(to_plane);
    return {splat<F>(origin) + offset, {place.x, place.y},         {l * l * l / abs(height)},
            {F(lens.density().value)}, dot(to_plane, w) > F(0.0f), !lens.open};
  }
  template <class F>
  LensConnection<F> toward(const Vec3<F>& p, Vec2<F> lens_u) const {
    const Vec3<F> v = p - (splat<F>(origin) + lens.place(lens_u));
    const F distance = length(v);
    const Vec3<F> d = v * (F(1.0f) / distance);
    return connection(toward_direction(d, lens_u), d, distance);
  }
};

struct OrthographicCamera {
  RasterPlane origin;
  Vec3f direction;  // z of camera space
  ThinLens lens;

  template <class F>
  CameraRay<F> generate(Vec2<F> raster, Vec2<F> lens_u) const {
    return lens.through(origin(raster), splat<F>(direction), lens_u);
  }
  template <class F>
  Projection<F> project(const Vec3<F>& p) const {
    const Vec3<F> way = splat<F>(direction);
    const Vec3<F> place = along<F>(p - splat<F>(origin.corner), splat<F>(origin.dx), splat<F>(origin.dy), way);
    return {{place.x, place.y}, place.z * length(way), place.z > F(0.0f)};
  }
  template <class F>
  LensDirection<F> toward_direction(const Vec3<F>&, Vec2<F>) const {
    return {{}, {}, {F(0.0f)}, {F(1.0f)}, Mask<F>(false), !lens.open};
  }
  // All rays through one point of the lens have the same direction.
  template <class F>
  LensConnection<F> toward(const Vec3<F>& p, Vec2<F> lens_u) const {
    const Vec3<F> offset = lens.place(lens_u), x = splat<F>(origin.dx), y = splat<F>(origin.dy);
    const Vec3<F> way = splat<F>(direction) - offset * lens.inverse_distance;
    const Vec3<F> place = along<F>(p - offset - splat<F>(origin.corner), x, y, way);
    const F l = length(way);
    const Vec3<F> d = way * (F(1.0f) / l);
    const Vec2<F> raster{place.x, place.y};
    return {origin(raster) + offset,
            d,
            place.z * l,
            raster,
            {F(1.0f) / abs(dot(cross(x, y), d))},
            {F(lens.density().value)},
            place.z > F(0.0f),
            !lens.open};
  }
};

// All directions from a point; y of camera space is up.
struct SphericalCamera {
  using Mapping = SpherePicture;
  Vec3f origin;
  Vec3f x, y, z;  // the axes of camera space
  Vec2f to_unit;  // one over the resolution
  Mapping mapping = Mapping::equal_area;

  template <class F>
  CameraRay<F> generate(Vec2<F> raster, Vec2<F>) const {
    Vec2<F> uv{raster.x * to_unit.x, raster.y * to_unit.y};
    Vec3<F> w;
    if (mapping == Mapping::equal_area) {
      w = sphere_from_square(wrap_sphere_square(uv));
    } else {
      SinCos<F> polar = sin_cos(uv.y * pi), azimuth = sin_cos_two_pi(uv.x - floor(uv.x));
      w = {polar.sin * azimuth.cos, polar.sin * azimuth.sin, polar.cos};
    }
    // The maps have z up; camera space has y up.
    Vec3<F> d = splat<F>(x) * w.x + splat<F>(y) * w.z + splat<F>(z) * w.y;
    return {{splat<F>(origin), normalize(d), F(camera_ray_end)}, F(1.0f)};
  }
  template <class F>
  Projection<F> project(const Vec3<F>& p) const {
    const Vec3<F> v = p - splat<F>(origin);
    const Vec3<F> local = along<F>(v, splat<F>(x), splat<F>(y), splat<F>(z));
    const Vec3<F> w = normalize(Vec3<F>{local.x, local.z, local.y});
    Vec2<F> uv;
    if (mapping == Mapping::equal_area) {
      uv = square_from_sphere(w);
    } else {
      const F turn = atan2(w.y, w.x) * (0.5f * inv_pi);
      uv = {turn - floor(turn), atan2(safe_sqrt(w.x * w.x + w.y * w.y), w.z) * inv_pi};
    }
    const F distance = length(v);
    return {{uv.x / to_unit.x, uv.y / to_unit.y}, distance, distance > F(0.0f)};
  }
  template <class F>
  LensDirection<F> toward_direction(const Vec3<F>& w, Vec2<F>) const {
    const Projection<F> at = project<F>(splat<F>(origin) + w);
    const Vec3<F> local = along<F>(w, splat<F>(x), splat<F>(y), splat<F>(z));
    // The axes stretch solid angle by |det| |local|^3 on its way from camera space.
    const F l2 = length_squared(local);
    const F growth = abs(dot(cross(splat<F>(x), splat<F>(y)), splat<F>(z))) * l2 * sqrt(l2);
    F share = inv_four_pi;
    if (mapping == Mapping::equirectangular) {
      const F sine = sqrt(max((local.x * local.x + local.z * local.z) / l2, F(1e-30f)));
      share = F(0.5f * inv_pi * inv_pi) / sine;
    }
    const F pixels = 1.0f / (to_unit.x * to_unit.y);
    return {splat<F>(origin), at.raster, {pixels * share / growth}, {F(1.0f)}, Mask<F>(true), true};
  }
  template <class F>
  LensConnection<F> toward(const Vec3<F>& p, Vec2<F> lens_u) const {
    const Vec3<F> v = p - splat<F>(origin);
    const F distance = length(v);
    const Vec3<F> d = v * (F(1.0f) / distance);
    return connection(toward_direction(d, lens_u), d, distance);
  }
  // Calls f(place) for the places outside the picture that show the same as a place inside: the picture repeats along
  // x, and continues beyond the poles or edges.
  template <class Function>
  void for_each_repetition(Vec2f raster, Function f) const {
    const float w = 1 / to_unit.x, h = 1 / to_unit.y, x0 = raster.x, y0 = raster.y;
    if (mapping == Mapping::equirectangular) {
      for (const float turn : {-2.0f, -1.0f, 1.0f, 2.0f}) f(Vec2f{x0 + turn * w, y0});
      for (const float turn : {-1.5f, -0.5f, 0.5f, 1.5f})
        f(Vec2f{x0 + turn * w, -y0}), f(Vec2f{x0 + turn * w, 2 * h - y0});
    } else {
      const float turned_x = w - x0, turned_y = h - y0;
      f(Vec2f{-x0, turned_y}), f(Vec2f{2 * w - x0, turned_y});
      f(Vec2f{turned_x, -y0}), f(Vec2f{turned_x, 2 * h - y0});
      for (const float i : {-1.0f, 1.0f})
        for (const float j : {-1.0f, 1.0f}) f(Vec2f{x0 + i * w, y0 + j * h});
    }
  }
};

// One of the cameras.
class Camera {
 public:
  using Variant = std::variant<PerspectiveCamera, OrthographicCamera, SphericalCamera>;
  Camera(Variant camera) : camera_(std::move(camera)) {}

  // raster: in pixels, continuous, (0, 0) the upper left corner of the picture, (width, height) the lower right one.
  // lens_u in [0, 1)^2; time in [0, 1], for cameras that move. To compile a loop for one camera, std::visit on
  // variant() outside it.
  template <class F>
  CameraRay<F> generate(Vec2<F> raster, Vec2<F> lens_u, F time = F(0.0f)) const {
    CameraRay<F> made = std::visit([&](const auto& camera) { return camera.generate(raster, lens_u); }, camera_);
    made.ray.time = time;
    if (motion_) {
      const Affine<F> to_world = motion_->at(time);
      made.ray.o = to_world.point(made.ray.o);
      made.ray.d = normalize(to_world.direction(made.ray.d));
    }
    return made;
  }
  // The projection of the world point p onto the image at that time.
  template <class F>
  Projection<F> project(const Vec3<F>& p, F time = F(0.0f)) const {
    const Vec3<F> own = motion_ ? motion_->at(time).preimage(p) : p;
    Projection<F> place = std::visit([&](const auto& camera) { return camera.project(own); }, camera_);
    if (motion_) {
      const CameraRay<F> ray = generate(place.raster, {F(0.5f), F(0.5f)}, time);
      place.distance = length(p - ray.ray.o);
    }
    return place;
  }
  // The point p of the world connected with a point of the lens at that time.
  template <class F>
  LensConnection<F> toward(const Vec3<F>& p, Vec2<F> lens_u, F time = F(0.0f)) const {
    const auto connect = [&](const Vec3<F>& own) {
      return std::visit([&](const auto& camera) { return camera.toward(own, lens_u); }, camera_);
    };
    if (!motion_) return connect(p);
    const Affine<F> to_world = motion_->at(time);
    LensConnection<F> c = connect(to_world.preimage(p));
    // Volumes grow by the determinant, lengths along d by `stretch`, areas across d by the quotient.
    const Vec3<F> d = to_world.direction(c.d);
    const F stretch = length(d);
    c.p = to_world.point(c.p), c.d = d * (F(1.0f) / stretch), c.distance = c.distance * stretch;
    c.across.value = c.across.value * stretch / to_world.volume();
    return c;
  }
  // The same for light from beyond the scene; the unit direction w leads there.
  template <class F>
  LensDirection<F> toward_direction(const Vec3<F>& w, Vec2<F> lens_u, F time = F(0.0f)) const {
    const auto connect = [&](const Vec3<F>& own) {
      return std::visit([&](const auto& camera) { return camera.toward_direction(own, lens_u); }, camera_);
    };
    if (!motion_) return connect(w);
    const Affine<F> to_world = motion_->at(time);
    const Vec3<F> own = normalize(to_world.preimage(w + to_world.offset()));
    LensDirection<F> c = connect(own);
    const F stretch = length(to_world.direction(own));
    c.p = to_world.point(c.p);
    c.density.value = c.density.value * stretch * stretch * stretch / to_world.volume();
    return c;
  }
  // Calls f(place) for a place of the picture and for all places outside it but near its edge that show the same.
  template <class Function>
  void for_each_place(Vec2f raster, Function f) const {
    f(raster);
    if (const auto* all = std::get_if<SphericalCamera>(&camera_)) all->for_each_repetition(raster, f);
  }
  // Whether it looks along many directions from one point, so that a direction has a place on the picture.
  bool sees_directions() const { return !std::holds_alternative<OrthographicCamera>(camera_); }
  // The camera in its own space, in which it may move through the world.
  const Variant& variant() const { return camera_; }
  // The number of pixels after which the image repeats along x; 0: it does not.
  float turn_in_pixels() const {
    const auto* all = std::get_if<SphericalCamera>(&camera_);
    return all && all->mapping == SphericalCamera::Mapping::equirectangular ? 1.0f / all->to_unit.x : 0.0f;
  }

  // A camera that is fixed in its own space, which moves through the world.
  Camera moved(const Motion& camera_to_world) && {
    motion_ = camera_to_world;
    return std::move(*this);
  }
  bool moves() const { return motion_.has_value(); }

 private:
  Variant camera_;
  std::optional<Motion> motion_;
};

// The camera for an image of width x height pixels (the whole image, not a crop). Values that make no camera are
// reported and replaced by the usual ones.
Camera build_camera(const CameraDesc& camera, const Transform& world_to_camera, int width, int height,
                    Diagnostics& diagnostics);

}  // namespace montelux
