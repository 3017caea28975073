// Shapes of every kind at many scales, and random rays, for the tests of geometry.
#pragma once
#include <string>
#include <vector>

#include "geometry/double3.h"
#include "geometry/shape.h"
#include "mc/random.h"

namespace montelux::test {

using Stream = RandomStream<float>;

inline float uniform(Stream& r, float low, float high) { return low + (high - low) * r.next(); }

inline Vec3f random_direction(Stream& r) {
  float z = 1 - 2 * r.next(), s = safe_sqrt(1 - z * z);
  SinCos<float> phi = sin_cos_two_pi(r.next());
  return {s * phi.cos, s * phi.sin, z};
}

struct NamedShape {
  std::string name;
  Shape shape;
  float size;  // the order of its extent in the world
};

inline BilinearPatch twisted_patch(float s) {
  BilinearPatch q;
  q.p = {Vec3f{-s, -s, 0.3f * s}, Vec3f{1.1f * s, -0.8f * s, -0.4f * s}, Vec3f{-0.9f * s, s, -0.5f * s},
         Vec3f{0.7f * s, 1.2f * s, 0.6f * s}};
  return q;
}

// One or more of every kind, whole and in part, under a transform that turns and shifts them at the scale.
inline std::vector<NamedShape> shapes_at(float s) {
  Transform place = translate(2 * s, -s, 0.5 * s) * rotate(40, 1, 2, 3) * scale(s, s, s);
  Transform mirror = place * scale(-1, 1, 1), squash = place * scale(1, 0.5, 1.5);
  return {{"sphere", Sphere{place, false, 1, -1, 1, 360}, s},
          {"part of a sphere", Sphere{place, true, 1, -0.6f, 0.8f, 250}, s},
          {"mirrored sphere", Sphere{mirror, false, 1, -1, 1, 360}, s},
          {"ellipsoid", Sphere{squash, false, 1, -1, 1, 360}, s},
          {"disk", Disk{place, false, 0.2f, 1, 0, 360}, s},
          {"part of a ring", Disk{squash, true, -0.2f, 1, 0.4f, 200}, s},
          {"cylinder", Cylinder{place, false, 0.7f, -1, 1, 360}, s},
          {"part of an elliptic cylinder", Cylinder{squash, false, 0.7f, -0.5f, 1, 300}, s},
          {"twisted patch", twisted_patch(s), s},
          {"flat patch", BilinearPatch{{Vec3f{0, 0, 0}, Vec3f{s, 0, 0}, Vec3f{0, s, s}, Vec3f{s, s, s}}}, s}};
}

}  // namespace montelux::test
