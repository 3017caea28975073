// Axis-aligned boxes.
#pragma once
#include <limits>

#include "math/vec.h"

namespace montelux {

// The closed box [low, high]; the default box is empty and neutral to `join`.
struct Bounds3 {
  Vec3f low{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
            std::numeric_limits<float>::infinity()};
  Vec3f high{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
             -std::numeric_limits<float>::infinity()};

  bool is_empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  bool contains(Vec3f p) const {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
  }
};

// The smallest box around both.
inline Bounds3 join(const Bounds3& a, const Bounds3& b) { return {min(a.low, b.low), max(a.high, b.high)}; }
inline Bounds3 join(const Bounds3& a, Vec3f p) { return {min(a.low, p), max(a.high, p)}; }

// The closed ball of that radius about the centre.
struct Ball {
  Vec3f centre{0, 0, 0};
  float radius = 0;
};

}  // namespace montelux
