#include "light/point.h"

#include <cmath>

#include "light/adder.h"
#include "light/rows.h"

namespace montelux {

Fields<PointLightDesc> PointLightDesc::rows() {
  using L = PointLightDesc;
  Fields<L> fields;
  fields.spectrum("I", &L::intensity, "radiant intensity", 0, unlimited_emission);
  fields.vector("from", ParameterType::point3, &L::from, "position");
  power_row(fields);
  return fields;
}

std::optional<LightId> PointLightDesc::add(LightAdder& adder) const {
  return adder.builder().add_point(adder.to_world().point(from), adder.emitted(intensity, factor_for(power, 4 * pi)));
}

Fields<SpotLightDesc> SpotLightDesc::rows() {
  using L = SpotLightDesc;
  Fields<L> fields;
  fields.spectrum("I", &L::intensity, "radiant intensity", 0, unlimited_emission);
  fields.vector("from", ParameterType::point3, &L::from, "position");
  fields.vector("to", ParameterType::point3, &L::to, "target point");
  fields.number("coneangle", &L::cone_angle, "half-angle in degrees", 1e-3, 180);
  fields.number("conedeltaangle", &L::cone_delta_angle, "width of the edge in degrees", 0, 180);
  fields.choice<SpotFalloff>("falloff", &L::falloff,
                             "a smooth step of the cosine, or its square as in glTF (Montelux alone)",
                             {{"smooth", SpotFalloff::smooth}, {"squared", SpotFalloff::squared}});
  power_row(fields);
  return fields;
}

std::optional<LightId> SpotLightDesc::add(LightAdder& adder) const {
  const float end = cone_angle, edge = std::max(end - cone_delta_angle, 0.0f);
  const SpotCone cone{end, edge, falloff == SpotFalloff::squared};
  return adder.builder().add_spot(adder.to_world().point(from), adder.to_world().direction(to - from), cone,
                                  adder.emitted(intensity, factor_for(power, solid_angle(cone))));
}

Fields<GoniometricLightDesc> GoniometricLightDesc::rows() {
  using L = GoniometricLightDesc;
  Fields<L> fields;
  fields.spectrum("I", &L::intensity, "radiant intensity", 0, unlimited_emission);
  fields.words("filename", &L::file, "square equal-area image; default constant");
  power_row(fields);
  return fields;
}

std::optional<LightId> GoniometricLightDesc::add(LightAdder& adder) const {
  auto slide = adder.image(file, true);
  if (!file.empty() && !slide) return std::nullopt;
  const float mean = slide ? average(slide->mean()) : 1.0f;
  return adder.builder().add_goniometric(adder.to_world(), adder.emitted(intensity, factor_for(power, 4 * pi * mean)),
                                         slide);
}

Fields<ProjectionLightDesc> ProjectionLightDesc::rows() {
  using L = ProjectionLightDesc;
  Fields<L> fields;
  fields.words("filename", &L::file, "the slide");
  fields.spectrum("I", &L::factor, "factor of the slide", 0, unlimited_emission);
  fields.number("fov", &L::fov, "field of view of the shorter side in degrees", 1e-3, 179.99);
  power_row(fields);
  return fields;
}

namespace {

// The luminous part of what a projector emits: the sum over its pixels of luminance times solid angle.
float projected_luminance(const LightImage& image, float fov) {
  float aspect = float(image.width) / float(image.height), tangent = std::tan(fov * (pi / 360));
  float width = std::max(aspect, 1.0f) * tangent, height = std::max(1 / aspect, 1.0f) * tangent;
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float u = width * (2 * (float(x) + 0.5f) / float(image.width) - 1);
      float v = height * (2 * (float(y) + 0.5f) / float(image.height) - 1);
      sum += double(luminance(image.at(x, y))) * std::pow(1 + double(u * u + v * v), -1.5);
    }
  return float(4 * double(width * height) * sum / double(image.texels.size()));
}

}  // namespace

std::optional<LightId> ProjectionLightDesc::add(LightAdder& adder) const {
  if (file.empty()) {
    adder.error("a projection light needs an image", "state \"string filename\"");
    return std::nullopt;
  }
  auto slide = adder.image(file, false);
  if (!slide) return std::nullopt;
  const float scale = factor_for(power, projected_luminance(*slide, fov));
  return adder.builder().add_projection(adder.to_world(), fov, adder.emitted(factor, scale), slide);
}

}  // namespace montelux
