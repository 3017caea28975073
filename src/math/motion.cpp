#include "math/motion.h"

#include <algorithm>
#include <cmath>

namespace montelux {

namespace {

using Row9 = std::array<double, 9>;
using Quaternion = std::array<double, 4>;

double dot4(const Quaternion& a, const Quaternion& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }
Quaternion scaled(const Quaternion& q, double s) { return {q[0] * s, q[1] * s, q[2] * s, q[3] * s}; }
Quaternion sum(const Quaternion& a, const Quaternion& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}

Matrix4 linear_part(const Matrix4& a) {
  Matrix4 r = a;
  for (std::size_t i = 0; i < 3; ++i) r.m[i][3] = r.m[3][i] = 0;
  r.m[3][3] = 1;
  return r;
}

// The orthogonal matrix nearest to a: Newton's iteration, the mean with the inverse transpose (Higham 1986).
Matrix4 orthogonal_part(Matrix4 a) {
  for (int i = 0; i < 100; ++i) {
    const std::optional<Matrix4> inverted = inverse(a);
    if (!inverted) break;
    double change = 0;
    Matrix4 next;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) {
        next.m[r][c] = 0.5 * (a.m[r][c] + inverted->m[c][r]);
        change = std::max(change, std::abs(next.m[r][c] - a.m[r][c]));
      }
    a = next;
    if (change < 1e-15) break;
  }
  return a;
}

// Finds the largest component first, so that it never divides by a small number (Shepperd 1978).
Quaternion quaternion_of(const Matrix4& r) {
  const auto& m = r.m;
  const double trace = m[0][0] + m[1][1] + m[2][2];
  Quaternion q;
  if (trace > 0) {
    const double s = std::sqrt(trace + 1) * 2;
    q = {(m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4};
  } else {
    std::size_t i = 0;
    if (m[1][1] > m[0][0]) i = 1;
    if (m[2][2] > m[i][i]) i = 2;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = std::sqrt(std::max(m[i][i] - m[j][j] - m[k][k] + 1, 0.0)) * 2;
    q[i] = s / 4;
    q[j] = (m[j][i] + m[i][j]) / s;
    q[k] = (m[k][i] + m[i][k]) / s;
    q[3] = (m[k][j] - m[j][k]) / s;
  }
  return scaled(q, 1 / std::sqrt(dot4(q, q)));
}

// The rows (of four numbers) of T R S.
template <class F>
std::array<F, 12> composed(const std::array<F, 3>& t, const std::array<F, 4>& q, const std::array<F, 9>& s) {
  const F x = q[0], y = q[1], z = q[2], w = q[3], two = F(2), one = F(1);
  const std::array<F, 9> r{one - two * (y * y + z * z), two * (x * y - z * w),       two * (x * z + y * w),
                           two * (x * y + z * w),       one - two * (x * x + z * z), two * (y * z - x * w),
                           two * (x * z - y * w),       two * (y * z + x * w),       one - two * (x * x + y * y)};
  std::array<F, 12> m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      m[4 * i + j] = r[3 * i] * s[j] + r[3 * i + 1] * s[3 + j] + r[3 * i + 2] * s[6 + j];
    m[4 * i + 3] = t[i];
  }
  return m;
}

template <class F, std::size_t n>
std::array<F, n> mixed(F t, const std::array<double, n>& a, const std::array<double, n>& b) {
  std::array<F, n> r;
  for (std::size_t i = 0; i < n; ++i) {
    if constexpr (std::is_same_v<F, double>)
      r[i] = a[i] * (1 - t) + b[i] * t;
    else
      r[i] = F(float(a[i])) * (F(1.0f) - t) + F(float(b[i])) * t;
  }
  return r;
}

}  // namespace

MotionKey decompose(const Transform& transform) {
  const Matrix4& m = transform.matrix();
  MotionKey key;
  for (std::size_t i = 0; i < 3; ++i) key.translation[i] = m.m[i][3];
  const Matrix4 linear = linear_part(m);
  Matrix4 r = orthogonal_part(linear);
  if (determinant(r) < 0)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) r.m[i][j] = -r.m[i][j];
  key.rotation = quaternion_of(r);
  const Matrix4 s = transpose(r) * linear;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) key.stretch[3 * i + j] = 0.5 * (s.m[i][j] + s.m[j][i]);
  return key;
}

Motion::Motion(const Transform& start, const Transform& end)
    : start_(start), end_(end), key0_(decompose(start)), key1_(decompose(end)) {
  if (dot4(key0_.rotation, key1_.rotation) < 0) key1_.rotation = scaled(key1_.rotation, -1);
  const Quaternion difference = sum(key1_.rotation, scaled(key0_.rotation, -dot4(key0_.rotation, key1_.rotation)));
  const double sine = std::sqrt(dot4(difference, difference));
  half_angle_ = std::atan2(sine, dot4(key0_.rotation, key1_.rotation));
  // A remainder of the size of rounding errors is no rotation.
  if (sine > 1e-9)
    across_ = scaled(difference, 1 / sine);
  else
    half_angle_ = 0;
}

