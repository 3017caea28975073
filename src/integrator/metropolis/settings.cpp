#include "integrator/metropolis/settings.h"

namespace montelux {

namespace {

Fields<MetropolisSettings> metropolis_fields() {
  using S = MetropolisSettings;
  Fields<S> fields;
  fields.other(max_depth_spec())
      .choice<MetropolisStrategies>("strategies", &S::strategies,
                                    "paths that the chains vary: camera paths, or pairs of subpaths from the camera "
                                    "and from a light, joined by one of the strategies of bdpt",
                                    {{"path", MetropolisStrategies::path}, {"bdpt", MetropolisStrategies::bdpt}})
      .number("large-step", &S::large_step, "probability of a mutation that draws all numbers again", 0.01, 1)
      .number("largest-move", &S::largest_move, "of each number in the other mutations; the smallest is 1/16 of it",
              1e-6, 0.5)
      .integer("bootstrap", &S::bootstrap, "independent paths for each pixel of a pass, for brightness and seeds", 1,
               256)
      .optional("roulette-depth", &S::roulette_depth,
                "scattering events before roulette; default 2, with strategies=bdpt 30", 0, 1 << 20);
  return fields;
}

}  // namespace

EntitySpec metropolis_spec() {
  return {"metropolis",
          "Metropolis light transport in primary sample space: Markov chains mutate the random numbers of paths; for "
          "light that few paths carry",
          metropolis_fields().specs({})};
}

MetropolisSettings metropolis_settings(const ParameterList& list, std::optional<int> max_depth) {
  MetropolisSettings s;
  // None of the rows can fail: their values have been checked.
  (void)metropolis_fields().read(list, s);
  s.max_depth = max_depth;
  return s;
}

}  // namespace montelux
