// Glass: one interface between two dielectrics, smooth or with GGX microfacets.
#pragma once
#include "material/bsdf.h"
#include "material/fresnel.h"
#include "material/ggx.h"
#include "material/lobe.h"
#include "material/parts.h"

namespace montelux {

struct DielectricSlots {
  static constexpr int alpha_x = 0, alpha_y = 1, eta = 2, end = 3;
  static_assert(fill_bsdf_row(end, {{alpha_x, 1}, {alpha_y, 1}, {eta, 1}}));
};

// Which lobes of an interface are wanted. If one is excluded, the other is sampled with certainty.
enum class Lobes { both, reflection, transmission };

// Glass.
struct DielectricDesc {
  IndexInput eta = 1.5f;
  FacetsDesc facets{};
  bool maps_roughness = true;

  static constexpr std::string_view meaning = "rough or smooth glass (GGX)";
  static Fields<DielectricDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const DielectricDesc&) const = default;
};

// Reflection and refraction by microfacets (Walter et al. 2007, eq. 20 and 21). `eta` is the index below the surface
// over that above. A plane interface if both roughnesses are below 1e-3, or if the indices match. Samples visible
// normals, then reflects with the probability of the Fresnel reflectance there.
template <class F>
class Dielectric {
 public:
  static constexpr std::string_view name = "dielectric";
  static constexpr bool has_reflection = true, has_transmission = true;
  static constexpr int slot_count = DielectricSlots::end;
  using Stated = DielectricDesc;
  static constexpr std::array<FacetSlots, 1> facet_slots{{{DielectricSlots::alpha_x, DielectricSlots::alpha_y}}};

  MONTELUX_INLINE explicit Dielectric(const BsdfRows<F>& rows)
      : Dielectric({rows.number(DielectricSlots::alpha_x), rows.number(DielectricSlots::alpha_y)},
                   rows.number(DielectricSlots::eta)) {}
  MONTELUX_INLINE Dielectric(GgxFacets<F> facets, F eta)
      : smooth_(facets.is_smooth() | (eta == F(1.0f))), facets_(facets), eta_(eta) {}

  MONTELUX_INLINE Mask<F> is_delta() const { return smooth_; }
  MONTELUX_INLINE F eta() const { return eta_; }
  SpecularLobe<F> specular_lobe(F cos_o, bool reflects) const {
    const F reflected = fresnel_dielectric(cos_o, eta_);
    if (reflects) return {gray(reflected)};
    const F relative = select(cos_o < F(0.0f), F(1.0f) / eta_, eta_);
    return {gray(F((F(1.0f) - reflected) / (relative * relative))), relative};
  }

