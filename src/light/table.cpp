#include "light/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using List = std::vector<ParameterSpec>;

constexpr double most = 1e30;

ParameterSpec scale() { return {"scale", {number}, "factor of the emission; default 1", 0, most}; }
ParameterSpec group() {
  return {"group", {string}, "lights with the same name share a layer (--layers); default \"default\""};
}
ParameterSpec power() {
  return {"power", {number}, "total power in watts to which the light is scaled; default: none", -1, most};
}
ParameterSpec illuminance(const char* meaning) { return {"illuminance", {number}, meaning, -1, most}; }
ParameterSpec intensity() { return {"I", {spectrum}, "radiant intensity; default 1", 0, most}; }
ParameterSpec portal() {
  ParameterSpec spec{"portal", {point3}, "four corners through which the light enters", -most, most, {}, true};
  spec.later = true;
  return spec;
}

std::vector<EntitySpec> lights() {
  return {
      {"point",
       "the same intensity in all directions",
       {intensity(), {"from", {point3}, "position; default 0 0 0"}, power(), scale(), group()}},
      {"spot",
       "a cone with a soft edge",
       {intensity(),
        {"from", {point3}, "position; default 0 0 0"},
        {"to", {point3}, "target point; default 0 0 1"},
        {"coneangle", {number}, "half-angle in degrees; default 30", 1e-3, 180},
        {"conedeltaangle", {number}, "width of the edge in degrees; default 5", 0, 180},
        {"falloff",
         {string},
         "falloff: a smooth step of the cosine, or its square as in glTF; default smooth (Montelux alone)",
         0,
         0,
         {"smooth", "squared"}},
        power(),
        scale(),
        group()}},
      {"distant",
       "parallel rays",
       {{"L", {spectrum}, "radiance, which here is irradiance at normal incidence; default 1", 0, most},
        {"from", {point3}, "the direction is from `from` to `to`; default 0 0 0"},
        {"to", {point3}, "default 0 0 1"},
        illuminance("illuminance at normal incidence in lux to which the light is scaled; default: none"),
        scale(),
        group()}},
      {"goniometric",
       "an intensity by direction, given by an image",
       {intensity(), {"filename", {string}, "square equal-area image; default constant"}, power(), scale(), group()}},
      {"projection",
       "a slide projector along +z",
       {{"filename", {string}, "the slide"},
        {"I", {spectrum}, "factor of the slide; default 1", 0, most},
        {"fov", {number}, "field of view of the shorter side in degrees; default 90", 1e-3, 179.99},
        power(),
        scale(),
        group()}},
      {"infinite",
       "an environment",
       {{"L", {spectrum}, "radiance; default 1", 0, most},
        {"filename", {string}, "image of the sphere, instead of L"},
        {"mapping",
         {string},
         "the image: square and equal-area, or longitude by latitude with the light's +z at the top, which is resampled"
         "; auto: by the aspect ratio; default equalarea (Montelux alone)",
         0,
         0,
         {"equalarea", "latlong", "auto"}},
        illuminance("illuminance of the upward plane in lux to which the light is scaled; default: none"),
        scale(),
        group(),
        portal()}},
  };
}

}  // namespace

std::span<const EntitySpec> light_table() {
  static const std::vector<EntitySpec> table = lights();
  return table;
}

std::span<const EntitySpec> area_light_table() {
  static const std::vector<EntitySpec> table{
      {"diffuse",
       "the same radiance in all directions",
       {{"L", {spectrum}, "radiance; default 1", 0, most},
        {"filename", {string}, "image over (u, v), instead of L"},
        {"localpower",
         {boolean},
         "triangles are chosen by the image's texels on them instead of by its "
         "mean; default false (Montelux alone)"},
        {"tint", {spectrum}, "factor of the image; default 1 (Montelux alone)", 0, most},
        {"twosided", {boolean}, "emits on both sides; default false"},
        power(),
        scale(),
        group()}}};
  return table;
}

}  // namespace montelux
