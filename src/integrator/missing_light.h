// Light of a scene that an integrator cannot find, however many samples it takes: it is named, since no noise shows it.
#pragma once
#include <string>
#include <vector>

#include "accel/accel.h"
#include "integrator/path_classes.h"
#include "scene/scene.h"

namespace montelux {

// Light of delta lights that comes to rough surfaces by way of smooth ones.
struct DeltaCaustics {
  std::vector<LightKind> lights;   // kinds of the lights, in their order
  std::vector<BsdfKind> surfaces;  // models of the smooth surfaces that it meets first, likewise
  bool any() const { return !lights.empty(); }
};

// Follows light from the scene's delta lights: what it finds is there; what is smaller than a few thousandths of all
// that it looks at may escape it. A rough surface counts whatever its colour. Takes no time where a scene has no delta
// lights or no smooth surfaces, else some milliseconds. A pure function of the scene. Without the light of chains of up
// to `chain_length` surfaces that are is_plain_specular(), which path:manifold finds.
DeltaCaustics delta_caustics(const Scene& scene, const Accel& accel, int chain_length = 0);

// Models of smooth surfaces through which, or in which, the camera sees light or rough surfaces, by some thousand
// camera rays of a picture of this size. A pure function of the scene.
std::vector<BsdfKind> smooth_surfaces_in_view(const Scene& scene, const Accel& accel, int width, int height);

// Whether the eye sees light that was scattered more than once, by a few thousand paths of a picture of this size.
bool has_indirect_light(const Scene& scene, const Accel& accel, int width, int height);

// One sort of light that is missing.
struct MissingLight {
  std::string name;      // for headers and machines: "light of point lights by way of smooth surfaces (dielectric)"
  std::string sentence;  // for people: what, why, and what finds it
};

// What an integrator that looks for light so does not find in this scene; nothing where it finds all that was seen.
// `chain_length`: of LightSearch::with_chains.
std::vector<MissingLight> missing_light(LightSearch search, const Scene& scene, const Accel& accel, int width,
                                        int height, int chain_length = 0);

}  // namespace montelux
