// Lambert's law.
#pragma once
#include "material/bsdf.h"
#include "material/lobe.h"
#include "material/parts.h"

namespace montelux {

struct DiffuseSlots {
  static constexpr int reflectance = 0, end = spectrum_size;
  static_assert(fill_bsdf_row(end, {{reflectance, spectrum_size}}));
};

struct DiffuseDesc {
  SpectrumInput albedo = gray_value(0.5f);

  static constexpr std::string_view meaning = "Lambertian reflection";
  static Fields<DiffuseDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const DiffuseDesc&) const = default;
};

// Reflects uniformly into all directions, on both sides: f = reflectance / pi.
template <class F>
class Diffuse {
 public:
  static constexpr std::string_view name = "diffuse";
  static constexpr bool has_reflection = true, has_transmission = false;
  static constexpr int slot_count = DiffuseSlots::end;
  using Stated = DiffuseDesc;
  static constexpr auto facet_slots = no_facets;

  MONTELUX_INLINE explicit Diffuse(const BsdfRows<F>& rows) : reflectance_(rows.spectrum(DiffuseSlots::reflectance)) {}
  MONTELUX_INLINE explicit Diffuse(const Spectrum<F>& reflectance) : reflectance_(reflectance) {}

  MONTELUX_INLINE Mask<F> is_delta() const { return Mask<F>(false); }

  MONTELUX_INLINE BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>&) const {
    F density = select(same_side(wo, wi), cosine_density(wi), F(0.0f));
    return {reflectance_ * density, {density}};
  }
  MONTELUX_INLINE BsdfSample<F> sample(Vec3<F> wo, F, Vec2<F> u2, const BsdfContext<F>&) const {
    Vec3<F> wi = sample_cosine_side(wo, u2);
    return {wi, reflectance_, {cosine_density(wi)}, F(1.0f), wi.z != F(0.0f), Mask<F>(false)};
  }

 private:
  Spectrum<F> reflectance_;
};

}  // namespace montelux
