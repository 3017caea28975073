#include "math/transform.h"

#include <cmath>
#include <numbers>

namespace montelux {

namespace {

using Row3 = std::array<double, 3>;

double dot3(const Row3& a, const Row3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Row3 cross3(const Row3& a, const Row3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// No value for a vector of length zero.
std::optional<Row3> unit3(const Row3& a) {
  double length = std::sqrt(dot3(a, a));
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return Row3{a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace

Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
  Matrix4 r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      r.m[i][j] = 0;
      for (int k = 0; k < 4; ++k) r.m[i][j] += a.m[i][k] * b.m[k][j];
    }
  return r;
}

Matrix4 transpose(const Matrix4& a) {
  Matrix4 r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) r.m[i][j] = a.m[j][i];
  return r;
}

double determinant(const Matrix4& a) {
  auto minor2 = [&](int r0, int r1, int c0, int c1) { return a.m[r0][c0] * a.m[r1][c1] - a.m[r0][c1] * a.m[r1][c0]; };
  return minor2(0, 1, 0, 1) * minor2(2, 3, 2, 3) - minor2(0, 1, 0, 2) * minor2(2, 3, 1, 3) +
         minor2(0, 1, 0, 3) * minor2(2, 3, 1, 2) + minor2(0, 1, 1, 2) * minor2(2, 3, 0, 3) -
         minor2(0, 1, 1, 3) * minor2(2, 3, 0, 2) + minor2(0, 1, 2, 3) * minor2(2, 3, 0, 1);
}

std::optional<Matrix4> inverse(const Matrix4& a) {
  // Gauss-Jordan elimination with partial pivoting.
  Matrix4 left = a, right;
  for (int column = 0; column < 4; ++column) {
    int pivot = column;
    for (int row = column + 1; row < 4; ++row)
      if (std::abs(left.m[row][column]) > std::abs(left.m[pivot][column])) pivot = row;
    double p = left.m[pivot][column];
    if (!std::isfinite(p) || p == 0) return std::nullopt;
    std::swap(left.m[pivot], left.m[column]);
    std::swap(right.m[pivot], right.m[column]);
    for (int j = 0; j < 4; ++j) left.m[column][j] /= p, right.m[column][j] /= p;
    for (int row = 0; row < 4; ++row) {
      if (row == column) continue;
      double f = left.m[row][column];
      for (int j = 0; j < 4; ++j) {
        left.m[row][j] -= f * left.m[column][j];
        right.m[row][j] -= f * right.m[column][j];
      }
    }
  }
  for (const auto& row : right.m)
    for (double x : row)
      if (!std::isfinite(x)) return std::nullopt;
  return right;
}

Transform::Transform(const Matrix4& matrix, const Matrix4& inverse) : matrix_(matrix), inverse_(inverse) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      a_[4 * i + j] = float(matrix.m[i][j]);
      i_[4 * i + j] = float(inverse.m[i][j]);
    }
}

bool Transform::swaps_handedness() const {
  const auto& m = matrix_.m;
  double d = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return d < 0;
}

Vec3f Transform::project(Vec3f p) const {
  std::array<double, 4> r{};
  for (int i = 0; i < 4; ++i)
    r[i] = matrix_.m[i][0] * p.x + matrix_.m[i][1] * p.y + matrix_.m[i][2] * p.z + matrix_.m[i][3];
  return {float(r[0] / r[3]), float(r[1] / r[3]), float(r[2] / r[3])};
}

Transform operator*(const Transform& a, const Transform& b) {
  return Transform(a.matrix() * b.matrix(), b.inverse_matrix() * a.inverse_matrix());
}

Transform translate(double x, double y, double z) {
  Matrix4 m, i;
  m.m[0][3] = x, m.m[1][3] = y, m.m[2][3] = z;
  i.m[0][3] = -x, i.m[1][3] = -y, i.m[2][3] = -z;
  return Transform(m, i);
}

Transform scale(double x, double y, double z) {
  Matrix4 m, i;
  m.m[0][0] = x, m.m[1][1] = y, m.m[2][2] = z;
  i.m[0][0] = 1 / x, i.m[1][1] = 1 / y, i.m[2][2] = 1 / z;
  return Transform(m, i);
}

Transform rotate(double degrees, double x, double y, double z) {
  Row3 a = unit3({x, y, z}).value_or(Row3{0, 0, 1});
  double angle = degrees * std::numbers::pi / 180, s = std::sin(angle), c = std::cos(angle);
  Matrix4 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m.m[i][j] = a[i] * a[j] * (1 - c) + (i == j ? c : 0);
  m.m[0][1] -= a[2] * s, m.m[0][2] += a[1] * s;
  m.m[1][0] += a[2] * s, m.m[1][2] -= a[0] * s;
  m.m[2][0] -= a[1] * s, m.m[2][1] += a[0] * s;
  return Transform(m, transpose(m));
}

std::optional<Transform> look_at(const Row3& eye, const Row3& target, const Row3& up) {
  auto forward = unit3({target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]});
  auto unit_up = unit3(up);
  if (!forward || !unit_up) return std::nullopt;
  Row3 side = cross3(*unit_up, *forward);
  if (dot3(side, side) < 1e-24) return std::nullopt;
  Row3 right = *unit3(side), true_up = cross3(*forward, right);
  Matrix4 camera_to_world;
  for (int i = 0; i < 3; ++i) {
    camera_to_world.m[i][0] = right[i];
    camera_to_world.m[i][1] = true_up[i];
    camera_to_world.m[i][2] = (*forward)[i];
    camera_to_world.m[i][3] = eye[i];
  }
  auto world_to_camera = inverse(camera_to_world);
  if (!world_to_camera) return std::nullopt;
  return Transform(*world_to_camera, camera_to_world);
}

std::optional<Transform> from_matrix(const Matrix4& m) {
  auto i = inverse(m);
  if (!i) return std::nullopt;
  return Transform(m, *i);
}

}  // namespace montelux
