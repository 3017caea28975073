#include "lab/domain/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace montelux::lab {
namespace {

using std::numbers::pi;

void scale(std::span<double> stretch, double factor) {
  for (double& s : stretch) s *= factor;
}

// Coordinates of the cube are in [0, 1); avoids the ends that represent infinity.
double inside(double u) { return std::clamp(u, 0x1p-54, 1 - 0x1p-53); }

// A point at a height and an azimuth on the sphere of that radius; sets the needed variables.
struct Direction {
  double *x, *y, *z, *theta, *phi;
  explicit Direction(const MapTask& t)
      : x(t.variable(0)), y(t.variable(1)), z(t.variable(2)), theta(t.variable(3)), phi(t.variable(4)) {}

  // `below` is 1 - cos theta, which keeps directions near the pole exact.
  void set(std::size_t i, double below, double turn, double radius) const {
    const double azimuth = 2 * pi * turn, height = 1 - below;
    const double across = std::sqrt(std::max(0.0, below * (2 - below)));
    if (x) x[i] = radius * across * std::cos(azimuth);
    if (y) y[i] = radius * across * std::sin(azimuth);
    if (z) z[i] = radius * height;
    if (theta) theta[i] = std::atan2(across, height);
    if (phi) phi[i] = azimuth;
  }
};

// The share of the remainder for the next of m coordinates, uniform over the simplex: 1 - (1 - u)^(1/m).
double share_of_rest(double u, std::size_t m) {
  if (m == 1) return u;
  if (m == 2) return 1 - std::sqrt(1 - u);
  return -std::expm1(std::log1p(-u) / double(m));
}

}  // namespace

std::optional<double> Side::volume() const {
  if (!fixed || from_minus_infinity || to_infinity) return std::nullopt;
  return fixed->second - fixed->first;
}

void Side::map(const MapTask& task) const {
  const std::span<const double> u = task.u(0);
  const std::size_t n = u.size();
  double* x = task.memory + task.column * n;
  if (fixed && !from_minus_infinity && !to_infinity) {
    const double from = fixed->first, length = fixed->second - fixed->first;
    if (from == 0 && length == 1) {
      task.columns[task.column] = u.data();
      return;
    }
    if (task.needed[task.column])
      for (std::size_t i = 0; i < n; ++i) x[i] = from + u[i] * length;
    return scale(task.stretch, length);
  }
  const auto set = [&](auto one) {
    for (std::size_t i = 0; i < n; ++i) task.stretch[i] *= one(i);
  };
  if (from_minus_infinity && to_infinity) {
    set([&](std::size_t i) {
      const double v = inside(u[i]), t = 2 * v - 1, rest = 4 * v * (1 - v);  // 1 - t^2
      x[i] = t / rest;
      return 2 * (1 + t * t) / (rest * rest);
    });
    return;
  }
  std::vector<double> a(n), b(n);
  const std::span<const double* const> known = task.columns;
  if (!from_minus_infinity) low.evaluate(known, a);
  if (!to_infinity) high.evaluate(known, b);
  set([&](std::size_t i) {
    if (to_infinity) {
      const double rest = 1 - inside(u[i]);
      x[i] = a[i] + u[i] / rest;
      return 1 / (rest * rest);
    }
    if (from_minus_infinity) {
      const double v = inside(u[i]);
      x[i] = b[i] - (1 - v) / v;
      return 1 / (v * v);
    }
    x[i] = a[i] + u[i] * (b[i] - a[i]);
    return b[i] - a[i];
  });
}

void Side::invert(std::span<const double* const> columns, std::size_t own, std::span<double> u) const {
  const double* x = columns[own];
  const std::size_t n = u.size();
  std::vector<double> a(n), b(n);
  if (!from_minus_infinity) low.evaluate(columns, a);
  if (!to_infinity) high.evaluate(columns, b);
  for (std::size_t i = 0; i < n; ++i) {
    if (from_minus_infinity && to_infinity)  // t / (1 - t^2) = x, free of cancellation
      u[i] = 0.5 + x[i] / (1 + std::sqrt(1 + 4 * x[i] * x[i]));
    else if (to_infinity)
      u[i] = (x[i] - a[i]) / (1 + x[i] - a[i]);
    else if (from_minus_infinity)
      u[i] = 1 / (1 + b[i] - x[i]);
    else
      u[i] = (x[i] - a[i]) / (b[i] - a[i]);
  }
}

