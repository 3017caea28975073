// Affine and projective maps of space, with their inverses. Built in double, applied in float.
#pragma once
#include <array>
#include <optional>

#include "math/vec.h"

namespace montelux {

// A 4 x 4 matrix in row-major order that acts on column vectors.
struct Matrix4 {
  std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  bool operator==(const Matrix4&) const = default;
};

Matrix4 operator*(const Matrix4& a, const Matrix4& b);
Matrix4 transpose(const Matrix4& a);
double determinant(const Matrix4& a);
// No value where the matrix is singular or not finite.
std::optional<Matrix4> inverse(const Matrix4& a);

// A map and its inverse. Points, directions and normals have different transformation rules.
class Transform {
 public:
  Transform() = default;
  Transform(const Matrix4& matrix, const Matrix4& inverse);

  const Matrix4& matrix() const { return matrix_; }
  const Matrix4& inverse_matrix() const { return inverse_; }
  Transform inverted() const { return Transform(inverse_, matrix_); }
  bool swaps_handedness() const;
  bool is_identity() const { return matrix_ == Matrix4{}; }

  // Affine part only.
  template <class F>
  MONTELUX_INLINE Vec3<F> point(Vec3<F> p) const {
    return {a_[0] * p.x + a_[1] * p.y + a_[2] * p.z + a_[3], a_[4] * p.x + a_[5] * p.y + a_[6] * p.z + a_[7],
            a_[8] * p.x + a_[9] * p.y + a_[10] * p.z + a_[11]};
  }
  template <class F>
  MONTELUX_INLINE Vec3<F> direction(Vec3<F> d) const {
    return {a_[0] * d.x + a_[1] * d.y + a_[2] * d.z, a_[4] * d.x + a_[5] * d.y + a_[6] * d.z,
            a_[8] * d.x + a_[9] * d.y + a_[10] * d.z};
  }
  // By the inverse transpose; not normalised.
  template <class F>
  MONTELUX_INLINE Vec3<F> normal(Vec3<F> n) const {
    return {i_[0] * n.x + i_[4] * n.y + i_[8] * n.z, i_[1] * n.x + i_[5] * n.y + i_[9] * n.z,
            i_[2] * n.x + i_[6] * n.y + i_[10] * n.z};
  }
  // With the projective row: divides by w.
  Vec3f project(Vec3f p) const;
  // The upper 3 x 4 block in row-major order, the form in which the ray-tracing kernel takes an instance.
  const std::array<float, 12>& rows() const { return a_; }
  const std::array<float, 12>& inverse_rows() const { return i_; }

 private:
  Matrix4 matrix_, inverse_;
  std::array<float, 12> a_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  std::array<float, 12> i_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

// a * b: first b, then a.
Transform operator*(const Transform& a, const Transform& b);
Transform translate(double x, double y, double z);
Transform scale(double x, double y, double z);
// Right-handed by the right-hand rule about the axis; degrees. The axis must not be zero.
Transform rotate(double degrees, double x, double y, double z);
// World to camera, camera at eye, looking along +z, y up, x to the right in a left-handed world (pbrt's convention).
// No value where eye and target coincide or up is parallel to the view.
std::optional<Transform> look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target,
                                 const std::array<double, 3>& up);
// Invertible matrices only: no value otherwise.
std::optional<Transform> from_matrix(const Matrix4& m);

}  // namespace montelux
