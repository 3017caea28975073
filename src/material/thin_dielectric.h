// A pane of glass without thickness: the light between its two faces is summed in closed form.
#pragma once
#include "material/bsdf.h"
#include "material/fresnel.h"
#include "material/ggx.h"
#include "material/lobe.h"
#include "material/parts.h"

namespace montelux {

struct ThinDielectricSlots {
  static constexpr int eta = 0, tint = 1, alpha = tint + spectrum_size, end = alpha + 1;
  static_assert(fill_bsdf_row(end, {{eta, 1}, {tint, spectrum_size}, {alpha, 1}}));
};

// A pane without refraction.
struct ThinDielectricDesc {
  IndexInput eta = 1.5f;
  SpectrumInput tint = gray_value(1);  // factor of transmitted light
  NumberInput roughness = 0.0f;        // of reflection and transmission
  bool maps_roughness = true;

  static constexpr std::string_view meaning = "a thin pane without refraction";
  static Fields<ThinDielectricDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const ThinDielectricDesc&) const = default;
};

// Reflects R' = R + T^2 R / (1 - R^2), the sum over all internal reflections (Stokes 1862), and transmits the rest,
// multiplied by the tint. Transmission is not refracted; its lobe is the mirror image of the reflection lobe in
// the pane (KHR_materials_transmission, with R' of the facet for F): GGX facets of roughness alpha; a mirror and a
// clear pane where alpha is below 1e-3.
template <class F>
class ThinDielectric {
 public:
  static constexpr std::string_view name = "thindielectric";
  static constexpr bool has_reflection = true, has_transmission = true;
  static constexpr int slot_count = ThinDielectricSlots::end;
  using Stated = ThinDielectricDesc;
  static constexpr std::array<FacetSlots, 1> facet_slots{{{ThinDielectricSlots::alpha, ThinDielectricSlots::alpha}}};

  MONTELUX_INLINE explicit ThinDielectric(const BsdfRows<F>& rows)
      : eta_(rows.number(ThinDielectricSlots::eta)),
        tint_(rows.spectrum(ThinDielectricSlots::tint)),
        facets_(rows.number(ThinDielectricSlots::alpha), rows.number(ThinDielectricSlots::alpha)) {}

  MONTELUX_INLINE Mask<F> is_delta() const { return facets_.is_smooth(); }
  SpecularLobe<F> specular_lobe(F cos_o, bool reflects) const {
    const F reflected = reflectance(F(abs(cos_o)));
    if (reflects) return {gray(reflected)};
    return {tint_ * (F(1.0f) - reflected)};
  }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>&) const {
    if (all(facets_.is_smooth())) return {gray(F(0.0f)), {F(0.0f)}};
    const Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)};
    const Vec3<F> mirrored = onto_side(wi, wo);
    const Mask<F> on = (wo.z * wi.z != F(0.0f)) & !facets_.is_smooth();
    const Vec3<F> m = face_forward(normalize(select(on, wo + mirrored, up)), up);
    const F o_m = abs_dot(wo, m), reflected = reflectance(o_m);
    const Mask<F> reflects = same_side(wo, wi);
    const F seen = select(on, facets_.seen(wo, m) * 0.25f / max(o_m, F(1e-10f)), F(0.0f));
    const F density = seen * select(reflects, reflected, F(1.0f) - reflected);
    return {select(reflects, gray(F(1.0f)), tint_) * (density * facets_.unshadowed(wo, mirrored)), {density}};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>&) const {
    const Mask<F> smooth = facets_.is_smooth();
    const Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)};
    Vec3<F> m = up;
    if (!all(smooth)) m = select(smooth, up, facets_.sample(wo, u2));
    const F o_m = abs_dot(wo, m), reflected = reflectance(o_m);
    const Mask<F> reflects = u < reflected;
    const Vec3<F> mirrored = reflect(wo, m);
    const Vec3<F> wi = select(reflects, mirrored, Vec3<F>{mirrored.x, mirrored.y, -mirrored.z});
    F density = F(0.0f), unshadowed = F(1.0f);
    if (!all(smooth)) {
      const F seen = facets_.seen(wo, m) * 0.25f / max(o_m, F(1e-10f));
      density = select(smooth, F(0.0f), seen * select(reflects, reflected, F(1.0f) - reflected));
      unshadowed = select(smooth, F(1.0f), facets_.unshadowed(wo, mirrored));
    }
    const Mask<F> valid = same_side(wo, mirrored) & (smooth | (density > F(0.0f)));
    return {wi, select(reflects, gray(F(1.0f)), tint_) * unshadowed, {density}, F(1.0f), valid, smooth};
  }
  // Of the facet that was drawn, both lobes.
  MONTELUX_INLINE Spectrum<F> albedo(Vec3<F> wo, const BsdfSample<F>& drawn, Vec2<F>, const BsdfContext<F>&) const {
    const Vec3<F> mirrored = onto_side(drawn.wi, wo), up{F(0.0f), F(0.0f), F(1.0f)};
    const Vec3<F> m = normalize(select(drawn.valid, wo + mirrored, up));
    const F reflected = reflectance(abs_dot(wo, m));
    const F unshadowed = select(facets_.is_smooth(), F(1.0f), facets_.unshadowed(wo, mirrored));
    const Spectrum<F> both = gray(reflected) + tint_ * (F(1.0f) - reflected);
    return select(drawn.valid, both * unshadowed, gray(F(0.0f)));
  }

 private:
  // R + (1 - R)^2 R / (1 - R^2) = 2 R / (1 + R).
  MONTELUX_INLINE F reflectance(F cos) const {
    const F r = fresnel_dielectric(cos, eta_);
    return 2.0f * r / (F(1.0f) + r);
  }

  F eta_;
  Spectrum<F> tint_;
  GgxFacets<F> facets_;
};

}  // namespace montelux
