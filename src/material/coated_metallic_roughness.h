// The metallic-roughness model of glTF 2.0 with KHR_materials_clearcoat and KHR_materials_anisotropy.
#pragma once
#include "material/metallic_roughness.h"

namespace montelux {

// The first slots are those of MetallicRoughness. (grain_x, grain_y): the direction of the grain in the tangent plane,
// of any positive length, rotated by the angle with cosine `turn_cos` and sine `turn_sin`; `side` is -1 where the
// parametrisation is mirrored, else 1. `coat_normal`: of the coat, unit, in the frame of the base; its z is >= 0.
struct CoatedMetallicRoughnessSlots {
  static constexpr int anisotropy = MetallicRoughnessSlots::end, grain_x = anisotropy + 1, grain_y = grain_x + 1,
                       turn_cos = grain_y + 1, turn_sin = turn_cos + 1, coat = turn_sin + 1, coat_roughness = coat + 1,
                       side = coat_roughness + 1, coat_normal = side + 1, end = coat_normal + 3;
  static_assert(fill_bsdf_row(end, {{0, MetallicRoughnessSlots::end},
                                    {anisotropy, 1},
                                    {grain_x, 1},
                                    {grain_y, 1},
                                    {turn_cos, 1},
                                    {turn_sin, 1},
                                    {coat, 1},
                                    {coat_roughness, 1},
                                    {side, 1},
                                    {coat_normal, 3}}));
};

// The same with a grain, and under a clear coat of index 1.5.
struct CoatedMetallicRoughnessDesc {
  MetallicRoughnessDesc base{};
  NumberInput coat = 1.0f;            // share of the coat
  NumberInput coat_roughness = 0.0f;  // GGX's alpha is its square
  NormalMapDesc coat_normals{};
  NumberInput anisotropy = 0.0f;   // strength of the grain
  float grain_rotation = 0;        // from u towards v, in degrees
  NumberInput grain_x = 1.0f;      // the unrotated grain's component along u, from 0 (-1) to 1 (1)
  NumberInput grain_y = 0.5f;      // the same along v
  bool grain_is_mirrored = false;  // v is against n x u

  static constexpr std::string_view meaning =
      "metallicroughness with a grain and a clear coat of index 1.5, as in extensions of glTF (Montelux alone)";
  static Fields<CoatedMetallicRoughnessDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const CoatedMetallicRoughnessDesc&) const = default;
};

// f = (1 - c F(cos o)) (1 - c F(cos i)) f_base + c D V F(wo.h): the share c of a coat of GGX facets of index 1.5, with
// alpha the square of its roughness and Schlick's F from 0.04. KHR_materials_clearcoat has only the first factor, which
// is not reciprocal: light passes the coat on its way in and on its way out. The coat has a normal of its own, to which
// its angles and its cosine refer, so that it can reflect into directions where the base is dark. The base's facets
// have alpha mix(alpha, 1, anisotropy^2) along the grain and alpha across it (KHR_materials_anisotropy).
template <class F>
class CoatedMetallicRoughness {
 public:
  static constexpr std::string_view name = "coatedmetallicroughness";
  static constexpr bool has_reflection = true, has_transmission = false;
  static constexpr int slot_count = CoatedMetallicRoughnessSlots::end;
  using Stated = CoatedMetallicRoughnessDesc;
  static constexpr std::array<FacetSlots, 2> facet_slots{
      {{MetallicRoughnessSlots::roughness, MetallicRoughnessSlots::roughness, 2},
       {CoatedMetallicRoughnessSlots::coat_roughness, CoatedMetallicRoughnessSlots::coat_roughness, 2}}};

  static bool has_grain(const BsdfRows<float>& rows) { return rows.number(S::anisotropy) != 0; }

  MONTELUX_INLINE explicit CoatedMetallicRoughness(const BsdfRows<F>& rows)
      : coat_(rows.number(S::coat)),
        facets_(square(rows.number(S::coat_roughness)), square(rows.number(S::coat_roughness))),
        coat_frame_(LocalFrame<F>::from_normal(
            {rows.number(S::coat_normal), rows.number(S::coat_normal + 1), rows.number(S::coat_normal + 2)})) {
    const F roughness = rows.number(MetallicRoughnessSlots::roughness), alpha = roughness * roughness;
    const F strength = rows.number(S::anisotropy);
    const F x = rows.number(S::grain_x), y = rows.number(S::grain_y), c = rows.number(S::turn_cos),
            s = rows.number(S::turn_sin), length = sqrt(x * x + y * y);
    const Mask<F> points = length > F(1e-6f);
    const F scale = F(1.0f) / select(points, length, F(1.0f));
    cos_ = select(points, (c * x - s * y) * scale, c),
    sin_ = select(points, (s * x + c * y) * scale, s) * rows.number(S::side);
    base_ = MetallicRoughness<F>(rows, GgxFacets<F>(alpha + (F(1.0f) - alpha) * strength * strength, alpha));
  }

