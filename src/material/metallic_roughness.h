// The metallic-roughness model of glTF 2.0, with the extensions KHR_materials_ior and KHR_materials_specular.
#pragma once
#include "material/bsdf.h"
#include "material/ggx.h"
#include "material/lobe.h"
#include "material/parts.h"

namespace montelux {

struct MetallicRoughnessSlots {
  // `reflected`: the reflectance of a dielectric at normal incidence, ((eta - 1) / (eta + 1))^2.
  static constexpr int base = 0, metallic = spectrum_size, roughness = metallic + 1, specular = roughness + 1,
                       specular_color = specular + 1, reflected = specular_color + spectrum_size, end = reflected + 1;
  static_assert(fill_bsdf_row(end, {{base, spectrum_size},
                                    {metallic, 1},
                                    {roughness, 1},
                                    {specular, 1},
                                    {specular_color, spectrum_size},
                                    {reflected, 1}}));
};

// The material of glTF 2.0: a dielectric coat over a diffuse base, or a metal.
struct MetallicRoughnessDesc {
  SpectrumInput base_color = gray_value(1);  // albedo of the diffuse part, and colour of the metal
  NumberInput metallic = 1.0f;               // share of the metal
  NumberInput roughness = 1.0f;              // GGX's alpha is its square
  NumberInput specular = 1.0f;               // strength of the dielectric's reflection
  SpectrumInput specular_color = gray_value(1);
  IndexInput eta = 1.5f;  // of the dielectric

  static constexpr std::string_view meaning =
      "the material of glTF 2.0: a dielectric coat over a diffuse base, or a metal (Montelux alone)";
  static Fields<MetallicRoughnessDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const MetallicRoughnessDesc&) const = default;
};

// f = (1 - metallic) base / pi (1 - F') + D V F (glTF 2.0, appendix B.3): GGX of alpha = roughness^2 with Smith's
// height-correlated masking, and Schlick's F = f0 + (f90 - f0) (1 - wo.h)^5, where f0 is that of the dielectric mixed
// with the base colour by metallic (KHR_materials_specular). On both sides; a mirror where alpha is below 1e-3.
//
// F' is the largest component of F at the minimum of wo.h, cos o and cos i. Appendix B has F at wo.h instead, which
// returns up to 1.9 times the light at grazing angles; F' never returns more than arrives. Both are reciprocal. Light
// that is masked between facets is lost.
template <class F>
class MetallicRoughness {
 public:
  static constexpr std::string_view name = "metallicroughness";
  static constexpr bool has_reflection = true, has_transmission = false;
  static constexpr int slot_count = MetallicRoughnessSlots::end;
  using Stated = MetallicRoughnessDesc;
  static constexpr std::array<FacetSlots, 1> facet_slots{
      {{MetallicRoughnessSlots::roughness, MetallicRoughnessSlots::roughness, 2}}};

  MetallicRoughness() = default;
  MONTELUX_INLINE explicit MetallicRoughness(const BsdfRows<F>& rows)
      : MetallicRoughness(rows, square(rows.number(MetallicRoughnessSlots::roughness))) {}
  MONTELUX_INLINE MetallicRoughness(const BsdfRows<F>& rows, F alpha)
      : MetallicRoughness(rows, GgxFacets<F>(alpha, alpha)) {}
  // With facets of another shape.
  MONTELUX_INLINE MetallicRoughness(const BsdfRows<F>& rows, const GgxFacets<F>& facets) : facets_(facets) {
    using S = MetallicRoughnessSlots;
    const Spectrum<F> base = rows.spectrum(S::base), color = rows.spectrum(S::specular_color);
    const F metallic = rows.number(S::metallic), specular = rows.number(S::specular);
    const F reflected = rows.number(S::reflected);
    f0_ = per_component(
        [&](F b, F c) { return (F(1.0f) - metallic) * (min(reflected * c, F(1.0f)) * specular) + metallic * b; }, base,
        color);
    f90_ = specular * (F(1.0f) - metallic) + metallic;
    diffuse_ = base * (F(1.0f) - metallic);
    is_metal_ = max_component(diffuse_) <= F(0.0f);
    is_matt_ = f90_ <= F(0.0f);
  }

