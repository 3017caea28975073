#include "io/checks.h"

#include <algorithm>
#include <array>

#include "camera/table.h"
#include "filter/table.h"
#include "io/numbers.h"
#include "io/pbrt/picture_models.h"
#include "io/text_file.h"
#include "light/table.h"
#include "material/table.h"
#include "medium/table.h"
#include "scene/shape_models.h"
#include "texture/table.h"

namespace montelux {

std::string_view name_of(Family family) {
  constexpr std::array<std::string_view, 13> names{"material",    "texture", "light", "area light", "shape",
                                                   "camera",      "filter",  "film",  "sampler",    "integrator",
                                                   "accelerator", "medium",  "option"};
  return names[static_cast<std::size_t>(family)];
}

std::span<const EntitySpec> table_of(Family family) {
  switch (family) {
    case Family::material:
      return material_models().specs();
    case Family::texture:
      return texture_models().specs();
    case Family::light:
      return light_models().specs();
    case Family::area_light:
      return area_light_models().specs();
    case Family::shape:
      return shape_models().specs();
    case Family::camera:
      return camera_models().specs();
    case Family::filter:
      return filter_models().specs();
    case Family::film:
      return pbrt::film_models().specs();
    case Family::sampler:
      return pbrt::sampler_models().specs();
    case Family::integrator:
      return pbrt::integrator_models().specs();
    case Family::accelerator:
      return pbrt::accelerator_models().specs();
    case Family::medium:
      return medium_models().specs();
    case Family::option:
      return pbrt::option_models().specs();
  }
  return {};
}

namespace {

struct Renamed {
  std::string_view old_name, new_name;
};

// Names from older versions of the format that edit distance would not find.
constexpr std::array<Renamed, 20> renamed{{{"matte", "diffuse"},
                                           {"glass", "dielectric"},
                                           {"mirror", "conductor"},
                                           {"metal", "conductor"},
                                           {"plastic", "coateddiffuse"},
                                           {"uber", "coateddiffuse"},
                                           {"substrate", "coateddiffuse"},
                                           {"disney", "coateddiffuse"},
                                           {"translucent", "diffusetransmission"},
                                           {"fourier", "measured"},
                                           {"image", "rgb"},
                                           {"random", "independent"},
                                           {"lowdiscrepancy", "paddedsobol"},
                                           {"02sequence", "paddedsobol"},
                                           {"directlighting", "path"},
                                           {"whitted", "path"},
                                           {"lanczossinc", "sinc"},
                                           {"Kd", "reflectance"},
                                           {"mapname", "filename"},
                                           {"bumpmap", "displacement"}}};

std::string joined(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

// "did you mean ...?", or the list of valid names.
std::string hint_for(const std::string& name, const std::vector<std::string_view>& valid) {
  auto has = [&](std::string_view candidate) {
    return std::find(valid.begin(), valid.end(), candidate) != valid.end();
  };
  for (const Renamed& r : renamed)
    if (r.old_name == name && has(r.new_name)) return "its name is '" + std::string(r.new_name) + "' in pbrt-v4";
  std::string_view near = nearest_name(name, valid);
  std::string hint = near.empty() ? "" : "did you mean '" + std::string(near) + "'? ";
  return hint + (valid.empty() ? "it takes no parameters" : "valid: " + joined(valid));
}

std::string types_of(const ParameterSpec& spec, const CheckContext& context) {
  std::string text;
  for (ParameterType type : spec.types)
    if (type_fits(spec, type, context.kind))
      text += (text.empty() ? "" : " or ") + std::string(context.name_of_type(type));
  return text;
}

std::string range_of(const ParameterSpec& spec, double value) {
  constexpr double open_end = 1e29;
  if (value < spec.low)
    return spec.low == 0                      ? "not be negative"
           : spec.low > 0 && spec.low < 1e-20 ? "be positive"
                                              : "be at least " + shortest(spec.low);
  return spec.high > open_end ? "have a sensible magnitude" : "be at most " + shortest(spec.high);
}

// Checks one parameter against its row.
class RangeCheck {
 public:
  RangeCheck(const ParameterSpec& spec, const Parameter& parameter, Reporter& report)
      : spec_(spec), parameter_(parameter), report_(report) {}

  bool operator()(const std::vector<float>& values) {
    return all(values, [this](float v) { return in_range(static_cast<double>(v)); });
  }
  bool operator()(const std::vector<int>& values) {
    return all(values, [this](int v) { return in_range(v); });
  }
  bool operator()(const std::vector<std::uint8_t>& values) {
    return all(values, [](std::uint8_t) { return true; });
  }
  bool operator()(const std::vector<std::string>& values) {
    return all(values, [this](const std::string& v) { return is_choice(v); });
  }
  bool operator()(const std::vector<Vec2f>& values) {
    return all(values, [](Vec2f) { return true; });
  }
  bool operator()(const std::vector<Vec3f>& values) {
    return all(values, [](Vec3f) { return true; });
  }
  bool operator()(const std::vector<SpectrumValue>& values) {
    return all(values, [this](const SpectrumValue& v) { return spectrum_in_range(v); });
  }
  bool operator()(const TextureName&) { return true; }

 private:
  template <class T, class Check>
  bool all(const std::vector<T>& values, Check check) {
    if (!spec_.array && values.size() != 1) {
      report_.error(parameter_.where,
                    "'" + std::string(spec_.name) + "' takes one value; found " + std::to_string(values.size()));
      return false;
    }
    return std::all_of(values.begin(), values.end(), check);
  }
  bool in_range(double value) {
    // Numbers have single precision, in which an end may lie just beyond itself.
    const double low = std::min(spec_.low, double(float(spec_.low)));
    const double high = std::max(spec_.high, double(float(spec_.high)));
    if (value >= low && value <= high) return true;
    // A float is shown with its own digits, an integer with all of its digits.
    const auto as_float = static_cast<float>(value);
    const bool is_float = static_cast<double>(as_float) == value;
    report_.error(parameter_.where, "'" + std::string(spec_.name) + "' must " + range_of(spec_, value) + "; found " +
                                        (is_float ? shortest(as_float) : shortest(value)));
    return false;
  }
  bool spectrum_in_range(const SpectrumValue& value) {
    if (const auto* rgb = std::get_if<RgbValue>(&value))
      return in_range(static_cast<double>(rgb->rgb.c[0])) && in_range(static_cast<double>(rgb->rgb.c[1])) &&
             in_range(static_cast<double>(rgb->rgb.c[2]));
    if (const auto* sampled = std::get_if<SampledValue>(&value))
      return std::all_of(sampled->values.begin(), sampled->values.end(),
                         [this](float v) { return in_range(static_cast<double>(v)); });
    return true;
  }
  bool is_choice(const std::string& value) {
    if (spec_.choices.empty() || std::find(spec_.choices.begin(), spec_.choices.end(), value) != spec_.choices.end())
      return true;
    report_.error(parameter_.where, "'" + printable(value) + "' is not a value of '" + std::string(spec_.name) + "'",
                  hint_for(value, spec_.choices));
    return false;
  }

  const ParameterSpec& spec_;
  const Parameter& parameter_;
  Reporter& report_;
};

}  // namespace

void expect_uses(const ParameterList& checked, const EntitySpec& spec) {
  checked.forget_uses();
  for (const ParameterSpec& row : spec.parameters)
    if (row.later || row.choices.size() == 1) checked.use(row.name);
}

void report_unknown_name(Family family, const std::string& name, const SourceLocation& where, Reporter& report) {
  report.error(where, "there is no " + std::string(name_of(family)) + " '" + printable(name) + "'",
               hint_for(name, names_of(table_of(family))));
}

bool type_fits(const ParameterSpec& spec, ParameterType type, std::optional<TextureKind> kind) {
  if (std::find(spec.types.begin(), spec.types.end(), type) == spec.types.end()) return false;
  // A parameter that may be either kind has that of the texture.
  auto takes = [&](ParameterType t) { return std::find(spec.types.begin(), spec.types.end(), t) != spec.types.end(); };
  if (!kind || !takes(ParameterType::number) || !takes(ParameterType::spectrum)) return true;
  if (type == ParameterType::number) return *kind == TextureKind::number;
  if (type == ParameterType::spectrum) return *kind == TextureKind::spectrum;
  return true;
}

ParameterList checked_parameters(Family family, const EntitySpec& spec, const ParameterList& stated,
                                 const CheckContext& context) {
  ParameterList good;
  std::string owner = std::string(name_of(family)) + " '" + std::string(spec.name) + "'";
  if (family == Family::option) owner = "Option";
  for (const Parameter& parameter : stated.all()) {
    const ParameterSpec* row = find_parameter(spec, parameter.name);
    if (!row) {
      std::vector<std::string_view> names;
      for (const ParameterSpec& p : spec.parameters) names.push_back(p.name);
      context.report.tolerable(parameter.where, owner + " has no parameter '" + printable(parameter.name) + "'",
                               hint_for(parameter.name, names));
      continue;
    }
    if (!type_fits(*row, parameter.type, context.kind)) {
      context.report.error(parameter.where, "'" + parameter.name + "' of " + owner + " must be " +
                                                types_of(*row, context) + ", not " +
                                                std::string(context.name_of_type(parameter.type)));
      continue;
    }
    if (!std::visit(RangeCheck(*row, parameter, context.report), parameter.values)) continue;
    if (row->later) {
      const std::string message = "'" + parameter.name + "' of " + owner + " has no effect yet";
      context.report.add({Severity::warning, parameter.where, message, {}, {message + " ({n} times)"}});
    }
    good.add(parameter);
  }
  return good;
}

}  // namespace montelux
