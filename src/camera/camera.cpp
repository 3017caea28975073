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

ScreenWindow screen_window(const Entity& entity, int width, int height, Diagnostics& diagnostics) {
  double aspect = double(width) / height;
  float stated = entity.parameters.number("frameaspectratio", float(aspect));
  if (stated > 0)
    aspect = entity.parameters.find("frameaspectratio") ? double(stated) : aspect;
  else
    diagnostics.error(entity.where, "frameaspectratio must be positive");
  const bool of_height = entity.parameters.string("fovaxis", "shorter") == "y";
  ScreenWindow window =
      aspect > 1 || of_height ? ScreenWindow{-aspect, aspect, -1, 1} : ScreenWindow{-1, 1, -1 / aspect, 1 / aspect};
  const std::vector<float>& given = entity.parameters.array<float>("screenwindow");
  if (given.empty()) return window;
  if (given.size() != 4 || given[0] == given[1] || given[2] == given[3]) {
    diagnostics.error(entity.where, "screenwindow takes four numbers: x low, x high, y low, y high",
                      "the window must not be empty");
    return window;
  }
  return {given[0], given[1], given[2], given[3]};
}

// corner + x dx + y dy for the window scaled by `scale`. `at` maps a point of the window to the world.
template <class At>
RasterPlane raster_plane(const ScreenWindow& w, double scale, int width, int height, const CameraSpace& space, At at) {
  return {at(w.x_low * scale, w.y_high * scale), space.direction((w.x_high - w.x_low) * scale / width, 0, 0),
          space.direction(0, (w.y_low - w.y_high) * scale / height, 0)};
}

ThinLens thin_lens(const Entity& entity, const CameraSpace& space, Diagnostics& diagnostics) {
  float radius = entity.parameters.number("lensradius", 0.0f);
  float distance = entity.parameters.number("focaldistance", 1e6f);
  if (!(radius >= 0)) diagnostics.error(entity.where, "lensradius must not be negative");
  if (!(radius > 0)) return {};
  if (!(distance > 0)) {
    diagnostics.error(entity.where, "focaldistance must be positive");
    return {};
  }
  const int blades = entity.parameters.integer("apertureblades", 0);
  if (blades != 0 && blades < 3) {
    diagnostics.error(entity.where, "apertureblades must be 0, for a round aperture, or at least 3");
    return {};
  }
  if (blades == 0) return {space.direction(radius, 0, 0), space.direction(0, radius, 0), 1.0f / distance, true};
  const double turn = double(entity.parameters.number("aperturerotation", 0.0f)) * std::numbers::pi / 180;
  const double x = double(radius) * std::cos(turn), y = double(radius) * std::sin(turn);
  return {space.direction(x, y, 0), space.direction(-y, x, 0), 1.0f / distance, true, blades};
}

PerspectiveCamera build_perspective(const Entity& entity, const CameraSpace& space, int width, int height,
                                    Diagnostics& diagnostics) {
  double fov = entity.parameters.number("fov", 90.0f);
  if (!(fov > 0 && fov < 180)) {
    diagnostics.error(entity.where, "fov must lie between 0 and 180 degrees");
    fov = 90;
  }
  double half_width = std::tan(fov * std::numbers::pi / 360);
  ScreenWindow window = screen_window(entity, width, height, diagnostics);
  auto at = [&](double x, double y) { return space.direction(x, y, 1); };
  return {space.point(0, 0, 0), raster_plane(window, half_width, width, height, space, at),
          thin_lens(entity, space, diagnostics)};
}

OrthographicCamera build_orthographic(const Entity& entity, const CameraSpace& space, int width, int height,
                                      Diagnostics& diagnostics) {
  ScreenWindow window = screen_window(entity, width, height, diagnostics);
  auto at = [&](double x, double y) { return space.point(x, y, 0); };
  return {raster_plane(window, 1, width, height, space, at), space.direction(0, 0, 1),
          thin_lens(entity, space, diagnostics)};
}

SphericalCamera build_spherical(const Entity& entity, const CameraSpace& space, int width, int height,
                                Diagnostics& diagnostics) {
  std::string mapping = entity.parameters.string("mapping", "equalarea");
  if (mapping != "equalarea" && mapping != "equirectangular")
    diagnostics.error(entity.where, "unknown mapping \"" + mapping + "\" of the spherical camera",
                      "equalarea or equirectangular");
  return {
      space.point(0, 0, 0),
      space.direction(1, 0, 0),
      space.direction(0, 1, 0),
      space.direction(0, 0, 1),
      {1.0f / float(width), 1.0f / float(height)},
      mapping == "equirectangular" ? SphericalCamera::Mapping::equirectangular : SphericalCamera::Mapping::equal_area};
}

}  // namespace

Camera build_camera(const Entity& entity, const Transform& world_to_camera, int width, int height,
                    Diagnostics& diagnostics) {
  CameraSpace space(world_to_camera);
  if (entity.type == "orthographic")
    return Camera::Variant(build_orthographic(entity, space, width, height, diagnostics));
  if (entity.type == "spherical") return Camera::Variant(build_spherical(entity, space, width, height, diagnostics));
  if (entity.type != "perspective")
    diagnostics.error(entity.where, "unknown camera \"" + entity.type + "\"", "perspective, orthographic or spherical");
  return Camera::Variant(build_perspective(entity, space, width, height, diagnostics));
}

}  // namespace montelux