  MONTELUX_INLINE Mask<F> is_delta() const { return base_.is_delta() & (facets_.is_smooth() | (coat_ <= F(0.0f))); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const {
    const BsdfValue<F> below = base_.evaluate(along_grain(wo), along_grain(wi), context);
    const Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)}, o = coat_frame_.to_local(wo), i = coat_frame_.to_local(wi);
    const Mask<F> same = same_side(o, i);
    const Vec3<F> m = face_forward(normalize(select(same, o + i, up)), up);
    const F o_m = abs_dot(o, m), p = coat_share(o);
    const F seen = select(facets_.is_smooth() | !same, F(0.0f), facets_.seen(o, m) * 0.25f / max(o_m, F(1e-10f)));
    const F coat = coat_ * fresnel(o_m) * seen * facets_.unshadowed(o, i);
    return {below.f_cos * (passed(o) * passed(i)) + gray(coat), {p * seen + (F(1.0f) - p) * below.density.value}};
  }

  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
    const Vec3<F> o = coat_frame_.to_local(wo);
    const F p = coat_share(o);
    const Mask<F> from_coat = u < p, from_base = !from_coat, smooth = facets_.is_smooth(), mirrors = from_coat & smooth;
    // The remainder of u is uniform again.
    const F rest = clamp((u - p) / max(F(1.0f) - p, F(1e-10f)), F(0.0f), F(one_minus_epsilon));
    BsdfSample<F> below = base_.sample(along_grain(wo), rest, u2, context);
    Vec3<F> m{F(0.0f), F(0.0f), F(1.0f)};
    if (!all(smooth)) m = select(smooth, m, facets_.sample(o, u2));
    const Vec3<F> mirrored = reflect(o, m);
    const Vec3<F> wi = select(from_coat, coat_frame_.to_world(mirrored), off_grain(below.wi));
    const Mask<F> delta = mirrors | (from_base & below.delta);
    const BsdfValue<F> value = evaluate(wo, wi, context);
    const Spectrum<F> from_mirror = gray(coat_ * fresnel(abs(o.z)) / max(p, F(1e-10f)));
    const Spectrum<F> through =
        below.weight * (passed(o) * passed(coat_frame_.to_local(wi)) / max(F(1.0f) - p, F(1e-10f)));
    const Spectrum<F> weight =
        select(mirrors, from_mirror, select(delta, through, value.f_cos / max(value.density.value, F(1e-30f))));
    const Mask<F> kept = (from_coat & same_side(o, mirrored)) | (from_base & below.valid & same_side(wo, wi));
    const Mask<F> valid = kept & (delta | (value.density.value > F(0.0f)));
    return {wi, weight, value.density, F(1.0f), valid, delta};
  }
  MONTELUX_INLINE Spectrum<F> albedo(Vec3<F> wo, const BsdfSample<F>&, Vec2<F> u2, const BsdfContext<F>&) const {
    const Vec3<F> o = coat_frame_.to_local(wo);
    const Spectrum<F> below = base_.albedo_under(
        along_grain(wo), u2, [&](const Vec3<F>& wi) { return passed(coat_frame_.to_local(off_grain(wi))); });
    Vec3<F> m{F(0.0f), F(0.0f), F(1.0f)};
    const Mask<F> smooth = facets_.is_smooth();
    if (!all(smooth)) m = select(smooth, m, facets_.sample(o, u2));
    const Vec3<F> mirrored = reflect(o, m);
    const F unshadowed = select(smooth, F(1.0f), facets_.unshadowed(o, mirrored));
    const F coat = select(same_side(o, mirrored), coat_ * fresnel(abs_dot(o, m)) * unshadowed, F(0.0f));
    return below * passed(o) + gray(coat);
  }

 private:
  using S = CoatedMetallicRoughnessSlots;

  MONTELUX_INLINE Vec3<F> along_grain(Vec3<F> w) const {
    return {cos_ * w.x + sin_ * w.y, cos_ * w.y - sin_ * w.x, w.z};
  }
  MONTELUX_INLINE Vec3<F> off_grain(Vec3<F> w) const { return {cos_ * w.x - sin_ * w.y, sin_ * w.x + cos_ * w.y, w.z}; }
  static MONTELUX_INLINE F fresnel(F cos) {
    const F x = max(F(1.0f) - cos, F(0.0f)), x2 = x * x;
    return F(0.04f) + F(0.96f) * (x2 * x2 * x);
  }
  // The fraction that passes the coat.
  MONTELUX_INLINE F passed(Vec3<F> w) const { return F(1.0f) - coat_ * fresnel(abs(w.z)); }
  // Probability of the coat in sampling.
  MONTELUX_INLINE F coat_share(Vec3<F> wo) const {
    return select(coat_ > F(0.0f), clamp(coat_ * fresnel(abs(wo.z)) * 2.0f, F(0.05f), F(0.5f)), F(0.0f));
  }

  F coat_, cos_, sin_;
  GgxFacets<F> facets_;
  LocalFrame<F> coat_frame_;
  MetallicRoughness<F> base_;
};

}  // namespace montelux
