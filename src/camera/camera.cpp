#include "camera/camera.h"

#include <cmath>
#include <numbers>

namespace montelux {

namespace {

// The camera space in world coordinates, in double.
class CameraSpace {
 public:
  explicit CameraSpace(const Transform& world_to_camera) : m_(world_to_camera.inverse_matrix()) {}
  Vec3f point(double x, double y, double z) const { return apply(x, y, z, 1); }
  Vec3f direction(double x, double y, double z) const { return apply(x, y, z, 0); }

 private:
  Vec3f apply(double x, double y, double z, double w) const {
    auto row = [&](int i) { return float(m_.m[i][0] * x + m_.m[i][1] * y + m_.m[i][2] * z + m_.m[i][3] * w); };
    return {row(0), row(1), row(2)};
  }
  Matrix4 m_;
};

// The part of the plane z = 1 (orthographic: of z = 0) that the image shows.
struct ScreenWindow {
  double x_low, x_high, y_low, y_high;
};

ScreenWindow screen_window(const CameraDesc& camera, int width, int height, Diagnostics& diagnostics) {
  double aspect = double(width) / height;
  if (camera.aspect && *camera.aspect > 0)
    aspect = double(*camera.aspect);
  else if (camera.aspect)
    diagnostics.error(camera.where, "the camera's ratio of width to height must be positive");
  const ScreenWindow window = aspect > 1 || camera.fov_axis == FovAxis::y
                                  ? ScreenWindow{-aspect, aspect, -1, 1}
                                  : ScreenWindow{-1, 1, -1 / aspect, 1 / aspect};
  if (!camera.screen_window) return window;
  const auto& [x_low, x_high, y_low, y_high] = *camera.screen_window;
  if (x_low == x_high || y_low == y_high) {
    diagnostics.error(camera.where, "the camera's screen window is empty");
    return window;
  }
  return {x_low, x_high, y_low, y_high};
}

// corner + x dx + y dy for the window scaled by `scale`. `at` maps a point of the window to the world.
template <class At>
RasterPlane raster_plane(const ScreenWindow& w, double scale, int width, int height, const CameraSpace& space, At at) {
  return {at(w.x_low * scale, w.y_high * scale), space.direction((w.x_high - w.x_low) * scale / width, 0, 0),
          space.direction(0, (w.y_low - w.y_high) * scale / height, 0)};
}

ThinLens thin_lens(const CameraDesc& camera, const CameraSpace& space, Diagnostics& diagnostics) {
  const float radius = camera.lens_radius;
  if (!(radius >= 0)) diagnostics.error(camera.where, "the radius of the lens must not be negative");
  if (!(radius > 0)) return {};
  if (!(camera.focal_distance > 0)) {
    diagnostics.error(camera.where, "the distance in focus must be positive");
    return {};
  }
  const float inverse_distance = 1.0f / camera.focal_distance;
  const int blades = camera.aperture_blades;
  if (blades != 0 && blades < 3) {
    diagnostics.error(camera.where, "an aperture has at least 3 blades, or 0 if it is round");
    return {};
  }
  if (blades == 0) return {space.direction(radius, 0, 0), space.direction(0, radius, 0), inverse_distance, true};
  const double turn = double(camera.aperture_rotation) * std::numbers::pi / 180;
  const double x = double(radius) * std::cos(turn), y = double(radius) * std::sin(turn);
  return {space.direction(x, y, 0), space.direction(-y, x, 0), inverse_distance, true, blades};
}

PerspectiveCamera build_perspective(const CameraDesc& camera, const CameraSpace& space, int width, int height,
                                    Diagnostics& diagnostics) {
  double fov = camera.fov;
  if (!(fov > 0 && fov < 180)) {
    diagnostics.error(camera.where, "the field of view must be between 0 and 180 degrees");
    fov = 90;
  }
  const double half_width = std::tan(fov * std::numbers::pi / 360);
  const ScreenWindow window = screen_window(camera, width, height, diagnostics);
  const auto at = [&](double x, double y) { return space.direction(x, y, 1); };
  return {space.point(0, 0, 0), raster_plane(window, half_width, width, height, space, at),
          thin_lens(camera, space, diagnostics)};
}

OrthographicCamera build_orthographic(const CameraDesc& camera, const CameraSpace& space, int width, int height,
                                      Diagnostics& diagnostics) {
  const ScreenWindow window = screen_window(camera, width, height, diagnostics);
  const auto at = [&](double x, double y) { return space.point(x, y, 0); };
  return {raster_plane(window, 1, width, height, space, at), space.direction(0, 0, 1),
          thin_lens(camera, space, diagnostics)};
}

SphericalCamera build_spherical(const CameraDesc& camera, const CameraSpace& space, int width, int height) {
  return {space.point(0, 0, 0),
          space.direction(1, 0, 0),
          space.direction(0, 1, 0),
          space.direction(0, 0, 1),
          {1.0f / float(width), 1.0f / float(height)},
          camera.mapping};
}

}  // namespace

Camera build_camera(const CameraDesc& camera, const Transform& world_to_camera, int width, int height,
                    Diagnostics& diagnostics) {
  const CameraSpace space(world_to_camera);
  switch (camera.kind) {
    case CameraKind::orthographic:
      return Camera::Variant(build_orthographic(camera, space, width, height, diagnostics));
    case CameraKind::spherical:
      return Camera::Variant(build_spherical(camera, space, width, height));
    case CameraKind::perspective:
      break;
  }
  return Camera::Variant(build_perspective(camera, space, width, height, diagnostics));
}

}  // namespace montelux