  MONTELUX_INLINE Mask<F> is_delta() const { return facets_.is_smooth() & is_metal_ & !is_matt_; }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>&) const {
    const Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)};
    const Mask<F> same = same_side(wo, wi);
    const Vec3<F> m = face_forward(normalize(select(same, wo + wi, up)), up);
    const F o_m = abs_dot(wo, m), p = mirror_share(wo);
    const F seen = select(facets_.is_smooth(), F(0.0f), facets_.seen(wo, m) * 0.25f / max(o_m, F(1e-10f)));
    const F cosine = cosine_density(wi);
    const Spectrum<F> value =
        diffuse_ * (under(o_m, wo, wi) * cosine) + fresnel(o_m) * (seen * facets_.unshadowed(wo, wi));
    const F density = p * seen + (F(1.0f) - p) * cosine;
    return {select(same, value, gray(F(0.0f))), {select(same, density, F(0.0f))}};
  }

  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
    const Mask<F> smooth = facets_.is_smooth();
    const F p = mirror_share(wo);
    const Mask<F> mirrors = u < p, delta = mirrors & smooth;
    Vec3<F> m{F(0.0f), F(0.0f), F(1.0f)};
    if (!all(smooth)) m = select(smooth, m, facets_.sample(wo, u2));
    const Vec3<F> wi = select(mirrors, reflect(wo, m), sample_cosine_side(wo, u2));
    const BsdfValue<F> value = evaluate(wo, wi, context);
    const Spectrum<F> weight =
        select(delta, fresnel(abs(wo.z)) / max(p, F(1e-10f)), value.f_cos / max(value.density.value, F(1e-30f)));
    const Mask<F> valid = same_side(wo, wi) & (delta | (value.density.value > F(0.0f)));
    return {wi, weight, value.density, F(1.0f), valid, delta};
  }
  MONTELUX_INLINE Spectrum<F> albedo(Vec3<F> wo, const BsdfSample<F>&, Vec2<F> u2, const BsdfContext<F>&) const {
    return albedo_under(wo, u2, [](const Vec3<F>&) { return F(1.0f); });
  }
  // With passed(wi), the fraction that a coat lets through along wi. One direction of the diffuse part and one of the
  // facets, by the same numbers.
  template <class Passed>
  MONTELUX_INLINE Spectrum<F> albedo_under(Vec3<F> wo, Vec2<F> u2, Passed passed) const {
    const Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)}, spread = sample_cosine_side(wo, u2);
    const F o_h = abs_dot(wo, face_forward(normalize(wo + spread), up));
    const Mask<F> smooth = facets_.is_smooth();
    Vec3<F> m = up;
    if (!all(smooth)) m = select(smooth, up, facets_.sample(wo, u2));
    const Vec3<F> wi = reflect(wo, m);
    const F unshadowed = select(smooth, F(1.0f), facets_.unshadowed(wo, wi));
    const F mirrored = select(same_side(wo, wi) & !is_matt_, unshadowed * passed(wi), F(0.0f));
    return diffuse_ * (under(o_h, wo, spread) * passed(spread)) + fresnel(abs_dot(wo, m)) * mirrored;
  }

 private:
  MONTELUX_INLINE Spectrum<F> fresnel(F cos) const {
    const F x = max(F(1.0f) - cos, F(0.0f)), x2 = x * x;
    const F grazing = x2 * x2 * x;
    return per_component([&](F f) { return f + (f90_ - f) * grazing; }, f0_);
  }
  // The fraction that reaches the diffuse part.
  MONTELUX_INLINE F under(F o_m, Vec3<F> wo, Vec3<F> wi) const {
    return max(F(1.0f) - max_component(fresnel(min(o_m, min(abs(wo.z), abs(wi.z))))), F(0.0f));
  }
  // Probability of the facets in sampling, from the light that either part would return from wo.
  MONTELUX_INLINE F mirror_share(Vec3<F> wo) const {
    const Spectrum<F> f = fresnel(abs(wo.z));
    const F mirrored = average(f), below = average(diffuse_) * (F(1.0f) - max_component(f));
    const F p = clamp(mirrored / max(mirrored + below, F(1e-10f)), 0.1f, 0.9f);
    return select(is_matt_, F(0.0f), select(is_metal_, F(1.0f), p));
  }

  Spectrum<F> f0_, diffuse_;
  F f90_;
  GgxFacets<F> facets_;
  Mask<F> is_metal_, is_matt_;
};

}  // namespace montelux
