// What the structs need by which scenes state lights that are not surfaces. Spectra are of emitted light, in W/m^2/sr,
// W/sr or W/m^2 as said; files are images. Directions and places are in the space of the light.
//
// Besides its members, such a struct defines
//   static constexpr std::string_view name, meaning: of the light, in scene files;
//   static Fields<...> rows(): its parameters, by which readers, writer and documentation know them; those that all
//     lights have (LightDesc) are not among them;
//   std::optional<LightId> add(LightAdder&) const: none if something is wrong, which has been reported.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "light/light.h"
#include "parameter/value.h"

namespace montelux {

template <class S>
class Fields;
class LightAdder;

}  // namespace montelux
