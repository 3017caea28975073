#include "texture/mapping.h"

#include <algorithm>

namespace montelux {

namespace {

// In [0, 1).
float azimuth_turns(Vec3f p) {
  float turns = atan2(p.y, p.x) * inv_two_pi;
  return turns < 0 ? turns + 1.0f : turns;
}

}  // namespace

Vec2f SphericalMapping::operator()(const TexturePoint& point) const {
  Vec3f p = world_to_texture.point(point.p);
  float across = sqrt(p.x * p.x + p.y * p.y);
  return {atan2(across, p.z) * inv_pi, azimuth_turns(p)};
}

Vec2f CylindricalMapping::operator()(const TexturePoint& point) const {
  Vec3f p = world_to_texture.point(point.p);
  return {0.5f + atan2(p.y, p.x) * inv_two_pi, p.z};
}

Mapping build_mapping(const Entity& entity, const Transform& texture_to_world, Diagnostics& diagnostics) {
  const ParameterList& p = entity.parameters;
  std::string name = p.string("mapping", "uv");
  const auto delta = [&] { return Vec2f{p.number("udelta", 0), p.number("vdelta", 0)}; };
  if (name == "spherical") return SphericalMapping{texture_to_world.inverted()};
  if (name == "cylindrical") return CylindricalMapping{texture_to_world.inverted()};
  if (name == "planar")
    return PlanarMapping{texture_to_world.inverted(), p.vec3("v1", {1, 0, 0}), p.vec3("v2", {0, 1, 0}), delta()};
  if (name != "uv")
    diagnostics.error(entity.where, "unknown texture mapping \"" + name + "\"", "uv, spherical, cylindrical or planar");
  if (const std::vector<float>& m = p.array<float>("uvmatrix"); m.size() == 6) {
    AffineUvMapping affine;
    std::copy(m.begin(), m.end(), affine.m.begin());
    return affine;
  } else if (!m.empty()) {
    diagnostics.error(entity.where, "uvmatrix takes six numbers");
  }
  return UvMapping{{p.number("uscale", 1), p.number("vscale", 1)}, delta()};
}

}  // namespace montelux
