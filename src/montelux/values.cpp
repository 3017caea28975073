#include "montelux/values.h"

#include <limits>

#include "math/transform.h"

namespace montelux::api {

namespace {

Transform from(const Matrix4& matrix) {
  Transform t;
  for (std::size_t i = 0; i < 16; ++i) t.m[i] = matrix.m[i / 4][i % 4];
  return t;
}

std::array<double, 3> array_of(Vec3 v) { return {double(v.x), double(v.y), double(v.z)}; }

}  // namespace

Transform operator*(const Transform& a, const Transform& b) {
  Transform product;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += a.m[4 * i + k] * b.m[4 * k + j];
      product.m[4 * i + j] = sum;
    }
  return product;
}

Transform translate(double x, double y, double z) { return {{1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1}}; }
Transform scale(double x, double y, double z) { return {{x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1}}; }
Transform rotate(double degrees, double x, double y, double z) {
  return from(montelux::rotate(degrees, x, y, z).matrix());
}

Transform look_at(Vec3 eye, Vec3 target, Vec3 up) {
  if (const auto world_to_camera = montelux::look_at(array_of(eye), array_of(target), array_of(up)))
    return from(world_to_camera->inverse_matrix());
  Transform none;
  none.m.fill(std::numeric_limits<double>::quiet_NaN());
  return none;
}

}  // namespace montelux::api
