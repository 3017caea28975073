#include "scene/materials.h"

#include <algorithm>

namespace montelux {

namespace {

Frame<float> lane_of(const auto& frame, int k) { return {lane(frame.s, k), lane(frame.t, k), lane(frame.n, k)}; }

template <class F>
void set_frame(Frame<F>& frame, int k, const Frame<float>& x) {
  set_lane(frame.s, k, x.s), set_lane(frame.t, k, x.t), set_lane(frame.n, k, x.n);
}

template <class F>
SurfacePoint<float> point_of(const SurfacePoint<F>& s, int k) {
  return {lane(s.p, k), lane(s.p_error, k), lane(s.ng, k), lane(s.ns, k), lane(s.dpdu, k), lane(s.uv, k)};
}

// The frame turned by a tangent-space normal (components in [-1, 1], z outward).
Frame<float> with_normal(const Frame<float>& frame, const Vec3f& dpdu, Vec3f tangent_normal) {
  Vec3f n = frame.to_world(tangent_normal);
  if (!(dot(n, n) > 0)) return frame;
  n = normalize(n);
  // The map keeps the side of the surface.
  return Frame<float>::from_normal_tangent(dot(n, frame.n) < 0 ? -n : n, dpdu);
}

}  // namespace

MaterialSet::MaterialSet(std::vector<Material> materials, const TextureSet* textures)
    : materials_(std::move(materials)), textures_(textures) {
  for (const Material& material : materials_) {
    kinds_.push_back(std::uint32_t(material.kind));
    plain_.push_back(material.is_plain() ? 1u : 0u);
  }
  for (std::size_t kind = 0; kind < bsdf_kind_count; ++kind) two_sided_[kind] = transmits(BsdfKind(kind)) ? 1u : 0u;
}

MaterialSet::PointScattering MaterialSet::look_up(std::uint32_t number, const SurfacePoint<float>& at, float u,
                                                  BsdfRow& row, Frame<float>& frame) const {
  const TexturePoint point{at.uv, at.p, at.ns};
  const Material* material = &materials_[number];
  while (material->mixture) {
    const float amount = clamp(textures_->number(material->mixture->amount, point), 0.0f, 1.0f);
    // The part of u below or above the amount is uniform again, for a mixture in the mixture.
    const bool second = u < amount;
    u = second ? u / amount : (u - amount) / (1 - amount);
    material = &materials_[material->mixture->children[second ? 1 : 0]];
  }
  if (material->is_interface) return {BsdfKind::diffuse, true};
  row = material_row(*material, *textures_, point);
  if (material->normal_map) frame = with_normal(frame, at.dpdu, mapped_normal(*material, at.uv));
  return {material->kind, false};
}

template <class F>
SurfaceScattering<F> MaterialSet::scattering(const SurfaceHit<F>& at, const Vec3<F>& d, Mask<F> on,
                                             RandomStream<F> random) const {
  using U = Uint<F>;
  SurfaceScattering<F> s;
  const U material = select(on, at.material, U(0u));
  s.kind = gather(kinds_.data(), material);
  s.frame = Frame<F>::from_normal_tangent(at.point.ns, at.point.dpdu);
  s.is_interface = Mask<F>(false);
  for_each_lane(on, [&](int k) { s.storage[k] = materials_[lane(material, k)].row; });

  const Mask<F> special = on & (gather(plain_.data(), material) == U(0u));
  if (any(special)) {
    const F u = random.fork(U(0u)).next();
    U passes = U(0u);
    for_each_lane(special, [&](int k) {
      Frame<float> frame = lane_of(s.frame, k);
      PointScattering found = look_up(lane(material, k), point_of(at.point, k), lane(u, k), s.storage[k], frame);
      set_frame(s.frame, k, frame);
      set_lane(s.kind, k, std::uint32_t(found.kind));
      set_lane(passes, k, found.is_interface ? 1u : 0u);
    });
    s.is_interface = special & (passes != U(0u));
  }
  s.is_delta = is_delta<F>(s.lanes(on));
  const Mask<F> both_sides = on & (gather(two_sided_.data(), s.kind) != U(0u));
  const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
  s.light_normal = select<F>(both_sides, zero, face_forward(s.frame.n, -d));
  return s;
}

template SurfaceScattering<float> MaterialSet::scattering(const SurfaceHit<float>&, const Vec3f&, bool,
                                                          RandomStream<float>) const;
template SurfaceScattering<NativeFloats> MaterialSet::scattering(const SurfaceHit<NativeFloats>&,
                                                                 const Vec3<NativeFloats>&, Mask<NativeFloats>,
                                                                 RandomStream<NativeFloats>) const;

}  // namespace montelux
