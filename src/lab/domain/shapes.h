// The factors of a domain: each is a map from a unit cube onto a set, with its local stretch. In
// double precision throughout; the maps of `mc` are made for the float lanes of rendering.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lab/expression/expression.h"
#include "lab/integral/integrand.h"

namespace montelux::lab {

// The data of a factor. Its own coordinates of the cube start at `first`; its own variables are those from `column`
// on, of which only those marked in `needed` must be set. The measure is multiplied into `stretch`.
struct MapTask {
  PointBatch points;
  std::size_t first = 0, column = 0;
  std::span<const double*> columns;  // of the whole domain; those of earlier factors are set
  double* memory = nullptr;          // for new columns: points.count numbers each
  std::span<const char> needed;
  std::span<double> stretch;

  std::span<const double> u(std::size_t d) const { return points[first + d]; }
  // The destination of the values of an own variable; null if it is not needed.
  double* variable(std::size_t k) const { return needed[column + k] ? memory + (column + k) * points.count : nullptr; }
};

// One variable between bounds, each an expression of earlier variables, or infinite. Infinite intervals use
// x = t / (1 - t^2) with t in (-1, 1), or a +- u / (1 - u).
struct Side {
  std::string name;
  Expression low, high;
  bool from_minus_infinity = false, to_infinity = false;
  std::optional<std::pair<double, double>> fixed{};  // constant bounds, including infinite ones

  static constexpr std::size_t dimension() { return 1; }
  std::vector<std::string> names() const { return {name}; }
  std::optional<double> volume() const;
  void map(const MapTask& task) const;
  // The inverse of map at given variables: sets u.
  void invert(std::span<const double* const> columns, std::size_t own, std::span<double> u) const;
};

// The disk about the origin; measure: area. x, y, r, phi in [0, 2 pi).
struct Disk {
  double radius = 1;
  static constexpr std::size_t dimension() { return 2; }
  static std::vector<std::string> names() { return {"x", "y", "r", "phi"}; }
  std::optional<double> volume() const;
  void map(const MapTask& task) const;
};

// The ball about the origin; measure: volume. x, y, z, r.
struct Ball {
  double radius = 1;
  static constexpr std::size_t dimension() { return 3; }
  static std::vector<std::string> names() { return {"x", "y", "z", "r"}; }
  std::optional<double> volume() const;
  void map(const MapTask& task) const;
};

// A triangle of the plane (x, y) or of space (x, y, z); measure: area.
struct Triangle {
  std::array<std::array<double, 3>, 3> corners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  bool in_space = false;
  static constexpr std::size_t dimension() { return 2; }
  std::vector<std::string> names() const;
  std::optional<double> volume() const;
  void map(const MapTask& task) const;
};

// The surface of the ball, measure: area, which is solid angle for the radius 1. x, y, z, theta from +z in [0, pi],
// phi.
struct Sphere {
  double radius = 1;
  static constexpr std::size_t dimension() { return 2; }
  static std::vector<std::string> names() { return {"x", "y", "z", "theta", "phi"}; }
  std::optional<double> volume() const;
  void map(const MapTask& task) const;
};

// Directions with z >= 0; measure: solid angle, or solid angle times z where projected.
struct Hemisphere {
  bool projected = false;
  static constexpr std::size_t dimension() { return 2; }
  static std::vector<std::string> names() { return {"x", "y", "z", "theta", "phi"}; }
  std::optional<double> volume() const;
  void map(const MapTask& task) const;
};

// x_k >= 0 with sum up to 1; measure: volume. x, y, z up to three dimensions, else x1, x2, ...
struct Simplex {
  std::size_t dimensions = 2;
  std::size_t dimension() const { return dimensions; }
  std::vector<std::string> names() const;
  std::optional<double> volume() const;
  void map(const MapTask& task) const;
};

using DomainFactor = std::variant<Side, Disk, Ball, Triangle, Sphere, Hemisphere, Simplex>;

}  // namespace montelux::lab
