#include "io/gltf/deform.h"

#include <cmath>

namespace montelux::gltf {

namespace {

void add_scaled(Matrix4& sum, const Matrix4& m, double weight) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) sum.m[i][j] += weight * m.m[i][j];
}

Vec3f moved_point(const Matrix4& m, Vec3f p) {
  const auto row = [&](std::size_t i) {
    return float(m.m[i][0] * double(p.x) + m.m[i][1] * double(p.y) + m.m[i][2] * double(p.z) + m.m[i][3]);
  };
  return {row(0), row(1), row(2)};
}

// Uses the cofactors, which are the inverse transpose up to a factor.
Vec3f moved_normal(const Matrix4& m, Vec3f n) {
  const auto& a = m.m;
  const auto cofactor = [&](std::size_t i, std::size_t j) {
    const std::size_t r = (i + 1) % 3, s = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return a[r][c] * a[s][d] - a[r][d] * a[s][c];
  };
  const double determinant = a[0][0] * cofactor(0, 0) + a[0][1] * cofactor(0, 1) + a[0][2] * cofactor(0, 2);
  const double sign = determinant < 0 ? -1 : 1;
  double v[3], squared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    v[i] = sign * (cofactor(i, 0) * double(n.x) + cofactor(i, 1) * double(n.y) + cofactor(i, 2) * double(n.z));
    squared += v[i] * v[i];
  }
  const double scale = squared > 0 ? 1 / std::sqrt(squared) : 0;
  return {float(v[0] * scale), float(v[1] * scale), float(v[2] * scale)};
}

}  // namespace

std::optional<Skin> read_skin(Document& document, std::size_t number) {
  const Element element = document.list("skins")[number], joints = element.required("joints");
  Skin skin;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto joint = joints[i].index_of(document.list("nodes"), "a node");
    if (!joint) return std::nullopt;
    skin.joints.push_back(*joint);
  }
  skin.to_joint.resize(skin.joints.size());
  const Element matrices = element["inverseBindMatrices"];
  if (!matrices) return skin;
  const auto numbers = read_accessor(document, matrices, {{"MAT4"}});
  if (!numbers) return std::nullopt;
  if (numbers->count < skin.joints.size()) {
    matrices.error("has " + std::to_string(numbers->count) + " matrices for " + std::to_string(skin.joints.size()) +
                   " joints");
    return std::nullopt;
  }
  for (std::size_t k = 0; k < skin.joints.size(); ++k)
    for (std::size_t i = 0; i < 16; ++i) skin.to_joint[k].m[i % 4][i / 4] = double(numbers->at(k)[i]);
  return skin;
}

MeshPose pose_of(const Primitive& primitive, const Deformation& deformation) {
  MeshPose pose{primitive.mesh->positions, primitive.mesh->normals};
  for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
    const float weight = t < deformation.weights.size() ? float(deformation.weights[t]) : 0.0f;
    const MorphTarget& target = primitive.targets[t];
    if (weight == 0) continue;
    for (std::size_t i = 0; i < target.positions.size(); ++i) pose.positions[i] += target.positions[i] * weight;
    if (!pose.normals.empty())
      for (std::size_t i = 0; i < target.normals.size(); ++i) pose.normals[i] += target.normals[i] * weight;
  }
  std::vector<Matrix4> joints;
  if (deformation.skin)
    for (std::size_t k = 0; k < deformation.skin->joints.size(); ++k)
      joints.push_back(deformation.world[deformation.skin->joints[k]] * deformation.skin->to_joint[k]);
  for (std::size_t i = 0; i < pose.positions.size(); ++i) {
    Matrix4 m = deformation.placed;
    if (deformation.skin) {
      m.m = {};
      for (std::size_t k = 0; k < 4; ++k)
        if (const float weight = primitive.skin->weights[i][k]; weight > 0)
          add_scaled(m, joints[primitive.skin->joints[i][k]], double(weight));
    }
    pose.positions[i] = moved_point(m, pose.positions[i]);
    if (!pose.normals.empty()) pose.normals[i] = moved_normal(m, pose.normals[i]);
  }
  return pose;
}

}  // namespace montelux::gltf