std::optional<double> Disk::volume() const { return pi * radius * radius; }

void Disk::map(const MapTask& task) const {
  const auto u = task.u(0), v = task.u(1);
  double *x = task.variable(0), *y = task.variable(1), *r = task.variable(2), *phi = task.variable(3);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double distance = radius * std::sqrt(u[i]), azimuth = 2 * pi * v[i];
    if (x) x[i] = distance * std::cos(azimuth);
    if (y) y[i] = distance * std::sin(azimuth);
    if (r) r[i] = distance;
    if (phi) phi[i] = azimuth;
  }
  scale(task.stretch, *volume());
}

std::optional<double> Ball::volume() const { return 4.0 / 3 * pi * radius * radius * radius; }

void Ball::map(const MapTask& task) const {
  const auto u = task.u(0), v = task.u(1), w = task.u(2);
  double *x = task.variable(0), *y = task.variable(1), *z = task.variable(2), *r = task.variable(3);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double distance = radius * std::cbrt(u[i]), height = 1 - 2 * v[i], azimuth = 2 * pi * w[i];
    const double across = distance * std::sqrt(4 * v[i] * (1 - v[i]));
    if (x) x[i] = across * std::cos(azimuth);
    if (y) y[i] = across * std::sin(azimuth);
    if (z) z[i] = distance * height;
    if (r) r[i] = distance;
  }
  scale(task.stretch, *volume());
}

std::vector<std::string> Triangle::names() const {
  return in_space ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{"x", "y"};
}

std::optional<double> Triangle::volume() const {
  const auto& [p, q, r] = corners;
  std::array<double, 3> cross{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    cross[k] = (q[a] - p[a]) * (r[b] - p[b]) - (q[b] - p[b]) * (r[a] - p[a]);
  }
  return 0.5 * std::hypot(cross[0], cross[1], cross[2]);
}

void Triangle::map(const MapTask& task) const {
  const auto u = task.u(0), v = task.u(1);
  for (std::size_t k = 0; k < (in_space ? 3u : 2u); ++k)
    if (double* x = task.variable(k))
      for (std::size_t i = 0; i < u.size(); ++i) {
        const double second = share_of_rest(u[i], 2), third = (1 - second) * v[i];
        x[i] = (1 - second - third) * corners[0][k] + second * corners[1][k] + third * corners[2][k];
      }
  scale(task.stretch, *volume());
}

std::optional<double> Sphere::volume() const { return 4 * pi * radius * radius; }

void Sphere::map(const MapTask& task) const {
  const auto u = task.u(0), v = task.u(1);
  const Direction direction(task);
  for (std::size_t i = 0; i < u.size(); ++i) direction.set(i, 2 * u[i], v[i], radius);
  scale(task.stretch, *volume());
}

std::optional<double> Hemisphere::volume() const { return projected ? pi : 2 * pi; }

void Hemisphere::map(const MapTask& task) const {
  const auto u = task.u(0), v = task.u(1);
  const Direction direction(task);
  // Uniform in the measure: heights for solid angle, squared radii in the plane for projected solid angle.
  for (std::size_t i = 0; i < u.size(); ++i)
    direction.set(i, projected ? u[i] / (1 + std::sqrt(1 - u[i])) : u[i], v[i], 1);
  scale(task.stretch, *volume());
}

std::vector<std::string> Simplex::names() const {
  if (dimensions <= 3) {
    const std::vector<std::string> all{"x", "y", "z"};
    return {all.begin(), all.begin() + std::ptrdiff_t(dimensions)};
  }
  std::vector<std::string> names;
  for (std::size_t k = 1; k <= dimensions; ++k) names.push_back(std::string("x").append(std::to_string(k)));
  return names;
}

std::optional<double> Simplex::volume() const { return 1 / std::tgamma(double(dimensions) + 1); }

void Simplex::map(const MapTask& task) const {
  const std::size_t n = task.points.count;
  std::vector<double> rest(n, 1.0);
  for (std::size_t k = 0; k < dimensions; ++k) {
    const auto u = task.u(k);
    double* x = task.variable(k);
    for (std::size_t i = 0; i < n; ++i) {
      const double taken = rest[i] * share_of_rest(u[i], dimensions - k);
      if (x) x[i] = taken;
      rest[i] -= taken;
    }
  }
  scale(task.stretch, *volume());
}

}  // namespace montelux::lab
