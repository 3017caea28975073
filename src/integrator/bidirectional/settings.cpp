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

Fields<VcmSettings> merging_fields() {
  using S = VcmSettings;
  Fields<S> fields;
  fields
      .integer("photons", &S::photons,
               "light paths in each frame, at least one per pixel; 0: one per pixel, at least 16384", 0, 1 << 28)
      .number("radius", &S::radius, "radius of the first frame in world units; 0: three pixels wide", 0, 1e30)
      .number("alpha", &S::alpha, "share of the photons that is kept as the radius shrinks; 1: constant radius", 1e-3,
              1)
      .choice<PhotonKernel>("kernel", &S::kernel, "weight of a photon by its distance", photon_kernel_names())
      .integer("frames", &S::frames, "maximum number of frames over which the radius shrinks, which form one pass", 1,
               1 << 16);
  return fields;
}
Fields<BidirectionalPaths> connecting_fields() {
  Fields<BidirectionalPaths> fields;
  fields.boolean("connect", &BidirectionalPaths::connect,
                 "connections of vertices beside mergings; off: mergings alone");
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

EntitySpec vcm_spec() {
  EntitySpec spec{"vcm",
                  "vertex connection and merging: bidirectional path tracing and photon mapping by one set of weights; "
                  "finds caustics, also in mirrors and through glass",
                  merging_fields().specs({})};
  for (ParameterSpec& more : connecting_fields().specs({})) spec.parameters.push_back(std::move(more));
  for (ParameterSpec& more : path_fields().specs({})) spec.parameters.push_back(std::move(more));
  return spec;
}

VcmSettings vcm_settings(const ParameterList& list, std::optional<int> max_depth) {
  VcmSettings s;
  (void)merging_fields().read(list, s);
  (void)connecting_fields().read(list, s.paths);
  (void)path_fields().read(list, s.paths);
  s.paths.max_depth = max_depth;
  return s;
}

}  // namespace montelux
