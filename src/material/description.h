// A material as stated by a scene: plain data, with the values that hold where nothing is stated.
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "material/models.h"
#include "parameter/input.h"

namespace montelux {

// A random choice between two materials at each point.
struct MixDesc {
  std::vector<std::string> materials{};  // the names of two
  NumberInput amount = 0.5f;             // share of the second

  static constexpr std::string_view name = "mix", meaning = "a random choice between two materials at each point";
  static Fields<MixDesc> rows();
  bool operator==(const MixDesc&) const = default;
};

// No scattering at all: bounds a medium.
struct InterfaceDesc {
  static constexpr std::string_view name = "interface", meaning = "no scattering at all: bounds a medium";
  static Fields<InterfaceDesc> rows();
  bool operator==(const InterfaceDesc&) const = default;
};

// What the models of the list state, a mixture, or an interface.
template <class Models>
struct StatedMaterials;
template <class... Model>
struct StatedMaterials<std::tuple<Model...>> {
  using type = std::variant<typename Model::Stated..., MixDesc, InterfaceDesc>;
};
using MaterialModel = StatedMaterials<BsdfModels<float>>::type;

struct MaterialDesc {
  std::string name{};  // empty if it was stated in place
  MaterialModel model{};
  // Of all but mixtures and interfaces.
  std::string normal_file{};  // an image of normals; a texture has precedence
  NormalMapDesc normals{};
  std::optional<NumberInput> displacement{};  // height of bumps in scene units, not applied yet
  SourceLocation where{};
};

}  // namespace montelux
