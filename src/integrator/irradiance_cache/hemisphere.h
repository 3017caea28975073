// Irradiance and its gradients by stratified directions of the hemisphere (Ward and Heckbert 1992, "Irradiance
// Gradients").
#pragma once
#include <array>
#include <span>

#include "color/spectrum.h"
#include "math/functions.h"
#include "math/vec.h"
#include "mc/hemisphere.h"

namespace montelux {

// Cells of equal projected solid angle: rows by the angle from the normal, columns by the azimuth. Cell j, k has the
// number j * columns + k.
struct HemisphereStrata {
  int rows = 1, columns = 3;
  // About so many cells, as wide as high: columns = pi rows.
  static HemisphereStrata of(int samples);
  int count() const { return rows * columns; }
  // A direction of the cell at that row and column (local), distributed by the cosine.
  template <class F>
  Vec3<F> direction(F row, F column, Vec2<F> u) const {
    const F sin_squared = (row + u.x) * (1 / float(rows));
    return direction_at(safe_sqrt(F(1.0f) - sin_squared), (column + u.y) * (1 / float(columns)));
  }
};

// What one direction shows: the radiance, and the distance of the surface that sends it; infinite where there is none.
struct HemisphereSample {
  Spectrum<float> radiance;
  float distance;
};

// By component. `rotational`: the derivative of irradiance as the normal n turns to n' is (n x n') . rotational;
// `translational`: as the point moves by d within the tangent plane, d . translational.
struct IrradianceGradients {
  std::array<Vec3f, spectrum_size> rotational{}, translational{};
};

struct HemisphereEstimate {
  Spectrum<float> irradiance;
  IrradianceGradients gradients;
  float distance;  // harmonic mean of those of the samples; infinite where there is nothing around
};

// `samples`: one for each cell of the strata. Radiance counts as constant within a cell; the boundary between two cells
// moves with the nearer of their surfaces as the point moves.
HemisphereEstimate integrate_hemisphere(const HemisphereStrata& strata, std::span<const HemisphereSample> samples,
                                        const LocalFrame<float>& frame);
// The harmonic mean alone.
float harmonic_mean_distance(std::span<const float> distances);

}  // namespace montelux
