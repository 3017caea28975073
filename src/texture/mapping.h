// Maps from a point of a surface to a position (s, t) of a planar texture.
#pragma once
#include <array>
#include <optional>
#include <variant>

#include "math/transform.h"
#include "texture/texture.h"
#include "texture/wrap.h"

namespace montelux {

template <class S>
class Fields;

enum class MappingKind { uv, spherical, cylindrical, planar };

// A map as stated by a scene.
struct MappingDesc {
  MappingKind kind = MappingKind::uv;
  float u_scale = 1, v_scale = 1;                   // of uv: s = u_scale u + u_delta
  float u_delta = 0, v_delta = 0;                   // of uv and planar
  std::optional<std::array<float, 6>> uv_matrix{};  // of uv, instead: the rows of an affine map
  Vec3f s_axis{1, 0, 0}, t_axis{0, 1, 0};           // of planar, in the space of the texture
};
Fields<MappingDesc> rows_of_mapping();

// Scaled and shifted surface parameters.
struct UvMapping {
  Vec2f scale{1, 1}, delta{0, 0};
  template <class F>
  Vec2<F> map(const Vec2<F>& uv) const {
    return {scale.x * uv.x + delta.x, scale.y * uv.y + delta.y};
  }
  Vec2f operator()(const TexturePoint& point) const { return map(point.uv); }
};

// Any affine map of the surface parameters, by the rows of its matrix.
struct AffineUvMapping {
  std::array<float, 6> m{1, 0, 0, 0, 1, 0};
  template <class F>
  Vec2<F> map(const Vec2<F>& uv) const {
    return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
  }
  Vec2f operator()(const TexturePoint& point) const { return map(point.uv); }
};

// s: the polar angle from +z over pi; t: the azimuth over 2 pi; of the point in texture space.
struct SphericalMapping {
  Transform world_to_texture;
  Vec2f operator()(const TexturePoint& point) const;
};

// s: the azimuth, half a turn at +x, over 2 pi; t: z.
struct CylindricalMapping {
  Transform world_to_texture;
  Vec2f operator()(const TexturePoint& point) const;
};

// The point's coordinates along two axes of texture space, shifted.
struct PlanarMapping {
  Transform world_to_texture;
  Vec3f s_axis{1, 0, 0}, t_axis{0, 1, 0};
  Vec2f delta{0, 0};
  template <class F>
  Vec2<F> map(const Vec3<F>& world) const {
    const Vec3<F> p = world_to_texture.point(world);
    return {delta.x + dot(p, splat<F>(s_axis)), delta.y + dot(p, splat<F>(t_axis))};
  }
  Vec2f operator()(const TexturePoint& point) const { return map(point.p); }
};

using Mapping = std::variant<UvMapping, SphericalMapping, CylindricalMapping, PlanarMapping, AffineUvMapping>;

inline Vec2f apply(const Mapping& mapping, const TexturePoint& point) {
  return std::visit([&](const auto& m) { return m(point); }, mapping);
}

// The same in lanes, bit for bit.
Vec2<NativeFloats> apply(const Mapping& mapping, const TexturePack& points, TextureMask on);

Mapping build_mapping(const MappingDesc& stated, const Transform& texture_to_world);

}  // namespace montelux
