#include "light/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using S = LightDesc;

constexpr double unlimited = 1e30;

// The member of a light.
template <class Light, class T>
Fields<S>::Place<T> of(T Light::*member) {
  return [member](S& light) -> T& { return std::get<Light>(light.model).*member; };
}

template <class Light>
void power(Fields<S>& fields) {
  fields.optional("power", of(&Light::power), "total power in watts to which the light is scaled; default: none", -1,
                  unlimited);
}

template <class Light>
void illuminance(Fields<S>& fields, const char* meaning) {
  fields.optional("illuminance", of(&Light::illuminance), meaning, -1, unlimited);
}

// What all lights have.
template <class Desc>
void scale_and_group(Fields<Desc>& fields) {
  fields.number("scale", &Desc::scale, "factor of the emission", 0, unlimited);
  fields.words("group", &Desc::group, "lights with the same name share a layer (--layers); default \"default\"");
}

Model<S> model(std::string_view meaning, LightModel light, Fields<S> fields) {
  scale_and_group(fields);
  const std::string_view name = name_of(light);
  return {name, meaning, {std::move(light)}, std::move(fields)};
}

Model<S> point() {
  using L = PointLightDesc;
  Fields<S> fields;
  fields.spectrum("I", of(&L::intensity), "radiant intensity", 0, unlimited);
  fields.vector("from", point3, of(&L::from), "position");
  power<L>(fields);
  return model("the same intensity in all directions", L{}, fields);
}

Model<S> spot() {
  using L = SpotLightDesc;
  Fields<S> fields;
  fields.spectrum("I", of(&L::intensity), "radiant intensity", 0, unlimited);
  fields.vector("from", point3, of(&L::from), "position");
  fields.vector("to", point3, of(&L::to), "target point");
  fields.number("coneangle", of(&L::cone_angle), "half-angle in degrees", 1e-3, 180);
  fields.number("conedeltaangle", of(&L::cone_delta_angle), "width of the edge in degrees", 0, 180);
  fields.choice<SpotFalloff>("falloff", of(&L::falloff),
                             "a smooth step of the cosine, or its square as in glTF (Montelux alone)",
                             {{"smooth", SpotFalloff::smooth}, {"squared", SpotFalloff::squared}});
  power<L>(fields);
  return model("a cone with a soft edge", L{}, fields);
}

Model<S> distant() {
  using L = DistantLightDesc;
  Fields<S> fields;
  fields.spectrum("L", of(&L::irradiance), "radiance, which here is irradiance at normal incidence", 0, unlimited);
  fields.vector("from", point3, of(&L::from), "the direction is from `from` to `to`");
  fields.vector("to", point3, of(&L::to), "see `from`");
  illuminance<L>(fields, "illuminance at normal incidence in lux to which the light is scaled; default: none");
  return model("parallel rays", L{}, fields);
}

Model<S> goniometric() {
  using L = GoniometricLightDesc;
  Fields<S> fields;
  fields.spectrum("I", of(&L::intensity), "radiant intensity", 0, unlimited);
  fields.words("filename", of(&L::file), "square equal-area image; default constant");
  power<L>(fields);
  return model("an intensity by direction, given by an image", L{}, fields);
}

Model<S> projection() {
  using L = ProjectionLightDesc;
  Fields<S> fields;
  fields.words("filename", of(&L::file), "the slide");
  fields.spectrum("I", of(&L::factor), "factor of the slide", 0, unlimited);
  fields.number("fov", of(&L::fov), "field of view of the shorter side in degrees", 1e-3, 179.99);
  power<L>(fields);
  return model("a slide projector along +z", L{}, fields);
}

Model<S> infinite() {
  using L = InfiniteLightDesc;
  Fields<S> fields;
  fields.spectrum("L", of(&L::radiance), "radiance", 0, unlimited);
  fields.words("filename", of(&L::file), "image of the sphere, instead of L");
  fields
      .choice<EnvironmentMapping>(
          "mapping", of(&L::mapping),
          "the image: square and equal-area, or longitude by latitude with the light's +z at the top, which is "
          "resampled; auto: by the aspect ratio (Montelux alone)",
          {{"equalarea", EnvironmentMapping::equal_area},
           {"latlong", EnvironmentMapping::latlong},
           {"auto", EnvironmentMapping::automatic}})
      .only_if([](const S& light) { return !std::get<L>(light.model).file.empty(); });
  illuminance<L>(fields, "illuminance of the upward plane in lux to which the light is scaled; default: none");
  ParameterSpec portal{"portal", {point3}, "four corners through which the light enters", -unlimited, unlimited,
                       {},       true};
  portal.later = true;
  fields.other(portal);
  return model("an environment", L{}, fields);
}

Model<AreaLightDesc> diffuse() {
  using L = AreaLightDesc;
  const auto has_image = [](const L& light) { return !light.file.empty(); };
  Fields<L> fields;
  fields.spectrum("L", &L::radiance, "radiance", 0, unlimited).only_if([](const L& light) {
    return light.file.empty();
  });
  fields.words("filename", &L::file, "image over (u, v), instead of L");
  fields
      .flag("localpower", &L::local_power,
            "triangles are chosen by the image's texels on them instead of by its mean (Montelux alone)")
      .only_if(has_image);
  fields.spectrum("tint", &L::tint, "factor of the image (Montelux alone)", 0, unlimited).only_if(has_image);
  fields.flag("twosided", &L::two_sided, "emits on both sides");
  fields.optional("power", &L::power, "total power in watts to which the light is scaled; default: none", -1,
                  unlimited);
  scale_and_group(fields);
  return {"diffuse", "the same radiance in all directions", {}, std::move(fields)};
}

}  // namespace

std::string_view name_of(const LightModel& model) {
  struct Name {
    std::string_view operator()(const PointLightDesc&) const { return "point"; }
    std::string_view operator()(const SpotLightDesc&) const { return "spot"; }
    std::string_view operator()(const DistantLightDesc&) const { return "distant"; }
    std::string_view operator()(const GoniometricLightDesc&) const { return "goniometric"; }
    std::string_view operator()(const ProjectionLightDesc&) const { return "projection"; }
    std::string_view operator()(const InfiniteLightDesc&) const { return "infinite"; }
  };
  return std::visit(Name{}, model);
}

const Models<LightDesc>& light_models() {
  static const Models<S> models({point(), spot(), distant(), goniometric(), projection(), infinite()});
  return models;
}

const Models<AreaLightDesc>& area_light_models() {
  static const Models<AreaLightDesc> models({diffuse()});
  return models;
}

}  // namespace montelux
