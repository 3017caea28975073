// Maps that move: from one to another by a translation, a rotation and a stretch, each at constant speed.
#pragma once
#include <array>
#include <vector>

#include "math/affine.h"
#include "math/transform.h"

namespace montelux {

// An affine map decomposed into first the stretch S (symmetric), then the rotation R (as a unit quaternion), then the
// translation T: M = T R S, by polar decomposition (Shoemake and Duff 1992). A map that mirrors has det S < 0.
struct MotionKey {
  std::array<double, 3> translation{};
  std::array<double, 4> rotation{0, 0, 0, 1};  // x, y, z, w
  std::array<double, 9> stretch{1, 0, 0, 0, 1, 0, 0, 0, 1};
};
MotionKey decompose(const Transform& transform);

// Interpolates from one map to another over t in [0, 1]: translation and stretch linearly, the rotation along the
// shorter arc at constant angular speed (Shoemake 1985), as in pbrt-v4. Evenly spaced intermediate maps, if any,
// are interpolated piece by piece in the same way.
class Motion {
 public:
  Motion() = default;
  Motion(const Transform& start, const Transform& end);
  Motion(const Transform& start, const std::vector<Transform>& later);

  // t outside [0, 1] is clamped; at the ends and at intermediate maps the result is the map that was given.
  Transform at(double t) const;
  // The same in every lane; t must lie in [0, 1].
  template <class F>
  Affine<F> at(F t) const;
  bool moves() const;
  // The largest rotation angle from one map to the next, in radians: from 0 to pi.
  double angle() const;
  // The number of equal steps of [0, 1] within which linear interpolation of the maps at the ends approximates the
  // motion: no step turns by more than 0.01 radians, as far as 128 steps suffice. The chord deviates from the arc by
  // less than angle^2 / 8 of a step times the distance from the axis: 1.3e-5, or 7.6e-5 for half a turn. 1 where
  // nothing turns: exact then. Every given map is at the end of a step; if one step per pair of maps already exceeds
  // 128, there are no further steps.
  int steps() const;

 private:
  Transform start_, end_;
  MotionKey key0_, key1_;
  std::array<double, 4> across_{};  // unit quaternion orthogonal to the first, towards the second
  double half_angle_ = 0;           // between the quaternions
  std::vector<Motion> parts_;       // between consecutive maps, if there are more than two
  std::vector<float> table_;        // the same for lanes: the numbers of each part
};

}  // namespace montelux
