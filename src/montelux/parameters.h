// From values in code to parameters of the tables' types. Inside the library only.
#pragma once
#include "io/checks.h"
#include "montelux/content.h"

namespace montelux::api {

// Names of the parts of a scene, under which they refer to each other and appear in messages.
std::string name_of_material(std::size_t i);
std::string name_of_texture(std::size_t i);

// The types as a program knows them.
std::string_view name_of_type(ParameterType type);

// Turns the parameters of models into lists, and reports values that are not finite and parts that are not there.
class ParameterReader {
 public:
  ParameterReader(const Scene::Content& content, const std::string& folder, Reporter& report)
      : content_(content), folder_(folder), report_(report) {}

  // `kind`: of a texture's parameters.
  ParameterList read(const Parameters& parameters, const EntitySpec& spec, const SourceLocation& where,
                     std::optional<montelux::TextureKind> kind);

 private:
  struct Place {
    const std::string& name;
    const ParameterSpec* row;  // null where the table has no such parameter
    const SourceLocation& where;
    std::optional<montelux::TextureKind> kind;
  };
  using Typed = std::optional<std::pair<ParameterType, Values>>;

  Typed typed(const std::vector<bool>& values, const Place& place);
  Typed typed(const std::vector<int>& values, const Place& place);
  Typed typed(const std::vector<double>& values, const Place& place);
  Typed typed(const std::vector<std::string>& values, const Place& place);
  Typed typed(const std::vector<Vec2>& values, const Place& place);
  Typed typed(const std::vector<Vec3>& values, const Place& place);
  Typed typed(const std::vector<Rgb>& values, const Place& place);
  Typed typed(const std::vector<MaterialId>& values, const Place& place);
  Typed typed(const SampledSpectrum& value, const Place& place);
  Typed typed(const NamedSpectrum& value, const Place& place);
  Typed typed(const Blackbody& value, const Place& place);
  Typed typed(TextureId value, const Place& place);
  Typed fail(const Place& place, const std::string& takes);

  const Scene::Content& content_;
  const std::string& folder_;
  Reporter& report_;
};

}  // namespace montelux::api
