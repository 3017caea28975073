#include "integrator/irradiance_cache/settings.h"

#include <fmt/format.h>

namespace montelux {

namespace {

Fields<IrradianceCacheSettings> irradiance_cache_fields() {
  using S = IrradianceCacheSettings;
  Fields<S> fields;
  fields
      .number("accuracy", &S::accuracy, "largest estimated error of a record where it is used: smaller, more records",
              1e-3, 1)
      .integer("samples", &S::samples, "paths of each record, in strata", 8, 1 << 16)
      .number("min-spacing", &S::min_spacing,
              "least radius within which a record is used, in world units; 0: two pixels wide", 0, 1e30)
      .number("max-spacing", &S::max_spacing,
              "largest radius within which a record is used, in world units; 0: 5 % of the scene's diagonal", 0, 1e30)
      .boolean("gradients", &S::gradients, "records are extrapolated by their gradients")
      .boolean("clamping", &S::clamping, "neighbouring records bound each other's distances to surfaces")
      .integer("records", &S::records, "maximum number of records of a pass", 1, 1 << 24)
      .number("pairs", &S::pairs, "share of the samples that are compared with paths, to measure the bias", 0, 1)
      .integer("frames", &S::frames, "maximum number of frames with the same cache, which form one pass", 1, 1 << 16)
      .other(max_depth_spec())
      .integer("roulette-depth", &S::roulette_depth, "scattering events before roulette", 0, 1 << 20)
      .choice<Lanes>("lanes", &S::lanes, "number of paths traced together", lanes_names());
  return fields;
}

}  // namespace

EntitySpec irradiance_cache_spec() {
  return {"irradiance-cache",
          "path tracing in which indirect light at diffuse surfaces is interpolated between records, with gradients; "
          "for diffuse interiors",
          irradiance_cache_fields().specs({})};
}

Result<IrradianceCacheSettings> irradiance_cache_settings(const ParameterList& list, std::optional<int> max_depth) {
  IrradianceCacheSettings s;
  if (Status read = irradiance_cache_fields().read(list, s); !read) return read.failure();
  if (s.max_spacing > 0 && s.max_spacing < s.min_spacing)
    return Failure{
        fmt::format("max-spacing must not be below min-spacing; found {} and {}", s.max_spacing, s.min_spacing)};
  s.max_depth = max_depth;
  return s;
}

}  // namespace montelux
