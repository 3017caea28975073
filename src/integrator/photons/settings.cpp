#include "integrator/photons/settings.h"

namespace montelux {

namespace {

Fields<SppmSettings> sppm_fields() {
  using S = SppmSettings;
  Fields<S> fields;
  fields.integer("photons", &S::photons, "light paths in each frame; 0: one per pixel, at least 16384", 0, 1 << 28)
      .number("radius", &S::radius, "radius of the first frame in world units; 0: three pixels wide", 0, 1e30)
      .number("medium-radius", &S::medium_radius,
              "the same in participating media, where photons are gathered in balls; 0: holds about 2 photons", 0, 1e30)
      .number("alpha", &S::alpha, "share of the photons that is kept as the radius shrinks; 1: constant radius", 1e-3,
              1)
      .choice<PhotonKernel>("kernel", &S::kernel, "weight of a photon by its distance", photon_kernel_names())
      .boolean("nee", &S::nee, "direct light by next-event estimation and BSDF sampling; off: by photons")
      .number("glossy", &S::glossy,
              "directions whose sampling density per steradian is above this are followed by paths, others gather "
              "photons",
              0, 1e30)
      .integer("frames", &S::frames, "maximum number of frames over which the radius shrinks, which form one pass", 1,
               1 << 16)
      .other(max_depth_spec())
      .integer("roulette-depth", &S::roulette_depth, "scattering events before roulette", 0, 1 << 20)
      .choice<Lanes>("lanes", &S::lanes, "number of paths traced together", lanes_names());
  return fields;
}

Fields<PhotonMapSettings> photonmap_fields() {
  using S = PhotonMapSettings;
  Fields<S> fields;
  fields.integer("photons", &S::photons, "light paths of the global map; 0: one per pixel, at least 16384", 0, 1 << 28)
      .integer("caustic-photons", &S::caustic_photons,
               "light paths of the map of caustics; 0: one per pixel, at least 16384", 0, 1 << 28)
      .integer("nearest", &S::nearest, "an estimate takes so many photons, the nearest ones; 0: all within the radius",
               0, 1 << 20)
      .number("radius", &S::radius,
              "radius of an estimate by the global map, in world units, with nearest the largest one; 0: one that "
              "holds some "
              "64 photons, or the nearest ones",
              0, 1e30)
      .number("caustic-radius", &S::caustic_radius, "the same by the map of caustics; 0: three pixels wide", 0, 1e30)
      .number("medium-radius", &S::medium_radius,
              "the same in participating media, by both maps; 0: one that holds as many photons as radius", 0, 1e30)
      .choice<PhotonKernel>("kernel", &S::kernel, "weight of a photon by its distance", photon_kernel_names())
      .integer("gather-rays", &S::gather_rays,
               "rays from each surface in view to the surfaces where the global map is looked up; 0: it is looked up "
               "at the surface in view",
               0, 1 << 12)
      .boolean("nee", &S::nee, "direct light by next-event estimation and BSDF sampling; off: by photons")
      .number("glossy", &S::glossy,
              "directions whose sampling density per steradian is above this are followed by paths, others gather "
              "photons",
              0, 1e30)
      .integer("frames", &S::frames, "maximum number of frames with the same maps, which form one pass", 1, 1 << 16)
      .other(max_depth_spec())
      .integer("roulette-depth", &S::roulette_depth, "scattering events before roulette", 0, 1 << 20)
      .choice<Lanes>("lanes", &S::lanes, "number of paths traced together", lanes_names());
  return fields;
}

}  // namespace

NamedValues<PhotonKernel> photon_kernel_names() {
  return {
      {"constant", PhotonKernel::constant}, {"epanechnikov", PhotonKernel::epanechnikov}, {"cone", PhotonKernel::cone}};
}

EntitySpec photonmap_spec() {
  return {
      "photonmap",
      "photon mapping: photons from the lights in a global map and a map of caustics; indirect light by gather rays, "
      "which look up the global map where they end",
      photonmap_fields().specs({})};
}

Result<PhotonMapSettings> photonmap_settings(const ParameterList& list, std::optional<int> max_depth) {
  PhotonMapSettings s;
  if (Status read = photonmap_fields().read(list, s); !read) return read.failure();
  s.max_depth = max_depth;
  return s;
}

EntitySpec sppm_spec() {
  return {
      "sppm",
      "stochastic progressive photon mapping: photons from the lights, gathered at the first rough surface within a "
      "radius that shrinks; finds caustics, also in mirrors and through glass",
      sppm_fields().specs({})};
}

Result<SppmSettings> sppm_settings(const ParameterList& list, std::optional<int> max_depth) {
  SppmSettings s;
  if (Status read = sppm_fields().read(list, s); !read) return read.failure();
  s.max_depth = max_depth;
  return s;
}

}  // namespace montelux
