// Where an instance is at a time.
#pragma once
#include "math/transform.h"
#include "scene/geometry_store.h"

namespace montelux {

// The map of an instance to the world at a time in [0, 1].
Transform place_at(const GeometryStore& store, std::uint32_t instance, float time);

// A point of time among the poses of a deforming mesh: those before and after it, and its place between them.
struct PoseTime {
  std::uint32_t before = 0, after = 0;  // numbers of poses
  float fraction = 0;
};
PoseTime pose_time(const GeometryRow& row, float time);

}  // namespace montelux
