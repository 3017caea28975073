#include "integrator/path/settings.h"

namespace montelux {

EntitySpec path_spec() {
  using enum ParameterType;
  return {"path",
          "path tracing: next-event estimation and BSDF sampling by MIS, Russian roulette",
          {{"maxdepth", {integer}, "most bounces; default: as the scene asks, else none", 0, 2147483647, {"none"}},
           {"roulette-depth", {integer}, "scattering events before roulette; default 2", 0, 1 << 20},
           {"lanes", {string}, "paths side by side; default native", 0, 0, {"one", "native"}}}};
}

PathSettings path_settings(const ParameterList& list) {
  PathSettings s;
  s.roulette_depth = list.integer("roulette-depth", s.roulette_depth);
  s.lanes = list.string("lanes", "native") == "one" ? Lanes::one : Lanes::native;
  return s;
}

}  // namespace montelux
