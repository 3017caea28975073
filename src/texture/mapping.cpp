#include "texture/mapping.h"

#include "parameter/fields.h"

namespace montelux {

Fields<MappingDesc> rows_of_mapping() {
  using M = MappingDesc;
  constexpr double unlimited = 1e30;
  const auto is_of = [](MappingKind kind) { return [kind](const M& map) { return map.kind == kind; }; };
  const auto is_scaled = [](const M& map) { return map.kind == MappingKind::uv && !map.uv_matrix; };
  const auto is_shifted = [=](const M& map) { return is_scaled(map) || map.kind == MappingKind::planar; };
  Fields<M> fields;
  fields.choice<MappingKind>("mapping", &M::kind, "map from a point to (s, t)",
                             {{"uv", MappingKind::uv},
                              {"spherical", MappingKind::spherical},
                              {"cylindrical", MappingKind::cylindrical},
                              {"planar", MappingKind::planar}});
  fields.number("uscale", &M::u_scale, "factor of u", -unlimited, unlimited).only_if(is_scaled);
  fields.number("vscale", &M::v_scale, "factor of v", -unlimited, unlimited).only_if(is_scaled);
  fields.number("udelta", &M::u_delta, "added to u", -unlimited, unlimited).only_if(is_shifted);
  fields.number("vdelta", &M::v_delta, "added to v", -unlimited, unlimited).only_if(is_shifted);
  fields
      .list<6>("uvmatrix", &M::uv_matrix,
               "a b c d e f: s = a u + b v + c, t = d u + e v + f, instead of the four (Montelux alone)", -unlimited,
               unlimited)
      .only_if(is_of(MappingKind::uv));
  fields.vector("v1", ParameterType::vector3, &M::s_axis, "s axis of the planar mapping")
      .only_if(is_of(MappingKind::planar));
  fields.vector("v2", ParameterType::vector3, &M::t_axis, "t axis of the planar mapping")
      .only_if(is_of(MappingKind::planar));
  return fields;
}

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

Vec2<NativeFloats> apply(const Mapping& mapping, const TexturePack& points, TextureMask on) {
  if (const auto* uv = std::get_if<UvMapping>(&mapping)) return uv->map(points.uv);
  if (const auto* affine = std::get_if<AffineUvMapping>(&mapping)) return affine->map(points.uv);
  if (const auto* plane = std::get_if<PlanarMapping>(&mapping)) return plane->map(points.p);
  Vec2<NativeFloats> st{NativeFloats(0.0f), NativeFloats(0.0f)};
  for_each_lane(on, [&](int k) {
    const TexturePoint point = point_of(points, k);
    set_lane(st, k, apply(mapping, point));
  });
  return st;
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
