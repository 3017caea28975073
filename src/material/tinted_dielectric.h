// Coloured glass: an interface that tints the light that passes it, around a body that absorbs.
#pragma once
#include "material/dielectric.h"

namespace montelux {

// The first slots are those of Dielectric. `absorption`, per unit of length, is that of the body inside: paths apply it
// along their segments, not the surface.
struct TintedDielectricSlots {
  static constexpr int alpha_x = 0, alpha_y = 1, eta = 2, tint = 3, absorption = tint + spectrum_size,
                       end = absorption + spectrum_size;
  static_assert(
      fill_bsdf_row(end, {{alpha_x, 1}, {alpha_y, 1}, {eta, 1}, {tint, spectrum_size}, {absorption, spectrum_size}}));
};

// Glass that tints transmitted light and absorbs inside.
struct TintedDielectricDesc {
  IndexInput eta = 1.5f;
  SpectrumInput tint = gray_value(1);        // factor of transmitted light
  SpectrumValue absorption = gray_value(0);  // inside, per unit of length
  FacetsDesc facets{};
  bool maps_roughness = true;

  static constexpr std::string_view meaning = "glass that tints transmitted light and absorbs inside (Montelux alone)";
  static Fields<TintedDielectricDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const TintedDielectricDesc&) const = default;
};

// A Dielectric whose transmission is multiplied by `tint` (KHR_materials_transmission).
template <class F>
class TintedDielectric {
 public:
  static constexpr std::string_view name = "tinteddielectric";
  static constexpr bool has_reflection = true, has_transmission = true;
  static constexpr int slot_count = TintedDielectricSlots::end;
  using Stated = TintedDielectricDesc;
  static constexpr std::array<FacetSlots, 1> facet_slots = Dielectric<F>::facet_slots;

  MONTELUX_INLINE explicit TintedDielectric(const BsdfRows<F>& rows)
      : glass_(rows), tint_(rows.spectrum(TintedDielectricSlots::tint)) {}

  MONTELUX_INLINE Mask<F> is_delta() const { return glass_.is_delta(); }
  MONTELUX_INLINE F eta() const { return glass_.eta(); }
  SpecularLobe<F> specular_lobe(F cos_o, bool reflects) const {
    SpecularLobe<F> lobe = glass_.specular_lobe(cos_o, reflects);
    if (!reflects) lobe.weight = lobe.weight * tint_;
    return lobe;
  }

  Roughness<F> specular_facets() const { return glass_.specular_facets(); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const {
    const BsdfValue<F> value = glass_.evaluate(wo, wi, context);
    return {value.f_cos * color(wo, wi), value.density};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
    BsdfSample<F> s = glass_.sample(wo, u, u2, context);
    s.weight = s.weight * color(wo, s.wi);
    return s;
  }

 private:
  MONTELUX_INLINE Spectrum<F> color(Vec3<F> wo, Vec3<F> wi) const {
    return select(same_side(wo, wi), gray(F(1.0f)), tint_);
  }

  Dielectric<F> glass_;
  Spectrum<F> tint_;
};

}  // namespace montelux
