#include "integrator/bidirectional/settings.h"

namespace montelux {

namespace {

Fields<BidirectionalPaths> path_fields() {
  using S = BidirectionalPaths;
  Fields<S> fields;
  fields.other(max_depth_spec())
      .choice<BidirectionalMis>("mis", &S::mis, "how the strategies are combined",
                                {{"balance", BidirectionalMis::balance}, {"power", BidirectionalMis::power}})
      .integer("roulette-depth", &S::roulette_depth, "scattering events of a subpath before roulette", 0, 1 << 20)
      .choice<Lanes>("lanes", &S::lanes, "number of paths traced together", lanes_names());
  return fields;
}

}  // namespace

EntitySpec bdpt_spec() {
  return {"bdpt",
          "bidirectional path tracing: paths from the eye and from the lights, every vertex of the one connected with "
          "every vertex of the other; finds caustics, also of small lamps",
          path_fields().specs({})};
}

BidirectionalPaths bdpt_settings(const ParameterList& list, std::optional<int> max_depth) {
  BidirectionalPaths s;
  // None of the rows can fail: their values have been checked.
  (void)path_fields().read(list, s);
  s.max_depth = max_depth;
  return s;
}

}  // namespace montelux
