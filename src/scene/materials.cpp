#include "scene/materials.h"

#include <algorithm>

namespace montelux {

namespace {

// How many slots a model reads, starting with the first.
std::uint32_t slots_of(BsdfKind kind) {
  std::uint32_t slots = 0;
  for_each_present_model<float>(std::uint32_t(kind), true,
                                [&]<class Model>(bool) { slots = std::uint32_t(Model::slot_count); });
  return slots;
}

// The frame rotated by a tangent-space normal (components in [-1, 1], z outward); keeps the side of the surface.
template <class F>
LocalFrame<F> with_normal(const LocalFrame<F>& frame, const Vec3<F>& dpdu, const Vec3<F>& tangent_normal) {
  Vec3<F> n = frame.to_world(tangent_normal);
  const Mask<F> proper = dot(n, n) > F(0.0f);
  n = normalize(select<F>(proper, n, frame.n));
  const LocalFrame<F> turned = LocalFrame<F>::from_normal_tangent(select<F>(dot(n, frame.n) < F(0.0f), -n, n), dpdu);
  return {select<F>(proper, turned.s, frame.s), select<F>(proper, turned.t, frame.t),
          select<F>(proper, turned.n, frame.n)};
}

// Calls f(number, lanes) for each material among the lanes.
template <class F, class Function>
void for_each_material(Uint<F> material, Mask<F> on, Function f) {
  while (any(on)) {
    const std::uint32_t number = lane(material, std::countr_zero(bits(on)));
    const Mask<F> same = on & (material == Uint<F>(number));
    f(number, same);
    on = on & !same;
  }
}

}  // namespace

MaterialSet::MaterialSet(std::vector<Material> materials, const TextureSet* textures)
    : materials_(std::move(materials)), textures_(textures) {
  for (const Material& m : materials_) {
    kinds_.push_back(std::uint32_t(m.kind));
    traits_.push_back((m.bindings.empty() && !m.has_any_normal_map() ? 0u : needs_look_up) |
                      (m.mixture ? is_mixture : 0u) | (m.is_interface ? is_interface : 0u) |
                      slots_of(m.kind) << slots_shift);
    rows_.push_back(m.row);
    has_mixtures_ = has_mixtures_ || m.mixture, has_interfaces_ = has_interfaces_ || m.is_interface;
  }
  for (std::size_t kind = 0; kind < bsdf_kind_count; ++kind) two_sided_[kind] = transmits(BsdfKind(kind)) ? 1u : 0u;
}

template <class F>
Uint<F> MaterialSet::settle_mixtures(Uint<F> material, const TexturePoints<F>& points, Mask<F> on, F u) const {
  using U = Uint<F>;
  const auto mixed_lanes = [&]() -> Mask<F> {
    const U trait = gather(traits_.data(), material) & U(std::uint32_t(is_mixture));
    return on & (trait != U(0u));
  };
  for (Mask<F> mixed = mixed_lanes(); any(mixed); mixed = mixed_lanes())
    for_each_material<F>(material, mixed, [&](std::uint32_t number, Mask<F> same) {
      const Mixture& mixture = *materials_[number].mixture;
      const F amount = clamp(textures_->number(mixture.amount, points, same), 0.0f, 1.0f);
      // The part of u below or above the amount is rescaled to a uniform number for nested mixtures.
      const Mask<F> second = u < amount;
      const F rest = select(second, u, u - amount) / select(second, amount, F(1.0f) - amount);
      u = select(same, rest, u);
      material = select(same, select(second, U(mixture.children[1]), U(mixture.children[0])), material);
    });
  return material;
}

bool MaterialSet::is_interface_at(std::uint32_t material, const TexturePoints<float>& point, float u) const {
  return (traits_[settle_mixtures<float>(material, point, true, u)] & is_interface) != 0;
}

template <class F>
void MaterialSet::look_up(const Material& material, const SurfacePoint<F>& at, const TexturePoints<F>& points,
                          Mask<F> on, SurfaceScattering<F>& s) const {
  look_up_slots<F>(material, *textures_, points, on, s.slots);
  if (!material.has_any_normal_map()) return;
  const LocalFrame<F> plain = s.frame;
  if (material.has_normal_map()) {
    const LocalFrame<F> turned = with_normal<F>(plain, at.dpdu, mapped_normal<F>(material, *textures_, points, on));
    s.frame = {select<F>(on, turned.s, plain.s), select<F>(on, turned.t, plain.t), select<F>(on, turned.n, plain.n)};
  }
  if (material.kind != kind_of<CoatedMetallicRoughness>) return;
  const LocalFrame<F> coat =
      material.coat_normal_texture
          ? with_normal<F>(plain, at.dpdu, mapped_coat_normal<F>(material, *textures_, points, on))
          : plain;
  const Vec3<F> n = s.frame.to_local(coat.n);
  F* slots = s.slots.v + CoatedMetallicRoughnessSlots::coat_normal;
  slots[0] = select(on, n.x, slots[0]), slots[1] = select(on, n.y, slots[1]), slots[2] = select(on, n.z, slots[2]);
}

template <class F>
SurfaceScattering<F> MaterialSet::scattering(const SurfaceHit<F>& at, const Vec3<F>& d, Mask<F> on,
                                             RandomStream<F> random) const {
  using U = Uint<F>;
  const TexturePoints<F> points{at.point.uv, at.point.p, at.point.ns};
  U material = select(on, at.material, U(0u));
  if (has_mixtures_) material = settle_mixtures<F>(material, points, on, random.fork(U(0u)).next());

  SurfaceScattering<F> s;
  const U trait = gather(traits_.data(), material);
  s.kind = gather(kinds_.data(), material);
  s.is_interface = on & ((trait & U(std::uint32_t(is_interface))) != U(0u));
  s.frame = LocalFrame<F>::from_normal_tangent(at.point.ns, at.point.dpdu);
  const U slots = trait >> int(slots_shift), row = material * U(std::uint32_t(sizeof(BsdfRow) / sizeof(float)));
  for (int i = 0; i < bsdf_row_size && any(on & (slots > U(std::uint32_t(i)))); ++i)
    s.slots.v[i] = gather(rows_.data()->v + i, row);
  for_each_material<F>(
      material, on & ((trait & U(std::uint32_t(needs_look_up))) != U(0u)),
      [&](std::uint32_t number, Mask<F> same) { look_up<F>(materials_[number], at.point, points, same, s); });

  s.is_delta = is_delta<F>(s.lanes(on));
  // A coat with its own normal reflects into directions that its base does not face.
  const Mask<F> both_sides = on & ((gather(two_sided_.data(), s.kind) != U(0u)) | has_bent_coat<F>(s.kind, s.slots));
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
