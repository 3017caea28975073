// Lambert's law under a clear coat: plastic, varnished wood.
#pragma once
#include "material/coat_integrals.h"
#include "material/diffuse.h"
#include "material/layered.h"

namespace montelux {

struct CoatedDiffuseSlots : LayeredSlots {
  static constexpr int reflectance = base + DiffuseSlots::reflectance;
  // What is known of the coat: the result of internal_reflectance(); 0: unknown, or there are scatterers under the
  // coat.
  static constexpr int internal = base + DiffuseSlots::end;
  // That of coat_transmittance, where the internal reflectance is known.
  static constexpr int series = internal + 1, end = series + coat_transmittance::terms;
  static_assert(
      fill_bsdf_row(end, {{0, base}, {base, DiffuseSlots::end}, {internal, 1}, {series, coat_transmittance::terms}}));
};

// Lambert's law does not depend on where light came from.
template <class F>
struct CosineLobe {
  static constexpr float walks = 0;

  explicit CosineLobe(const BsdfRows<F>&) {}
  MONTELUX_INLINE Vec3<F> sample(Vec3<F>, F, Vec2<F> u2) const { return sample_cosine_hemisphere(u2); }
  MONTELUX_INLINE F density(Vec3<F>, Vec3<F> wi) const { return cosine_density(wi); }
};

// A diffuse base under a dielectric coat.
struct CoatedDiffuseDesc {
  SpectrumInput albedo = gray_value(0.5f);  // of the base
  IndexInput eta = 1.5f;                    // of the coat
  FacetsDesc facets{};                      // of the coat
  bool maps_roughness = true;
  LayerDesc layer{};

  static constexpr std::string_view meaning = "a diffuse base under a rough dielectric coat";
  static Fields<CoatedDiffuseDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const CoatedDiffuseDesc&) const = default;
};

// If the coat's internal reflectance is known, the walks of Layered are summed in closed form: Lambert's law does not
// depend on where light came from, so after n reflections at the base, between which the coat returns the fraction K,
// r (r K)^(n - 1) of the entering light remains, distributed by the cosine. The transmittances of the way in and the
// way out are known, too, if the coat's facets are the same in all directions and not very rough; else one facet is
// sampled for each, an unbiased estimate. Directions come from the coat's facets or from a cosine lobe, so that the
// density is exact. Otherwise values are random walks.
template <class F>
class CoatedDiffuse : public Layered<F, Diffuse<F>, CosineLobe<F>> {
 public:
  static constexpr std::string_view name = "coateddiffuse";
  static constexpr int slot_count = CoatedDiffuseSlots::end;
  using Stated = CoatedDiffuseDesc;
  static constexpr std::array<FacetSlots, 1> facet_slots{{{LayeredSlots::alpha_x, LayeredSlots::alpha_y}}};

  explicit CoatedDiffuse(const BsdfRows<F>& rows)
      : Layered<F, Diffuse<F>, CosineLobe<F>>(rows),
        reflectance_(rows.spectrum(CoatedDiffuseSlots::reflectance)),
        internal_(rows.number(CoatedDiffuseSlots::internal)),
        reflections_(reflections()),
        alpha_(rows.number(CoatedDiffuseSlots::alpha_x)) {
    for (int k = 0; k < coat_transmittance::terms; ++k)
      series_[std::size_t(k)] = rows.number(CoatedDiffuseSlots::series + k);
  }

  BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const;
  BsdfSample<F> sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const;
  // Where the walks are summed, without a choice between coat and base; elsewhere of one walk.
  Spectrum<F> albedo(Vec3<F> wo, const BsdfSample<F>& drawn, Vec2<F> u2, const BsdfContext<F>& context) const;

 private:
  using Walk = Layered<F, Diffuse<F>, CosineLobe<F>>;
  using Walk::coat_, Walk::medium_, Walk::max_depth_;

