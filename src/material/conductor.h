// Metals: GGX microfacets with a complex index of refraction.
#pragma once
#include "material/bsdf.h"
#include "material/fresnel.h"
#include "material/ggx.h"
#include "material/lobe.h"
#include "material/parts.h"

namespace montelux {

struct ConductorSlots {
  static constexpr int alpha_x = 0, alpha_y = 1, eta = 2, k = eta + spectrum_size, end = k + spectrum_size;
  static_assert(fill_bsdf_row(end, {{alpha_x, 1}, {alpha_y, 1}, {eta, spectrum_size}, {k, spectrum_size}}));
};

struct ConductorDesc {
  MetalDesc metal{};
  FacetsDesc facets{};
  bool maps_roughness = true;

  static constexpr std::string_view meaning = "a rough or smooth metal (GGX)";
  static Fields<ConductorDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const ConductorDesc&) const = default;
};

// f = D G F / (4 cos cos) (Cook and Torrance 1982, Walter et al. 2007), on both sides; a mirror where both roughnesses
// below 1e-3. Samples visible normals (Heitz 2018).
template <class F>
class Conductor {
 public:
  static constexpr std::string_view name = "conductor";
  static constexpr bool has_reflection = true, has_transmission = false;
  static constexpr int slot_count = ConductorSlots::end;
  using Stated = ConductorDesc;
  static constexpr std::array<FacetSlots, 1> facet_slots{{{ConductorSlots::alpha_x, ConductorSlots::alpha_y}}};

  MONTELUX_INLINE explicit Conductor(const BsdfRows<F>& rows)
      : Conductor({rows.number(ConductorSlots::alpha_x), rows.number(ConductorSlots::alpha_y)},
                  rows.spectrum(ConductorSlots::eta), rows.spectrum(ConductorSlots::k)) {}
  MONTELUX_INLINE Conductor(GgxFacets<F> facets, const Spectrum<F>& eta, const Spectrum<F>& k)
      : facets_(facets), eta_(eta), k_(k) {}

  MONTELUX_INLINE Mask<F> is_delta() const { return facets_.is_smooth(); }
  SpecularLobe<F> specular_lobe(F cos_o, bool reflects) const {
    if (!reflects) return {};
    return {fresnel_conductor(F(abs(cos_o)), eta_, k_)};
  }

  Roughness<F> specular_facets() const { return facets_.roughness(); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>&) const {
    Vec3<F> sum = wo + wi, up{F(0.0f), F(0.0f), F(1.0f)};
    Mask<F> smooth = facets_.is_smooth(), same = same_side(wo, wi), on = same & !smooth;
    Vec3<F> m = face_forward(normalize(select(on, sum, up)), up);
    F o_m = abs_dot(wo, m);
    F density = select(on, facets_.seen(wo, m) * 0.25f / max(o_m, F(1e-10f)), F(0.0f));
    return {fresnel_conductor(o_m, eta_, k_) * (density * facets_.unshadowed(wo, wi)), {density}};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F, Vec2<F> u2, const BsdfContext<F>&) const {
    Mask<F> smooth = facets_.is_smooth();
    Vec3<F> m{F(0.0f), F(0.0f), F(1.0f)};
    if (!all(smooth)) m = select(smooth, m, facets_.sample(wo, u2));
    Vec3<F> wi = reflect(wo, m);
    F o_m = abs_dot(wo, m);
    F density = facets_.seen(wo, m) * 0.25f / max(o_m, F(1e-10f));
    F unshadowed = select(smooth, F(1.0f), facets_.unshadowed(wo, wi));
    return {wi, fresnel_conductor(o_m, eta_, k_) * unshadowed, {density}, F(1.0f), same_side(wo, wi), smooth};
  }

 private:
  GgxFacets<F> facets_;
  Spectrum<F> eta_, k_;
};

}  // namespace montelux
