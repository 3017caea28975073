#include "io/pbrt_reference.h"

#include "io/checks.h"
#include "io/numbers.h"
#include "io/pbrt/parameters.h"

namespace montelux {

namespace {

std::string types_text(const ParameterSpec& spec) {
  std::string text;
  for (ParameterType type : spec.types) text += (text.empty() ? "" : ", ") + std::string(pbrt::spelling(type));
  return text;
}

// The range of a parameter, or its choices; empty if anything is valid.
std::string valid_text(const ParameterSpec& spec) {
  constexpr double open = 1e29;
  std::string text;
  for (std::string_view choice : spec.choices) text += (text.empty() ? "" : ", ") + std::string(choice);
  if (!text.empty() || spec.types.front() == ParameterType::string) return text;
  bool has_low = spec.low > -open, has_high = spec.high < open && spec.high < 2147483647.0;
  bool positive = spec.low > 0 && spec.low < 1e-20;
  if (has_low && spec.low <= -2147483647.0) has_low = false;
  if (positive) text = "> 0";
  if (has_low && !positive) text = ">= " + shortest(spec.low);
  if (has_high) text += (text.empty() ? "<= " : ", <= ") + shortest(spec.high);
  return text;
}

std::string entity_text(const EntitySpec& entity) {
  std::string text = "### " + std::string(entity.name) + "\n\n" + std::string(entity.meaning) + ".";
  if (entity.later) text += " Not supported yet: an error, unless reading is lenient.";
  if (!entity.instead.empty()) text += " Replaced by `" + std::string(entity.instead) + "`.";
  text += "\n\n";
  if (entity.parameters.empty()) return text;
  text += "| parameter | type | valid | meaning |\n| --- | --- | --- | --- |\n";
  for (const ParameterSpec& p : entity.parameters)
    text += "| `" + std::string(p.name) + "` | " + types_text(p) + (p.array ? " (list)" : "") + " | " + valid_text(p) +
            " | " + std::string(p.meaning) + (p.later ? " (no effect yet)" : "") + " |\n";
  return text + "\n";
}

std::string family_text(std::string_view title, std::span<const EntitySpec> table) {
  std::string text = "## " + std::string(title) + "\n\n";
  for (const EntitySpec& entity : table) text += entity_text(entity);
  return text;
}

}  // namespace

std::string pbrt_reference() {
  std::string text;
  text += family_text("Material, MakeNamedMaterial", table_of(Family::material));
  text += family_text("Texture", table_of(Family::texture));
  text += family_text("LightSource", table_of(Family::light));
  text += family_text("AreaLightSource", table_of(Family::area_light));
  text += family_text("Shape", table_of(Family::shape));
  text += family_text("Camera", table_of(Family::camera));
  text += family_text("Film", table_of(Family::film));
  text += family_text("PixelFilter", table_of(Family::filter));
  text += family_text("Sampler", table_of(Family::sampler));
  text += family_text("Integrator", table_of(Family::integrator));
  text += family_text("Accelerator", table_of(Family::accelerator));
  text += family_text("MakeNamedMedium", table_of(Family::medium));
  text += family_text("Option", table_of(Family::option));
  return text;
}

}  // namespace montelux
