#include "light/infinite.h"

#include <cmath>

#include "light/adder.h"
#include "light/rows.h"

namespace montelux {

Fields<DistantLightDesc> DistantLightDesc::rows() {
  using L = DistantLightDesc;
  Fields<L> fields;
  fields.spectrum("L", &L::irradiance, "radiance, which here is irradiance at normal incidence", 0, unlimited_emission);
  fields.vector("from", ParameterType::point3, &L::from, "the direction is from `from` to `to`");
  fields.vector("to", ParameterType::point3, &L::to, "see `from`");
  illuminance_row(fields, "illuminance at normal incidence in lux to which the light is scaled; default: none");
  return fields;
}

std::optional<LightId> DistantLightDesc::add(LightAdder& adder) const {
  return adder.builder().add_distant(adder.to_world().direction(from - to),
                                     adder.emitted(irradiance, factor_for(illuminance, 1)));
}

Fields<InfiniteLightDesc> InfiniteLightDesc::rows() {
  using L = InfiniteLightDesc;
  Fields<L> fields;
  fields.spectrum("L", &L::radiance, "radiance", 0, unlimited_emission);
  fields.words("filename", &L::file, "image of the sphere, instead of L");
  fields
      .choice<EnvironmentMapping>(
          "mapping", &L::mapping,
          "the image: square and equal-area, or longitude by latitude with the light's +z at the top, which is "
          "resampled; auto: by the aspect ratio (Montelux alone)",
          {{"equalarea", EnvironmentMapping::equal_area},
           {"latlong", EnvironmentMapping::latlong},
           {"auto", EnvironmentMapping::automatic}})
      .only_if([](const L& light) { return !light.file.empty(); });
  illuminance_row(fields, "illuminance of the upward plane in lux to which the light is scaled; default: none");
  ParameterSpec portal{"portal",
                       {ParameterType::point3},
                       "four corners through which the light enters",
                       -unlimited_emission,
                       unlimited_emission,
                       {},
                       true};
  portal.later = true;
  fields.other(portal);
  return fields;
}

namespace {

// Illuminance of the plane whose normal is the image's pole, by midpoints; coarse texels are split at the horizon.
float horizontal_illuminance(const LightImage& image) {
  int parts = std::max(1, 512 / image.width), width = parts * image.width, height = parts * image.height;
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Vec3f w = sphere_from_square(Vec2f{(float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height)});
      sum += double(luminance(image.at(x / parts, y / parts)) * max(w.z, 0.0f));
    }
  return float(4 * double(pi) * sum / (double(width) * height));
}

// A longitude-latitude image (+z on top, azimuth from +x towards +y along the rows) on the equal-area square. Each
// texel is the mean of the texels that it covers, so that the total emission is preserved.
LightImage equal_area_image(const LightImage& angles) {
  LightImage square;
  // Finer than the image everywhere: texels are constant, and their edges would be visible.
  square.width = square.height = std::clamp(angles.width, 1, 8192);
  const int parts = square.width > 2048 ? 2 : 4;
  square.texels.resize(std::size_t(square.width) * std::size_t(square.height));
  for (int y = 0; y < square.height; ++y)
    for (int x = 0; x < square.width; ++x) {
      Rgb sum = Rgb{};
      for (int part = 0; part < parts * parts; ++part) {
        const float u = (float(x) + (float(part % parts) + 0.5f) / float(parts)) / float(square.width);
        const float v = (float(y) + (float(part / parts) + 0.5f) / float(parts)) / float(square.height);
        const Vec3f w = sphere_from_square(Vec2f{u, v});
        const float turn = std::atan2(w.y, w.x) * inv_two_pi;
        sum += angles.nearest({turn - std::floor(turn), std::acos(std::clamp(w.z, -1.0f, 1.0f)) * inv_pi});
      }
      square.texels[std::size_t(y) * std::size_t(square.width) + std::size_t(x)] = sum * (1.0f / float(parts * parts));
    }
  return square;
}

}  // namespace

std::optional<LightId> InfiniteLightDesc::add(LightAdder& adder) const {
  if (file.empty()) return adder.builder().add_uniform_infinite(adder.emitted(radiance, factor_for(illuminance, pi)));
  auto sphere = adder.image(file, mapping == EnvironmentMapping::equal_area);
  if (!sphere) return std::nullopt;
  const bool is_automatic = mapping == EnvironmentMapping::automatic;
  const bool by_angles =
      mapping == EnvironmentMapping::latlong || (is_automatic && sphere->width == 2 * sphere->height);
  if (is_automatic && !by_angles && sphere->width != sphere->height) {
    adder.error(
        "an environment must be square (equal-area) or twice as wide as high (longitude by latitude); "
        "the image has " +
        std::to_string(sphere->width) + " x " + std::to_string(sphere->height) + " pixels");
    return std::nullopt;
  }
  if (by_angles) sphere = std::make_shared<const LightImage>(equal_area_image(*sphere));
  const float factor = adder.scale() * factor_for(illuminance, horizontal_illuminance(*sphere));
  return adder.builder().add_image_infinite(adder.to_world(), gray_rgb(factor), sphere);
}

}  // namespace montelux