  // Both directions above the surface.
  BsdfValue<F> value(Vec3<F> o, Vec3<F> i, const BsdfContext<F>& context, LayerPurpose purpose) const;
  BsdfValue<F> summed_value(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const;
  BsdfSample<F> summed_sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const;
  // The part of light from w that reaches the base, or vice versa. `purpose` and `pair`: the random numbers of a facet.
  F passes(Vec3<F> w, TransportMode mode, const BsdfContext<F>& context, LayerPurpose purpose,
           std::uint32_t pair) const;
  // The same through one facet, which u samples.
  F passes_facet(Vec3<F> w, TransportMode mode, Vec2<F> u) const;
  // Summed over all numbers of reflections at the base: sum of r^n K^(n - 1), without entry and exit.
  Spectrum<F> reflections() const;
  // The probability with which sample() uses a facet of the coat. In proportion to the light that coat and base
  // reflect, but no less than a share: a light source of few pixels in the mirror is found by these samples alone,
  // while light samples find nearly all that the base reflects.
  F coat_share(Vec3<F> o) const;
  // Measured: a lower share is noisier where lamps are mirrored, a higher one where indirect light is.
  static constexpr float min_coat_share = 0.2f;

  Spectrum<F> reflectance_;
  F internal_;
  Spectrum<F> reflections_;
  F alpha_;  // of the coat
  std::array<F, coat_transmittance::terms> series_;
};

template <class F>
BsdfValue<F> CoatedDiffuse<F>::evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const {
  const Mask<F> summed = internal_ > F(0.0f), walks = context.on & !summed;
  if (!any(walks)) return summed_value(wo, wi, context);
  const BsdfValue<F> walked = Walk::evaluate(wo, wi, context.in(walks));
  if (!any(context.on & summed)) return walked;
  const BsdfValue<F> s = summed_value(wo, wi, context);
  return {select(walks, walked.f_cos, s.f_cos), select(walks, walked.density, s.density)};
}

template <class F>
BsdfSample<F> CoatedDiffuse<F>::sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
  const Mask<F> summed = internal_ > F(0.0f), walks = context.on & !summed;
  if (!any(walks)) return summed_sample(wo, u, u2, context);
  const BsdfSample<F> walked = Walk::sample(wo, u, u2, context.in(walks));
  if (!any(context.on & summed)) return walked;
  const BsdfSample<F> s = summed_sample(wo, u, u2, context);
  const Mask<F> valid = (walked.valid & walks) | (s.valid & summed);
  const Mask<F> delta = (walked.delta & walks) | (s.delta & summed);
  return {select(walks, walked.wi, s.wi),
          select(walks, walked.weight, s.weight),
          select(walks, walked.density, s.density),
          F(1.0f),
          valid,
          delta};
}

template <class F>
MONTELUX_INLINE F CoatedDiffuse<F>::passes(Vec3<F> w, TransportMode mode, const BsdfContext<F>& context,
                                           LayerPurpose purpose, std::uint32_t pair) const {
  const Mask<F> known = series_[0] < F(coat_transmittance::none);
  const F scale = mode == TransportMode::radiance ? F(1.0f) / (coat_.eta() * coat_.eta()) : F(1.0f);
  const F part = coat_transmittance::at(max(w.z, F(0.0f)), alpha_, coat_.eta(), medium_.thickness, series_) * scale;
  if (!any(context.on & !known)) return part;
  return select(known, part,
                passes_facet(w, mode, WalkDraws<F>{context.random.fork(Uint<F>(std::uint32_t(purpose)))}.pair(pair)));
}

template <class F>
F CoatedDiffuse<F>::passes_facet(Vec3<F> w, TransportMode mode, Vec2<F> u) const {
  const auto s = coat_.template sample_lobes<Lobes::transmission>(w, F(0.0f), u, mode);
  return select(s.valid, s.weight * medium_.transmittance(medium_.thickness, s.wi), F(0.0f));
}

