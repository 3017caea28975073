// Maps that move: from one to another by a translation, a rotation and a stretch, each at constant speed.
#pragma once
#include <array>
#include <vector>

#include "math/affine.h"
#include "math/transform.h"

namespace montelux {

// An affine map taken apart: first the stretch S (symmetric), then the rotation R (as a unit quaternion), then the
// translation T: M = T R S, by polar decomposition (Shoemake and Duff 1992). A map that mirrors has det S < 0.
struct MotionKey {
  std::array<double, 3> translation{};
  std::array<double, 4> rotation{0, 0, 0, 1};  // x, y, z, w
  std::array<double, 9> stretch{1, 0, 0, 0, 1, 0, 0, 0, 1};
};
MotionKey decompose(const Transform& transform);

// The way from one map to another over t in [0, 1]: translation and stretch on straight lines, the rotation along the
// shorter arc at constant angular speed (Shoemake 1985), as pbrt-v4 has it. Where there are maps between, evenly
// spaced, from each to the next in this way.
class Motion {
 public:
  Motion() = default;
  Motion(const Transform& start, const Transform& end);
  Motion(const Transform& start, const std::vector<Transform>& later);

  // t outside of [0, 1] is taken as the nearer end, where the maps are those that were stated.
  Transform at(double t) const;
  // The same in every lane; t must lie in [0, 1].
  template <class F>
  Affine<F> at(F t) const;
  bool moves() const;
  // Of the rotation from one map to the next, the largest, in radians: from 0 to pi.
  double angle() const;
  // Equal steps into which [0, 1] falls so that chords between the maps at their ends serve for the motion: none turns
  // by more than 0.01 radians as long as 128 steps do for that. A chord stays closer to the arc than angle^2 / 8 of a
  // step times the distance from the axis: 1.3e-5, and 7.6e-5 for half a turn. 1 where nothing turns: exact then. Every
  // map that was stated stands at the end of a step; where there are more than 128 from map to map, there are no
  // others.
  int steps() const;

 private:
  Transform start_, end_;
  MotionKey key0_, key1_;
  std::array<double, 4> across_{};  // unit quaternion at right angles to the first, toward the second
  double half_angle_ = 0;           // between the quaternions
  std::vector<Motion> parts_;       // from map to map, where there are more than two
  std::vector<float> table_;        // the same for lanes: numbers of each part
};

}  // namespace montelux
