#include "montelux/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/pbrt/spectra.h"

namespace montelux::api {

namespace {

bool takes(const ParameterSpec* row, ParameterType type) {
  return row && std::ranges::find(row->types, type) != row->types.end();
}

// The first of these types that the row takes; where it takes none, the first, which the checks will refuse.
ParameterType type_for(const ParameterSpec* row, std::initializer_list<ParameterType> types) {
  const auto found = std::ranges::find_if(types, [&](ParameterType type) { return takes(row, type); });
  return found == types.end() ? *types.begin() : *found;
}

bool is_float(double x) { return std::abs(x) <= double(std::numeric_limits<float>::max()); }
template <class... T>
bool are_finite(T... x) {
  return (std::isfinite(x) && ...);
}

}  // namespace

std::string name_of_material(std::size_t i) { return "material " + std::to_string(i); }
std::string name_of_texture(std::size_t i) { return "texture " + std::to_string(i); }

std::string_view name_of_type(ParameterType type) {
  switch (type) {
    case ParameterType::number:
      return "double";
    case ParameterType::integer:
      return "int";
    case ParameterType::boolean:
      return "bool";
    case ParameterType::string:
      return "a string";
    case ParameterType::point2:
    case ParameterType::vector2:
      return "Vec2";
    case ParameterType::point3:
    case ParameterType::vector3:
    case ParameterType::normal:
      return "Vec3";
    case ParameterType::spectrum:
      return "Rgb, SampledSpectrum, NamedSpectrum or Blackbody";
    case ParameterType::texture:
      return "TextureId";
  }
  return "";
}

ParameterReader::Typed ParameterReader::fail(const Place& place, const std::string& takes) {
  report_.error(place.where, "'" + place.name + "' takes " + takes);
  return std::nullopt;
}

ParameterReader::Typed ParameterReader::typed(const std::vector<bool>& values, const Place&) {
  return std::pair{ParameterType::boolean, Values(std::vector<std::uint8_t>(values.begin(), values.end()))};
}

ParameterReader::Typed ParameterReader::typed(const std::vector<int>& values, const Place& place) {
  if (type_for(place.row, {ParameterType::integer, ParameterType::number}) == ParameterType::integer)
    return std::pair{ParameterType::integer, Values(values)};
  return std::pair{ParameterType::number, Values(std::vector<float>(values.begin(), values.end()))};
}

ParameterReader::Typed ParameterReader::typed(const std::vector<double>& values, const Place& place) {
  if (!std::ranges::all_of(values, is_float)) return fail(place, "finite numbers");
  return std::pair{ParameterType::number, Values(std::vector<float>(values.begin(), values.end()))};
}

ParameterReader::Typed ParameterReader::typed(const std::vector<std::string>& values, const Place&) {
  return std::pair{ParameterType::string, Values(values)};
}

ParameterReader::Typed ParameterReader::typed(const std::vector<Vec2>& values, const Place& place) {
  std::vector<Vec2f> all;
  for (const Vec2& v : values) {
    if (!are_finite(v.x, v.y)) return fail(place, "finite numbers");
    all.push_back({v.x, v.y});
  }
  return std::pair{type_for(place.row, {ParameterType::point2, ParameterType::vector2}), Values(std::move(all))};
}

ParameterReader::Typed ParameterReader::typed(const std::vector<Vec3>& values, const Place& place) {
  std::vector<Vec3f> all;
  for (const Vec3& v : values) {
    if (!are_finite(v.x, v.y, v.z)) return fail(place, "finite numbers");
    all.push_back({v.x, v.y, v.z});
  }
  return std::pair{type_for(place.row, {ParameterType::point3, ParameterType::vector3, ParameterType::normal}),
                   Values(std::move(all))};
}

ParameterReader::Typed ParameterReader::typed(const std::vector<Rgb>& values, const Place& place) {
  std::vector<SpectrumValue> all;
  for (const Rgb& v : values) {
    if (!are_finite(v.r, v.g, v.b)) return fail(place, "finite numbers");
    all.emplace_back(RgbValue{{v.r, v.g, v.b}, "srgb"});
  }
  return std::pair{ParameterType::spectrum, Values(std::move(all))};
}

ParameterReader::Typed ParameterReader::typed(const std::vector<MaterialId>& values, const Place& place) {
  std::vector<std::string> names;
  for (MaterialId id : values) {
    if (std::size_t(id) >= content_.materials.size()) return fail(place, "materials of the same scene");
    names.push_back(name_of_material(std::size_t(id)));
  }
  return std::pair{ParameterType::string, Values(std::move(names))};
}

ParameterReader::Typed ParameterReader::typed(const SampledSpectrum& value, const Place& place) {
  if (value.wavelengths.size() != value.values.size()) return fail(place, "as many wavelengths as values");
  std::vector<float> pairs;
  for (std::size_t i = 0; i < value.values.size(); ++i) {
    if (!are_finite(value.wavelengths[i], value.values[i])) return fail(place, "finite numbers");
    pairs.insert(pairs.end(), {value.wavelengths[i], value.values[i]});
  }
  auto sampled = pbrt::sampled_from_pairs(pairs, place.where, report_);
  if (!sampled) return std::nullopt;
  return std::pair{ParameterType::spectrum, Values(std::vector<SpectrumValue>{*std::move(sampled)})};
}

ParameterReader::Typed ParameterReader::typed(const NamedSpectrum& value, const Place& place) {
  auto named = pbrt::named_spectrum(value.name, folder_, place.where, report_);
  if (!named) return std::nullopt;
  return std::pair{ParameterType::spectrum, Values(std::vector<SpectrumValue>{*std::move(named)})};
}

ParameterReader::Typed ParameterReader::typed(const Blackbody& value, const Place& place) {
  if (!(value.kelvin > 0 && std::isfinite(value.kelvin))) return fail(place, "a positive temperature, in kelvin");
  return std::pair{ParameterType::spectrum, Values(std::vector<SpectrumValue>{montelux::Blackbody{value.kelvin}})};
}

ParameterReader::Typed ParameterReader::typed(TextureId value, const Place& place) {
  const auto i = std::size_t(value);
  if (i >= content_.textures.size()) return fail(place, "a texture of the same scene");
  // What takes both kinds takes that of the texture that it is a parameter of.
  const bool is_number = content_.textures[i].kind == TextureKind::number;
  const auto fits = [&](ParameterType type) {
    return takes(place.row, type) && type_fits(*place.row, type, place.kind);
  };
  const bool good = fits(is_number ? ParameterType::number : ParameterType::spectrum);
  if (takes(place.row, ParameterType::texture) && !good)
    return fail(place, is_number ? "a texture of colours; " + name_of_texture(i) + " is one of numbers"
                                 : "a texture of numbers; " + name_of_texture(i) + " is one of colours");
  return std::pair{ParameterType::texture, Values(TextureName{name_of_texture(i)})};
}

ParameterList ParameterReader::read(const Parameters& parameters, const EntitySpec& spec, const SourceLocation& where,
                                    std::optional<montelux::TextureKind> kind) {
  ParameterList list;
  for (const Parameter& parameter : parameters) {
    const Place place{parameter.name, find_parameter(spec, parameter.name), where, kind};
    if (list.find(parameter.name)) {
      report_.error(where, "'" + parameter.name + "' is stated twice");
      continue;
    }
    Typed value = std::visit([&](const auto& v) { return typed(v, place); }, parameter.value.data());
    if (value) list.add({parameter.name, value->first, std::move(value->second), where});
  }
  return list;
}

}  // namespace montelux::api
