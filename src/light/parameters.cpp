// Lights as stated by a scene.
#include <algorithm>

#include "light/adder.h"

namespace montelux {

namespace {

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
  LightAdder adder(*this, light, inputs, diagnostics);
  return std::visit([&](const auto& stated) { return stated.add(adder); }, light.model);
}

}  // namespace montelux
