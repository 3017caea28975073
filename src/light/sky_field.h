// From which directions a light from infinity reaches each place, as a render has learned it.
#pragma once
#include <memory>

#include "light/direction_field.h"
#include "light/light_set.h"
#include "mc/piecewise.h"

namespace montelux {

template <class F>
struct SkySample {
  Vec3<F> wi;                      // unit, in world space
  Vec2<F> place;                   // of the direction, on the square map of the light's sphere
  Density<SolidAngle, F> density;  // of wi
};

// Divides the sphere of the light into the cells of a SkyDirections. A cell is chosen by what is known of the place,
// and a direction in it as the light does on its own, so the density is that of the light times a factor of the cell.
// Immutable.
class SkyField {
 public:
  static constexpr std::uint32_t cells = SkyDirections::cells;

  // `learned`: as SkyDirections takes them, with directions in the light's space.
  SkyField(const SkyLight& of, PlaceTree tree, const std::vector<SkyDirections::Table>& learned);

  LightId light() const { return light_; }

  // A direction at p; n as LightSet has it.
  template <class F>
  SkySample<F> sample(const Vec3<F>& p, const Vec3<F>& n, Vec2<F> u, Mask<F> on) const;
  // With which sample() draws the unit direction wi.
  template <class F>
  Density<SolidAngle, F> density(const Vec3<F>& p, const Vec3<F>& n, const Vec3<F>& wi, Mask<F> on) const;
  // For what learns: the direction wi of the world in the light's space, and the probability of such a direction's cell
  // at p.
  Vec3f in_light(const Vec3f& wi) const { return normalize(transform<float>().direction_to_light(wi)); }
  float cell_mass(const Vec3f& p, const Vec3f& n, const Vec3f& in_light) const;

 private:
  template <class F>
  LightTransforms<F> transform() const {
    return {transform_.v, Uint<F>(0u)};
  }

  LightId light_;
  LightTransform transform_;
  PiecewiseTiles tiles_;  // one for each cell
  SkyDirections field_;
  std::vector<float> inverse_masses_;  // of the cells in the light's own density, over 4 pi / cells; 0: of no mass
};

}  // namespace montelux
