#include "light/table.h"

#include "light/rows.h"

namespace montelux {

namespace {

using S = LightDesc;

// What all lights have.
template <class Desc>
void scale_and_group(Fields<Desc>& fields) {
  fields.number("scale", &Desc::scale, "factor of the emission", 0, unlimited_emission);
  fields.words("group", &Desc::group, "lights with the same name share a layer (--layers); default \"default\"");
}

template <class Light>
Model<S> model() {
  Fields<S> fields;
  fields.part<Light>([](S& light) -> Light& { return std::get<Light>(light.model); }, Light::rows());
  scale_and_group(fields);
  return {Light::name, Light::meaning, {Light{}}, std::move(fields)};
}

// The lights of the list.
template <class... Light>
std::vector<Model<S>> models_of(const std::variant<Light...>&) {
  return {model<Light>()...};
}

Model<AreaLightDesc> diffuse() {
  using L = AreaLightDesc;
  const auto has_image = [](const L& light) { return !light.file.empty(); };
  Fields<L> fields;
  fields.spectrum("L", &L::radiance, "radiance", 0, unlimited_emission).only_if([](const L& light) {
    return light.file.empty();
  });
  fields.words("filename", &L::file, "image over (u, v), instead of L");
  fields
      .flag("localpower", &L::local_power,
            "triangles are chosen by the image's texels on them instead of by its mean (Montelux alone)")
      .only_if(has_image);
  fields.spectrum("tint", &L::tint, "factor of the image (Montelux alone)", 0, unlimited_emission).only_if(has_image);
  fields.flag("twosided", &L::two_sided, "emits on both sides");
  power_row(fields);
  scale_and_group(fields);
  return {"diffuse", "the same radiance in all directions", {}, std::move(fields)};
}

}  // namespace

std::string_view name_of(const LightModel& model) {
  return std::visit([](const auto& light) { return light.name; }, model);
}

const Models<LightDesc>& light_models() {
  static const Models<S> models(models_of(LightModel{}));
  return models;
}

const Models<AreaLightDesc>& area_light_models() {
  static const Models<AreaLightDesc> models({diffuse()});
  return models;
}

}  // namespace montelux
