#include "texture/mapping.h"

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

Mapping build_mapping(const MappingDesc& stated, const Transform& texture_to_world) {
  const Vec2f delta{stated.u_delta, stated.v_delta};
  switch (stated.kind) {
    case MappingKind::spherical:
      return SphericalMapping{texture_to_world.inverted()};
    case MappingKind::cylindrical:
      return CylindricalMapping{texture_to_world.inverted()};
    case MappingKind::planar:
      return PlanarMapping{texture_to_world.inverted(), stated.s_axis, stated.t_axis, delta};
    case MappingKind::uv:
      break;
  }
  if (stated.uv_matrix) return AffineUvMapping{*stated.uv_matrix};
  return UvMapping{{stated.u_scale, stated.v_scale}, delta};
}

}  // namespace montelux