template <class F>
Spectrum<F> CoatedDiffuse<F>::reflections() const {
  // Every other of max_depth events is at the base, starting with the first.
  const F count = floor((max_depth_ + F(1.0f)) * 0.5f);
  return per_component(
      [&](F r) {
        const F ratio = r * internal_;
        return r * (F(1.0f) - whole_power(ratio, count)) / max(F(1.0f) - ratio, F(1e-6f));
      },
      reflectance_);
}

template <class F>
F CoatedDiffuse<F>::coat_share(Vec3<F> o) const {
  const F reflected = fresnel_dielectric(o.z, coat_.eta());
  const F base = (F(1.0f) - reflected) * (F(1.0f) - internal_) * max_component(reflections_);
  return max(reflected / max(reflected + base, F(1e-30f)), F(min_coat_share));
}

template <class F>
BsdfValue<F> CoatedDiffuse<F>::value(Vec3<F> o, Vec3<F> i, const BsdfContext<F>& context, LayerPurpose purpose) const {
  const auto coat = coat_.template evaluate_lobes<Lobes::reflection>(o, i, context.mode);
  const F in = passes(o, context.mode, context, purpose, 0),
          out = passes(i, adjoint(context.mode), context, purpose, 2);
  const F cosine = cosine_density(i), share = coat_share(o);
  return {gray(coat.f_cos) + reflections_ * (in * out * cosine), {lerp(share, cosine, coat.density)}};
}

template <class F>
BsdfValue<F> CoatedDiffuse<F>::summed_value(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const {
  const F side = copysign(F(1.0f), wo.z);
  const Mask<F> same = same_side(wo, wi), on = context.on & same;
  const BsdfValue<F> v = value(wo * side, wi * side, context, evaluation_walk);
  return {select(on, v.f_cos, gray(F(0.0f))), {select(on, v.density.value, F(0.0f))}};
}

template <class F>
BsdfSample<F> CoatedDiffuse<F>::summed_sample(Vec3<F> wo, F u, Vec2<F> u2, const BsdfContext<F>& context) const {
  const F side = copysign(F(1.0f), wo.z);
  const Vec3<F> o = wo * side;
  const F share = coat_share(o);
  const Mask<F> by_coat = u < share, delta = by_coat & coat_.is_delta();
  const auto facet = coat_.template sample_lobes<Lobes::reflection>(o, F(0.0f), u2, context.mode);
  const Vec3<F> i = select(by_coat, facet.wi, sample_cosine_hemisphere(u2));
  const BsdfValue<F> v = value(o, i, context, sampling_walk);
  const Mask<F> valid = context.on & (i.z > F(0.0f)) & (delta | (v.density.value > F(0.0f))) & (facet.valid | !by_coat);
  const Spectrum<F> weight =
      select(delta, gray(facet.weight / max(share, F(1e-30f))), v.f_cos * (F(1.0f) / max(v.density.value, F(1e-30f))));
  return {i * side, weight, v.density, F(1.0f), valid, delta};
}

template <class F>
Spectrum<F> CoatedDiffuse<F>::albedo(Vec3<F> wo, const BsdfSample<F>& drawn, Vec2<F> u2,
                                     const BsdfContext<F>& context) const {
  const Vec3<F> o = wo * copysign(F(1.0f), wo.z);
  const auto facet = coat_.template sample_lobes<Lobes::reflection>(o, F(0.0f), u2, context.mode);
  const F in = passes(o, context.mode, context, albedo_walk, 0);
  const F out = passes(sample_cosine_hemisphere(u2), adjoint(context.mode), context, albedo_walk, 2);
  const F mirrored = select(facet.valid & (facet.wi.z > F(0.0f)), facet.weight, F(0.0f));
  const Spectrum<F> walked = select(drawn.valid, drawn.weight, gray(F(0.0f)));
  return select(internal_ > F(0.0f), gray(mirrored) + reflections_ * (in * out), walked);
}

}  // namespace montelux
