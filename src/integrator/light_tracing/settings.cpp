#include "integrator/light_tracing/settings.h"

namespace montelux {

namespace {

Fields<LightTracingSettings> light_tracing_fields() {
  using S = LightTracingSettings;
  Fields<S> fields;
  fields.other(max_depth_spec())
      .integer("roulette-depth", &S::roulette_depth, "scattering events before roulette", 0, 1 << 20)
      .choice<Lanes>("lanes", &S::lanes, "number of paths traced together", lanes_names());
  return fields;
}

}  // namespace

EntitySpec light_tracing_spec() {
  return {"light",
          "light tracing: paths from the lights, each vertex connected with the lens; finds caustics, not what is seen "
          "in mirrors or through smooth glass",
          light_tracing_fields().specs({})};
}

LightTracingSettings light_tracing_settings(const ParameterList& list, std::optional<int> max_depth) {
  LightTracingSettings s;
  // None of the rows can fail: their values have been checked.
  (void)light_tracing_fields().read(list, s);
  s.max_depth = max_depth;
  return s;
}

}  // namespace montelux
