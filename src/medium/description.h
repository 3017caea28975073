// Participating media as stated by a scene: plain data.
#pragma once
#include <optional>
#include <string>
#include <variant>

#include "medium/homogeneous.h"

namespace montelux {

// The closed list of models.
using MediumModel = std::variant<HomogeneousMediumDesc>;

struct MediumDesc {
  std::string name;
  std::optional<MediumModel> model{};  // none: it was left out by a lenient reading, and is empty space
  SourceLocation where{};
};

}  // namespace montelux
