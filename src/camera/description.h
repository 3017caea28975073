// A camera as stated by a scene: plain data.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "parameter/diagnostic.h"

namespace montelux {

enum class CameraKind { perspective, orthographic, spherical };
inline constexpr std::array<std::string_view, 3> camera_names{"perspective", "orthographic", "spherical"};
constexpr std::string_view name_of(CameraKind kind) { return camera_names[std::size_t(kind)]; }

// The side of the picture that the field of view and the usual screen window refer to.
enum class FovAxis { shorter, y };

// How a picture shows all directions. equirectangular: azimuth along x of the raster and polar angle along y;
// equal_area: octahedral.
enum class SpherePicture { equirectangular, equal_area };

struct CameraDesc {
  CameraKind kind = CameraKind::perspective;
  float fov = 90;  // degrees, of a perspective camera
  FovAxis fov_axis = FovAxis::shorter;
  std::optional<float> aspect{};                        // width over height; none: that of the picture
  std::optional<std::array<float, 4>> screen_window{};  // x0 x1 y0 y1; none: [-1, 1] along the axis
  float lens_radius = 0;                                // 0: a pinhole
  float focal_distance = 1e6f;                          // along z of camera space
  int aperture_blades = 0;                              // corners of the aperture; 0: it is round
  float aperture_rotation = 0;                          // of its first corner from x upward, in degrees
  SpherePicture mapping = SpherePicture::equal_area;
  float shutter_open = 0, shutter_close = 1;  // in the unit of the transforms' times
  SourceLocation where{};
};

}  // namespace montelux