  Roughness<F> specular_facets() const { return facets_.roughness(); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const {
    LobeValue value = evaluate_lobes<Lobes::both>(wo, wi, context.mode);
    return {gray(value.f_cos), {value.density}};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
    LobeSample s = sample_lobes<Lobes::both>(wo, u, u2, context.mode);
    return {s.wi, gray(s.weight), {s.density}, s.eta_scale, s.valid, smooth_};
  }

  // The same without colour, for a choice of lobes: zero in the others.
  struct LobeValue {
    F f_cos, density;
  };
  struct LobeSample {
    Vec3<F> wi;
    F weight, density, eta_scale;
    Mask<F> valid;
  };
  template <Lobes lobes>
  LobeValue evaluate_lobes(Vec3<F> wo, Vec3<F> wi, TransportMode mode) const;
  template <Lobes lobes>
  LobeSample sample_lobes(Vec3<F> wo, F u, Vec2<F> u2, TransportMode mode) const;

 private:
  Mask<F> smooth_;
  GgxFacets<F> facets_;
  F eta_;
};

// |d m / d wi| of the half vector, both cases (Walter et al. 2007, eq. 14 and 17).
template <class F>
MONTELUX_INLINE F half_vector_jacobian(F o_m, F i_m, F relative_eta, Mask<F> reflects) {
  F refraction = abs(i_m) / max(square(i_m + o_m / relative_eta), F(1e-20f));
  return select(reflects, F(0.25f) / max(abs(o_m), F(1e-10f)), refraction);
}

template <class F>
template <Lobes lobes>
MONTELUX_INLINE auto Dielectric<F>::evaluate_lobes(Vec3<F> wo, Vec3<F> wi, TransportMode mode) const -> LobeValue {
  if (all(smooth_)) return {F(0.0f), F(0.0f)};
  Mask<F> reflects = same_side(wo, wi);
  F relative = select(reflects, F(1.0f), select(wo.z < F(0.0f), F(1.0f) / eta_, eta_));

  // The facet that maps wo to wi; each of them must be on the side of the facet where it is of the surface.
  Vec3<F> sum = wi * relative + wo, up{F(0.0f), F(0.0f), F(1.0f)};
  Mask<F> on = (wo.z * wi.z != F(0.0f)) & (length_squared(sum) > F(0.0f)) & !smooth_;
  Vec3<F> m = face_forward(normalize(select(on, sum, up)), up);
  F o_m = dot(wo, m), i_m = dot(wi, m);
  on = on & (i_m * wi.z > F(0.0f)) & (o_m * wo.z > F(0.0f));
  if constexpr (lobes == Lobes::reflection) on = on & reflects;
  if constexpr (lobes == Lobes::transmission) on = on & !reflects;

  F reflected = fresnel_dielectric(o_m, eta_);
  F part = select(reflects, reflected, F(1.0f) - reflected);
  on = on & (part > F(0.0f));
  F density = facets_.seen(wo, m) * half_vector_jacobian(o_m, i_m, relative, reflects);
  F scale = mode == TransportMode::radiance ? F(1.0f) / (relative * relative) : F(1.0f);
  F f_cos = density * part * scale * facets_.unshadowed(wo, wi);
  if constexpr (lobes == Lobes::both) density = density * part;
  return {select(on, f_cos, F(0.0f)), select(on, density, F(0.0f))};
}

template <class F>
template <Lobes lobes>
MONTELUX_INLINE auto Dielectric<F>::sample_lobes(Vec3<F> wo, F u, Vec2<F> u2, TransportMode mode) const -> LobeSample {
  const bool rough = !all(smooth_);
  Vec3<F> m{F(0.0f), F(0.0f), F(1.0f)};
  if (rough) m = select(smooth_, m, facets_.sample(wo, u2));
  F reflected = fresnel_dielectric(dot(wo, m), eta_);
  Mask<F> reflects = u < reflected;
  if constexpr (lobes != Lobes::both) reflects = Mask<F>(lobes == Lobes::reflection);

  Refraction<F> refraction = refract(wo, m, eta_);
  Vec3<F> wi = select(reflects, reflect(wo, m), refraction.wt);
  F relative = select(reflects, F(1.0f), refraction.relative_eta);
  F part = select(reflects, reflected, F(1.0f) - reflected);
  Mask<F> right_side = !Mask<F>(same_side(wo, wi) ^ reflects);
  Mask<F> valid = right_side & (reflects | refraction.valid) & (wo.z * wi.z != F(0.0f)) & (part > F(0.0f));

  F density = F(0.0f);
  F weight = mode == TransportMode::radiance ? F(1.0f) / (relative * relative) : F(1.0f);
  if (rough) {
    density = facets_.seen(wo, m) * half_vector_jacobian(dot(wo, m), dot(wi, m), relative, reflects);
    weight = weight * select(smooth_, F(1.0f), facets_.unshadowed(wo, wi));
  }
  if constexpr (lobes == Lobes::both)
    density = density * part;
  else
    weight = weight * part;
  F eta_scale = mode == TransportMode::radiance ? F(relative * relative) : F(1.0f);
  return {wi, weight, density, eta_scale, valid};
}

}  // namespace montelux
