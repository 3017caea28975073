// Lights as stated by a scene: plain data.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "light/emitters.h"
#include "math/transform.h"
#include "parameter/value.h"

namespace montelux {

// What lights at one point state, then lights without a place.
template <class Lights>
struct StatedLights;
template <class... Light>
struct StatedLights<std::tuple<Light...>> {
  using type = std::variant<typename Light::Stated..., DistantLightDesc, InfiniteLightDesc>;
};
using LightModel = StatedLights<PointLights<float>>::type;
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
