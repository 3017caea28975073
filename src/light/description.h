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

// What a list of lights states, each struct once: some lights of the list may share it.
template <class Stated, class... Light>
struct StatedLights {
  using Type = Stated;
};
template <class... Known, class First, class... Rest>
struct StatedLights<std::variant<Known...>, First, Rest...> {
  using Next = typename First::Stated;
  static constexpr bool is_known = (std::is_same_v<Known, Next> || ...);
  using Grown = std::conditional_t<is_known, std::variant<Known...>, std::variant<Known..., Next>>;
  using Type = typename StatedLights<Grown, Rest...>::Type;
};
template <class... AtPoint, class... Unbounded>
typename StatedLights<std::variant<>, AtPoint..., Unbounded...>::Type stated_by(std::tuple<AtPoint...>*,
                                                                                std::tuple<Unbounded...>*);
// What scenes state of lights that are no surfaces.
using LightModel =
    decltype(stated_by(static_cast<PointLights<float>*>(nullptr), static_cast<UnboundedLights<float>*>(nullptr)));
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
