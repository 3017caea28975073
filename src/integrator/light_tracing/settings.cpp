#include "integrator/light_tracing/settings.h"

namespace montelux {

EntitySpec light_tracing_spec() {
  using enum ParameterType;
  return {"light",
          "light tracing: paths from the lights, each vertex connected with the lens; finds caustics, not what is seen "
          "in mirrors or through smooth glass",
          {{"maxdepth",
            {integer},
            "maximum number of bounces; default: as the scene states, else none",
            0,
            2147483647,
            {"none"}},
           {"roulette-depth", {integer}, "scattering events before roulette; default 2", 0, 1 << 20},
           {"lanes", {string}, "paths side by side; default native", 0, 0, {"one", "native"}}}};
}

LightTracingSettings light_tracing_settings(const ParameterList& list, std::optional<int> max_depth) {
  LightTracingSettings s;
  s.max_depth = max_depth;
  s.roulette_depth = list.integer("roulette-depth", s.roulette_depth);
  s.lanes = list.string("lanes", "native") == "one" ? Lanes::one : Lanes::native;
  return s;
}

}  // namespace montelux
