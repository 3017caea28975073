// Lights as stated in a scene file.
#include <algorithm>
#include <cmath>

#include "light/builder.h"

namespace montelux {

namespace {

// What the parameters of a light are read with.
struct Reader {
  const Entity& light;
  const Transform& to_world;
  const LightInputs& inputs;
  Diagnostics& diagnostics;

  Rgb spectrum(std::string_view name) const {
    auto value = light.parameters.spectrum(name);
    return value ? inputs.emission(*value) : gray_rgb(1.0f);
  }
  float scale() const { return light.parameters.number("scale", 1); }
  Vec3f from() const { return light.parameters.vec3("from", {0, 0, 0}); }
  Vec3f to() const { return light.parameters.vec3("to", {0, 0, 1}); }
  // The factor that scales an emission of `present` to the power (or illuminance) that the parameter states.
  float factor_for(std::string_view parameter, float present) const {
    float wanted = light.parameters.number(parameter, -1);
    return wanted > 0 && present > 0 ? wanted / present : 1.0f;
  }
  // Null: not stated, or invalid and reported.
  std::shared_ptr<const LightImage> image(bool must_be_square) const {
    std::string name = light.parameters.string("filename", "");
    if (name.empty()) return nullptr;
    auto image = inputs.image(name, light.where);
    if (!image) {
      diagnostics.error(light.where, "the image \"" + name + "\" of the " + light.type + " light cannot be read");
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

std::optional<LightId> add_infinite(LightSetBuilder& builder, const Reader& read) {
  if (read.light.parameters.string("filename", "").empty())
    return builder.add_uniform_infinite(read.spectrum("L") * (read.scale() * read.factor_for("illuminance", pi)));
  const std::string mapping = read.light.parameters.string("mapping", "equalarea");
  auto image = read.image(mapping == "equalarea");
  if (!image) return std::nullopt;
  const bool by_angles = mapping == "latlong" || (mapping == "auto" && image->width == 2 * image->height);
  if (mapping == "auto" && !by_angles && image->width != image->height) {
    read.diagnostics.error(
        read.light.where,
        "an environment must be square (equal-area) or twice as wide as high (longitude by latitude); "
        "the image has " +
            std::to_string(image->width) + " x " + std::to_string(image->height) + " pixels");
    return std::nullopt;
  }
  if (by_angles) image = std::make_shared<const LightImage>(equal_area_image(*image));
  float factor = read.scale() * read.factor_for("illuminance", illuminance(*image));
  return builder.add_image_infinite(read.to_world, gray_rgb(factor), image);
}

std::optional<LightId> add_spot(LightSetBuilder& builder, const Reader& read) {
  const ParameterList& p = read.light.parameters;
  const float end = p.number("coneangle", 30), edge = std::max(end - p.number("conedeltaangle", 5), 0.0f);
  const SpotCone cone{end, edge, p.string("falloff", "smooth") == "squared"};
  Rgb intensity = read.spectrum("I") * (read.scale() * read.factor_for("power", solid_angle(cone)));
  return builder.add_spot(read.to_world.point(read.from()), read.to_world.direction(read.to() - read.from()), cone,
                          intensity);
}

std::optional<LightId> add_goniometric(LightSetBuilder& builder, const Reader& read) {
  bool stated = !read.light.parameters.string("filename", "").empty();
  auto image = read.image(true);
  if (stated && !image) return std::nullopt;
  float mean = image ? average(image->mean()) : 1.0f;
  Rgb intensity = read.spectrum("I") * (read.scale() * read.factor_for("power", 4 * pi * mean));
  return builder.add_goniometric(read.to_world, intensity, image);
}

std::optional<LightId> add_projection(LightSetBuilder& builder, const Reader& read) {
  if (read.light.parameters.string("filename", "").empty()) {
    read.diagnostics.error(read.light.where, "a projection light needs an image", "state \"string filename\"");
    return std::nullopt;
  }
  auto image = read.image(false);
  if (!image) return std::nullopt;
  float fov = read.light.parameters.number("fov", 90);
  Rgb factor = read.spectrum("I") * (read.scale() * read.factor_for("power", projected_luminance(*image, fov)));
  return builder.add_projection(read.to_world, fov, factor, image);
}

}  // namespace

std::string light_group(const Entity& light, Diagnostics& diagnostics) {
  const std::string name = light.parameters.string("group", "default");
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (!name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), plain)) return name;
  diagnostics.error(light.where, "\"" + name + "\" is not a valid name of a light group",
                    "use up to 64 letters of the English alphabet, digits, _ and -");
  return "default";
}

Emission emission_of(const Entity& area_light, const LightInputs& inputs, Diagnostics& diagnostics) {
  const ParameterList& list = area_light.parameters;
  Emission e;
  e.group = light_group(area_light, diagnostics);
  auto stated = list.spectrum("L");
  e.radiance = stated ? inputs.emission(*stated) : gray_rgb(1.0f);
  e.scale = list.number("scale", 1);
  if (float power = list.number("power", -1); power > 0) e.power = power;
  e.two_sided = list.boolean("twosided", false);
  if (auto tint = list.spectrum("tint")) e.tint = inputs.emission(*tint);
  if (std::string name = list.string("filename", ""); !name.empty()) e.image = inputs.image(name, area_light.where);
  if (e.image) e.image_mean = e.image->mean();
  e.local_power = list.boolean("localpower", false);
  return e;
}

std::optional<LightId> LightSetBuilder::add(const Entity& light, const Transform& to_world, const LightInputs& inputs,
                                            Diagnostics& diagnostics) {
  Reader read{light, to_world, inputs, diagnostics};
  begin_group(light_group(light, diagnostics));
  if (light.type == "point") {
    Rgb intensity = read.spectrum("I") * (read.scale() * read.factor_for("power", 4 * pi));
    return add_point(to_world.point(read.from()), intensity);
  }
  if (light.type == "distant") {
    Rgb irradiance = read.spectrum("L") * (read.scale() * read.factor_for("illuminance", 1));
    return add_distant(to_world.direction(read.from() - read.to()), irradiance);
  }
  if (light.type == "spot") return montelux::add_spot(*this, read);
  if (light.type == "goniometric") return montelux::add_goniometric(*this, read);
  if (light.type == "projection") return montelux::add_projection(*this, read);
  if (light.type == "infinite") return montelux::add_infinite(*this, read);
  diagnostics.error(light.where, "there is no light \"" + light.type + "\"");
  return std::nullopt;
}

}  // namespace montelux
