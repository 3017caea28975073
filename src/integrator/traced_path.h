// One path of an integrator, vertex by vertex: what explains a bright pixel.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "color/spectrum.h"
#include "image/layers.h"
#include "material/material.h"
#include "math/vec.h"

namespace montelux {

// A place where a path scattered, crossed an interface or ended.
struct PathVertex {
  enum class Kind { surface, interface, medium };
  Kind kind = Kind::surface;
  Vec3f p, normal;                         // world space; the shading normal, zero in a medium
  float distance = 0;                      // from the vertex before
  std::uint32_t object = 0, material = 0;  // of a surface: number of the object from 1, and of its material
  BsdfKind model{};                        // of a surface
  Rgb throughput;                          // of the path that arrives
  Vec3f direction;                         // in which the path continues
  float density = 0;                       // of it, per steradian, where it is not that of a delta
  bool delta = false;                      // the path went straight on, or scattered in a direction without a density
  float survival = 1;                      // the probability that roulette let the path survive
  bool continues = false;                  // else the path ends here
};

// Light that reached the pixel.
struct PathContribution {
  std::size_t vertex = 0;  // number of the vertex at which it was found; the one after the last: beyond the scene
  Rgb value;               // as it counts in the sample: weighted, with the camera's and the filter's factors
  std::uint32_t bounces = 0;
  std::uint32_t source = 0;  // number of the light; the number after the last: a medium
  Technique technique = Technique::emission;
};

struct TracedPath {
  Vec3f origin, direction;  // of the camera ray
  std::vector<PathVertex> vertices;
  std::vector<PathContribution> contributions;
  Rgb radiance{};  // of the sample: the sum of the contributions
};

}  // namespace montelux
