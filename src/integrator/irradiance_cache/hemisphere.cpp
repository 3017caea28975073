#include "integrator/irradiance_cache/hemisphere.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace montelux {

namespace {

constexpr double pi_ = std::numbers::pi;

// A row of cells: the sines of its lower and upper angle from the normal, and the mean tangent over a cell, weighted by
// the projected solid angle.
struct Row {
  double sin_low, sin_high, tangent;
};

Row row_of(const HemisphereStrata& strata, int j) {
  // The integral of sin^2 over the angle, of which the tangent times the projected solid angle per azimuth consists.
  const auto below = [](double sine) {
    const double angle = std::asin(sine);
    return angle / 2 - std::sin(2 * angle) / 4;
  };
  const double m = strata.rows, low = std::sqrt(j / m), high = std::sqrt((j + 1) / m);
  return {low, high, 2 * m * (below(high) - below(low))};
}

// One over the distance of the nearer of two surfaces.
double closeness(const HemisphereSample& a, const HemisphereSample& b) {
  return 1 / double(std::min(a.distance, b.distance));
}

}  // namespace

HemisphereStrata HemisphereStrata::of(int samples) {
  const int rows = std::max(1, int(std::lround(std::sqrt(samples / pi_))));
  return {rows, std::max(3, int(std::lround(double(samples) / rows)))};
}

float harmonic_mean_distance(std::span<const float> distances) {
  double sum = 0;
  for (float distance : distances) sum += 1 / double(distance);
  return sum > 0 ? float(double(distances.size()) / sum) : std::numeric_limits<float>::infinity();
}

HemisphereEstimate integrate_hemisphere(const HemisphereStrata& strata, std::span<const HemisphereSample> samples,
                                        const LocalFrame<float>& frame) {
  const int rows = strata.rows, columns = strata.columns;
  const double cell = pi_ / strata.count();  // projected solid angle
  // Directions within a column are spread: their mean is shorter than a unit vector.
  const double half_width = pi_ / columns, shortening = std::sin(half_width) / half_width;
  std::vector<Row> all_rows;
  for (int j = 0; j < rows; ++j) all_rows.push_back(row_of(strata, j));
  const auto at = [&](int j, int k) -> const HemisphereSample& {
    return samples[std::size_t(j * columns + (k + columns) % columns)];
  };

  double irradiance[spectrum_size] = {}, closest = 0;
  double turning[spectrum_size][2] = {}, moving[spectrum_size][2] = {};  // by the axes s and t of the frame
  for (int k = 0; k < columns; ++k) {
    const double middle = 2 * pi_ * (k + 0.5) / columns, border = 2 * pi_ * k / columns;
    const double along[2] = {std::cos(middle), std::sin(middle)};    // toward the column
    const double across[2] = {-std::sin(border), std::cos(border)};  // a quarter turn from its first border
    for (int c = 0; c < spectrum_size; ++c) {
      double turned = 0, outward = 0, around = 0;
      for (int j = 0; j < rows; ++j) {
        const Row& row = all_rows[std::size_t(j)];
        const HemisphereSample& here = at(j, k);
        const double radiance = double(here.radiance[c]);
        irradiance[c] += cell * radiance;
        turned += cell * shortening * row.tangent * radiance;
        // The border with the row below moves toward the normal as the point moves toward the column.
        if (j > 0) {
          const double cos_squared = 1 - row.sin_low * row.sin_low;
          outward += 2 * pi_ / columns * row.sin_low * cos_squared * closeness(here, at(j - 1, k)) *
                     (radiance - double(at(j - 1, k).radiance[c]));
        }
        around += (row.sin_high - row.sin_low) * closeness(here, at(j, k - 1)) *
                  (radiance - double(at(j, k - 1).radiance[c]));
      }
      // The axis about which the normal turns toward the column.
      turning[c][0] -= along[1] * turned, turning[c][1] += along[0] * turned;
      for (int axis = 0; axis < 2; ++axis) moving[c][axis] += along[axis] * outward + across[axis] * around;
    }
    for (int j = 0; j < rows; ++j) closest += 1 / double(at(j, k).distance);
  }

  HemisphereEstimate estimate{};
  const auto in_plane = [&](const double(&a)[2]) { return frame.s * float(a[0]) + frame.t * float(a[1]); };
  for (int c = 0; c < spectrum_size; ++c) {
    estimate.irradiance[c] = float(irradiance[c]);
    estimate.gradients.rotational[std::size_t(c)] = in_plane(turning[c]);
    estimate.gradients.translational[std::size_t(c)] = in_plane(moving[c]);
  }
  estimate.distance = closest > 0 ? float(strata.count() / closest) : std::numeric_limits<float>::infinity();
  return estimate;
}

}  // namespace montelux
