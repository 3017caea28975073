// The picture and how to compute it: from the words of a pbrt file to the description of a scene, and back.
#pragma once
#include "io/reporter.h"
#include "parameter/value.h"
#include "scene/description.h"

namespace montelux::pbrt {

// What a file states before WorldBegin, with parameters that have been checked; by default what pbrt assumes.
struct StatedPicture {
  Entity camera{"perspective", {}, {}};
  Entity film{"rgb", {}, {}};
  Entity filter{"gaussian", {}, {}};
  Entity sampler{"zsobol", {}, {}};
  Entity integrator{"volpath", {}, {}};
  Entity accelerator{"bvh", {}, {}};
  ParameterList options;
};

// Sets camera, film, filter, sampling, integrator and replaced names of the scene. Reports what Montelux does
// otherwise than the file states it, and parameters without effect.
void describe_picture(const StatedPicture& stated, SceneDesc& scene, Reporter& report);

// The reverse. Names that pbrt does not have are replaced: point sets by `zsobol`, integrators by `volpath`.
StatedPicture stated_picture(const SceneDesc& scene);

// Warns, at its position, of each parameter that nothing has looked up. `owner`: such as "film 'rgb'".

}  // namespace montelux::pbrt
