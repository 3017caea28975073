// Lights as stated by a scene: plain data. Spectra are of emitted light, in W/m^2/sr, W/sr or W/m^2 as said; files are
// images. Directions and places are in the space of the light.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "math/transform.h"
#include "parameter/value.h"

namespace montelux {

// The same intensity in all directions.
struct PointLightDesc {
  SpectrumValue intensity = gray_value(1);  // W/sr
  Vec3f from{0, 0, 0};
  std::optional<float> power{};  // W, to which the light is scaled; none, or not positive: as stated
};

// How the intensity of a spot falls from the inner cone to its edge: by a smooth step of the cosine, or by the square
// of a linear ramp of the cosine.
enum class SpotFalloff { smooth, squared };

// A cone with a soft edge.
struct SpotLightDesc {
  SpectrumValue intensity = gray_value(1);  // W/sr
  Vec3f from{0, 0, 0}, to{0, 0, 1};
  float cone_angle = 30;       // half-angle in degrees
  float cone_delta_angle = 5;  // width of the edge in degrees, inside the cone
  SpotFalloff falloff = SpotFalloff::smooth;
  std::optional<float> power{};
};

// Parallel rays in the direction of `to` - `from`.
struct DistantLightDesc {
  SpectrumValue irradiance = gray_value(1);  // at normal incidence, W/m^2
  Vec3f from{0, 0, 0}, to{0, 0, 1};
  std::optional<float> illuminance{};  // lux, to which the light is scaled; as `power`
};

// An intensity by direction.
struct GoniometricLightDesc {
  SpectrumValue intensity = gray_value(1);  // W/sr, times the image
  std::string file{};                       // square and equal-area; empty: constant
  std::optional<float> power{};
};

// A slide projector along +z.
struct ProjectionLightDesc {
  std::string file{};  // the slide; it is needed
  SpectrumValue factor = gray_value(1);
  float fov = 90;  // of the shorter side, in degrees
  std::optional<float> power{};
};

// How an image shows the sphere: `automatic` decides by the aspect ratio.
enum class EnvironmentMapping { equal_area, latlong, automatic };

// An environment.
struct InfiniteLightDesc {
  SpectrumValue radiance = gray_value(1);
  std::string file{};  // instead of `radiance`
  EnvironmentMapping mapping = EnvironmentMapping::equal_area;
  std::optional<float> illuminance{};  // lux of the upward plane, to which the light is scaled; as `power`
};

using LightModel = std::variant<PointLightDesc, SpotLightDesc, DistantLightDesc, GoniometricLightDesc,
                                ProjectionLightDesc, InfiniteLightDesc>;
// The name by which files and programs state it.
std::string_view name_of(const LightModel& model);

struct LightDesc {
  LightModel model;
  float scale = 1;                // factor of the emission
  std::string group = "default";  // lights of the same group share a layer
  Transform light_to_world{};
  SourceLocation where{};
};

// The emission of a surface.
struct AreaLightDesc {
  SpectrumValue radiance = gray_value(1);
  std::string file{};                  // over (u, v), instead of `radiance`
  SpectrumValue tint = gray_value(1);  // factor of the image
  bool local_power = false;            // triangles are chosen by the texels on them instead of by the image's mean
  bool two_sided = false;
  std::optional<float> power{};  // W of the whole shape, to which the light is scaled
  float scale = 1;               // factor of the emission
  std::string group = "default";
  SourceLocation where{};
};

}  // namespace montelux