// The components of each part that lanes gather, and their offsets.
namespace part {
constexpr std::uint32_t translation = 0, rotation = 6, across = 10, half_angle = 14, stretch = 15, size = 33;
}

Motion::Motion(const Transform& start, const std::vector<Transform>& later)
    : Motion(start, later.empty() ? start : later.front()) {
  if (later.size() < 2) return;
  parts_.push_back(*this);
  for (std::size_t i = 1; i < later.size(); ++i) parts_.emplace_back(later[i - 1], later[i]);
  for (const Motion& p : parts_) {
    const auto put = [&](const auto& numbers) {
      for (double x : numbers) table_.push_back(float(x));
    };
    put(p.key0_.translation), put(p.key1_.translation);
    put(p.key0_.rotation), put(p.across_);
    table_.push_back(float(p.half_angle_));
    put(p.key0_.stretch), put(p.key1_.stretch);
  }
}

bool Motion::moves() const {
  if (parts_.empty()) return !(start_.matrix() == end_.matrix());
  return std::any_of(parts_.begin(), parts_.end(), [](const Motion& p) { return p.moves(); });
}

double Motion::angle() const {
  double largest = 2 * half_angle_;
  for (const Motion& p : parts_) largest = std::max(largest, p.angle());
  return largest;
}

Transform Motion::at(double t) const {
  if (!parts_.empty()) {
    const double scaled = std::clamp(t, 0.0, 1.0) * double(parts_.size());
    const std::size_t i = std::min(std::size_t(scaled), parts_.size() - 1);
    return parts_[i].at(scaled - double(i));
  }
  if (!(t > 0) || !moves()) return start_;
  if (t >= 1) return end_;
  const Quaternion q =
      sum(scaled(key0_.rotation, std::cos(t * half_angle_)), scaled(across_, std::sin(t * half_angle_)));
  const std::array<double, 12> rows =
      composed(mixed(t, key0_.translation, key1_.translation), q, mixed(t, key0_.stretch, key1_.stretch));
  Matrix4 m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) m.m[i][j] = rows[4 * i + j];
  // Between a stretch that mirrors and one that does not, some interpolated stretch has no inverse.
  return from_matrix(m).value_or(t < 0.5 ? start_ : end_);
}

template <class F>
Affine<F> Motion::at(F t) const {
  if (!parts_.empty()) {
    const F scaled = t * float(parts_.size());
    const F first = clamp(floor(scaled), 0.0f, float(parts_.size() - 1)), u = scaled - first;
    const Uint<F> at = to_uint(first) * Uint<F>(part::size);
    const auto number = [&](std::uint32_t i) -> F { return gather(table_.data() + i, at); };
    const auto between = [&](std::uint32_t i, std::uint32_t count) -> F {
      return number(i) * (F(1.0f) - u) + number(i + count) * u;
    };
    const SinCos<F> turn = sin_cos(u * number(part::half_angle));
    std::array<F, 4> q;
    for (std::uint32_t i = 0; i < 4; ++i)
      q[i] = turn.cos * number(part::rotation + i) + turn.sin * number(part::across + i);
    std::array<F, 3> shift;
    for (std::uint32_t i = 0; i < 3; ++i) shift[i] = between(part::translation + i, 3);
    std::array<F, 9> stretch;
    for (std::uint32_t i = 0; i < 9; ++i) stretch[i] = between(part::stretch + i, 9);
    const std::array<F, 12> rows = composed(shift, q, stretch);
    Affine<F> r;
    for (std::size_t i = 0; i < 12; ++i) r.m[i] = rows[i];
    return r;
  }
  const SinCos<F> turn = sin_cos(t * float(half_angle_));
  std::array<F, 4> q;
  for (std::size_t i = 0; i < 4; ++i) q[i] = turn.cos * float(key0_.rotation[i]) + turn.sin * float(across_[i]);
  const std::array<F, 12> rows =
      composed(mixed(t, key0_.translation, key1_.translation), q, mixed(t, key0_.stretch, key1_.stretch));
  Affine<F> r;
  for (std::size_t i = 0; i < 12; ++i) r.m[i] = rows[i];
  return r;
}

int Motion::steps() const {
  const int parts = std::max(int(parts_.size()), 1);
  return parts * std::clamp(int(std::ceil(angle() / 0.01)), 1, std::max(128 / parts, 1));
}

template Affine<float> Motion::at(float) const;
template Affine<NativeFloats> Motion::at(NativeFloats) const;

}  // namespace montelux
