// Lights as stated by a scene.
#include <algorithm>
#include <cmath>

#include "light/builder.h"

namespace montelux {

namespace {

// The factor that scales an emission of `present` to the power (or illuminance) that is stated.
float factor_for(const std::optional<float>& wanted, float present) {
  return wanted && *wanted > 0 && present > 0 ? *wanted / present : 1.0f;
}

// Adds one light, by its kind.
struct Adder {
  LightSetBuilder& builder;
  const LightDesc& light;
  const LightInputs& inputs;
  Diagnostics& diagnostics;

  const Transform& to_world() const { return light.light_to_world; }
  Rgb emitted(const SpectrumValue& stated, float factor) const {
    return inputs.emission(stated) * (light.scale * factor);
  }
  // Null: not stated, or invalid and reported.
  std::shared_ptr<const LightImage> image(const std::string& name, bool must_be_square) const {
    if (name.empty()) return nullptr;
    auto image = inputs.image(name, light.where);
    if (!image) {
      diagnostics.error(light.where, "the image \"" + name + "\" of the " + std::string(name_of(light.model)) +
                                         " light cannot be read");
    } else if (image->width < 1 || image->height < 1 ||
               image->texels.size() != std::size_t(image->width) * std::size_t(image->height)) {
      diagnostics.error(light.where, "the image \"" + name + "\" is empty");
    } else if (must_be_square && image->width != image->height) {
      diagnostics.error(light.where,
                        "the image \"" + name + "\" has " + std::to_string(image->width) + " x " +
                            std::to_string(image->height) + " pixels, but an equal-area image of directions is square",
                        "convert a longitude-latitude map to the equal-area octahedral form first");
    } else {
      for (const Rgb& t : image->texels)
        if (!is_finite(t[0] + t[1] + t[2])) {
          diagnostics.error(light.where, "the image \"" + name + "\" has pixels that are not finite");
          return nullptr;
        }
      return image;
    }
    return nullptr;
  }

  std::optional<LightId> operator()(const PointLightDesc& stated) const;
  std::optional<LightId> operator()(const SpotLightDesc& stated) const;
  std::optional<LightId> operator()(const DistantLightDesc& stated) const;
  std::optional<LightId> operator()(const GoniometricLightDesc& stated) const;
  std::optional<LightId> operator()(const ProjectionLightDesc& stated) const;
  std::optional<LightId> operator()(const InfiniteLightDesc& stated) const;
};

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

// Illuminance of the plane whose normal is the image's pole, by midpoints; coarse texels are split at the horizon.
float illuminance(const LightImage& image) {
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

std::optional<LightId> Adder::operator()(const PointLightDesc& stated) const {
  return builder.add_point(to_world().point(stated.from), emitted(stated.intensity, factor_for(stated.power, 4 * pi)));
}

std::optional<LightId> Adder::operator()(const SpotLightDesc& stated) const {
  const float end = stated.cone_angle, edge = std::max(end - stated.cone_delta_angle, 0.0f);
  const SpotCone cone{end, edge, stated.falloff == SpotFalloff::squared};
  return builder.add_spot(to_world().point(stated.from), to_world().direction(stated.to - stated.from), cone,
                          emitted(stated.intensity, factor_for(stated.power, solid_angle(cone))));
}

std::optional<LightId> Adder::operator()(const DistantLightDesc& stated) const {
  return builder.add_distant(to_world().direction(stated.from - stated.to),
                             emitted(stated.irradiance, factor_for(stated.illuminance, 1)));
}

std::optional<LightId> Adder::operator()(const GoniometricLightDesc& stated) const {
  auto slide = image(stated.file, true);
  if (!stated.file.empty() && !slide) return std::nullopt;
  const float mean = slide ? average(slide->mean()) : 1.0f;
  return builder.add_goniometric(to_world(), emitted(stated.intensity, factor_for(stated.power, 4 * pi * mean)), slide);
}

std::optional<LightId> Adder::operator()(const ProjectionLightDesc& stated) const {
  if (stated.file.empty()) {
    diagnostics.error(light.where, "a projection light needs an image", "state \"string filename\"");
    return std::nullopt;
  }
  auto slide = image(stated.file, false);
  if (!slide) return std::nullopt;
  const float factor = factor_for(stated.power, projected_luminance(*slide, stated.fov));
  return builder.add_projection(to_world(), stated.fov, emitted(stated.factor, factor), slide);
}

std::optional<LightId> Adder::operator()(const InfiniteLightDesc& stated) const {
  if (stated.file.empty())
    return builder.add_uniform_infinite(emitted(stated.radiance, factor_for(stated.illuminance, pi)));
  const EnvironmentMapping mapping = stated.mapping;
  auto sphere = image(stated.file, mapping == EnvironmentMapping::equal_area);
  if (!sphere) return std::nullopt;
  const bool is_automatic = mapping == EnvironmentMapping::automatic;
  const bool by_angles =
      mapping == EnvironmentMapping::latlong || (is_automatic && sphere->width == 2 * sphere->height);
  if (is_automatic && !by_angles && sphere->width != sphere->height) {
    diagnostics.error(light.where,
                      "an environment must be square (equal-area) or twice as wide as high (longitude by latitude); "
                      "the image has " +
                          std::to_string(sphere->width) + " x " + std::to_string(sphere->height) + " pixels");
    return std::nullopt;
  }
  if (by_angles) sphere = std::make_shared<const LightImage>(equal_area_image(*sphere));
  const float factor = light.scale * factor_for(stated.illuminance, illuminance(*sphere));
  return builder.add_image_infinite(to_world(), gray_rgb(factor), sphere);
}

// The group that a light states. A name that no image file can store is an error.
std::string checked_group(const std::string& name, const SourceLocation& where, Diagnostics& diagnostics) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), plain)) return name;
  diagnostics.error(where, "\"" + name + "\" is not a valid name of a light group",
                    "use up to 64 letters of the English alphabet, digits, _ and -");
  return "default";
}

}  // namespace

Emission emission_of(const AreaLightDesc& stated, const LightInputs& inputs, Diagnostics& diagnostics) {
  Emission e;
  e.group = checked_group(stated.group, stated.where, diagnostics);
  e.radiance = inputs.emission(stated.radiance);
  e.scale = stated.scale;
  if (stated.power && *stated.power > 0) e.power = stated.power;
  e.two_sided = stated.two_sided;
  e.tint = inputs.emission(stated.tint);
  if (!stated.file.empty()) e.image = inputs.image(stated.file, stated.where);
  if (e.image) e.image_mean = e.image->mean();
  e.local_power = stated.local_power;
  return e;
}

std::optional<LightId> LightSetBuilder::add(const LightDesc& light, const LightInputs& inputs,
                                            Diagnostics& diagnostics) {
  begin_group(checked_group(light.group, light.where, diagnostics));
  return std::visit(Adder{*this, light, inputs, diagnostics}, light.model);
}

}  // namespace montelux
