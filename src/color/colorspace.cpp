#include "color/colorspace.h"

namespace montelux {
namespace {

constexpr Chromaticity d65{0.3127, 0.3290};

constexpr ColorSpace spaces[] = {
    {"srgb", {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, d65},
    {"dci-p3", {0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65},
    {"rec2020", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65},
    {"aces2065-1", {0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}},
};

// Cone-like responses of the Bradford transform (Lam 1985).
constexpr Matrix3 bradford{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};

Matrix3 diagonal(double a, double b, double c) { return {{{a, 0, 0}, {0, b, 0}, {0, 0, c}}}; }

// The change of XYZ that an eye makes when it adapts from one white to another.
Matrix3 adaptation(const Chromaticity& from, const Chromaticity& to) {
  Xyz a = bradford * unit_luminance(from), b = bradford * unit_luminance(to);
  return inverse(bradford) * diagonal(b.x / a.x, b.y / a.y, b.z / a.z) * bradford;
}

}  // namespace

Chromaticity chromaticity(const Xyz& color) {
  double sum = color.x + color.y + color.z;
  return {color.x / sum, color.y / sum};
}

Xyz unit_luminance(const Chromaticity& c) { return {c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y}; }

Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  Matrix3 r{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) r.m[i][j] += a.m[i][k] * b.m[k][j];
  return r;
}

Matrix3 inverse(const Matrix3& a) {
  // Cofactors by cyclic indices, divided by the determinant.
  Matrix3 r{};
  double determinant = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      r.m[j][i] = a.m[i1][j1] * a.m[i2][j2] - a.m[i1][j2] * a.m[i2][j1];
      if (i == 0) determinant += a.m[i][j] * r.m[j][i];
    }
  for (auto& row : r.m)
    for (double& x : row) x /= determinant;
  return r;
}

Xyz operator*(const Matrix3& a, const Xyz& v) {
  double r[3];
  for (int i = 0; i < 3; ++i) r[i] = a.m[i][0] * v.x + a.m[i][1] * v.y + a.m[i][2] * v.z;
  return {r[0], r[1], r[2]};
}

Rgb operator*(const Matrix3& a, const Rgb& v) {
  Xyz r = a * Xyz{double(v.c[0]), double(v.c[1]), double(v.c[2])};
  return {float(r.x), float(r.y), float(r.z)};
}

std::optional<ColorSpace> color_space(std::string_view name) {
  for (const ColorSpace& space : spaces)
    if (space.name == name) return space;
  return std::nullopt;
}

std::vector<std::string_view> color_spaces() {
  std::vector<std::string_view> names;
  for (const ColorSpace& space : spaces) names.push_back(space.name);
  return names;
}

Matrix3 to_xyz(const ColorSpace& space) {
  Xyz r = unit_luminance(space.red), g = unit_luminance(space.green), b = unit_luminance(space.blue);
  Matrix3 primaries{{{r.x, g.x, b.x}, {r.y, g.y, b.y}, {r.z, g.z, b.z}}};
  // The amounts of the primaries that together make the white.
  Xyz amount = inverse(primaries) * unit_luminance(space.white);
  return primaries * diagonal(amount.x, amount.y, amount.z);
}

Matrix3 emission_to_srgb(const ColorSpace& space) { return inverse(to_xyz(spaces[0])) * to_xyz(space); }

Matrix3 reflectance_to_srgb(const ColorSpace& space) {
  return inverse(to_xyz(spaces[0])) * adaptation(space.white, d65) * to_xyz(space);
}

Rgb to_srgb(const Xyz& color) {
  Xyz r = inverse(to_xyz(spaces[0])) * color;
  return {float(r.x), float(r.y), float(r.z)};
}

Xyz to_xyz(const Rgb& color) {
  return to_xyz(spaces[0]) * Xyz{double(color.c[0]), double(color.c[1]), double(color.c[2])};
}

}  // namespace montelux
