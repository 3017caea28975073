// The operations of the path loop over packs of mixed scattering models: each model that is present among the lanes
// runs once, masked.
#pragma once
#include <utility>

#include "material/models.h"

namespace montelux {

// Calls visitor.template operator()<Model>(mask) for each model that is present among the lanes `on`; `kind` is a
// BsdfKind in each lane.
template <class F, class Visitor>
MONTELUX_INLINE void for_each_present_model(Uint<F> kind, Mask<F> on, Visitor&& visitor) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto visit = [&]<std::size_t i>() {
      Mask<F> mask = on & (kind == Uint<F>(std::uint32_t(i)));
      if (any(mask)) visitor.template operator()<std::tuple_element_t<i, BsdfModels<F>>>(mask);
    };
    (visit.template operator()<I>(), ...);
  }
  (std::make_index_sequence<bsdf_kind_count>());
}

// The materials of the points of all lanes.
template <class F>
struct BsdfLanes {
  Uint<F> kind;               // a BsdfKind in each lane
  const BsdfSlots<F>* slots;  // idle lanes may contain anything
  Mask<F> on;                 // the active lanes; results are zero and invalid in the others
};

// Whether a coat has another normal than the surface under it.
template <class F>
MONTELUX_INLINE Mask<F> has_bent_coat(Uint<F> kind, const BsdfSlots<F>& slots) {
  const Mask<F> coated = kind == Uint<F>(std::uint32_t(kind_of<CoatedMetallicRoughness>));
  if (!any(coated)) return coated;
  using Slots = CoatedMetallicRoughnessSlots;
  return coated & (slots.v[Slots::coat] > F(0.0f)) & (slots.v[Slots::coat_normal + 2] < F(1.0f));
}

// Whether the surface bounds a body of glass, and its absorption per unit of length.
template <class F>
MONTELUX_INLINE Mask<F> bounds_body(Uint<F> kind) {
  return (kind == Uint<F>(std::uint32_t(kind_of<Dielectric>))) |
         (kind == Uint<F>(std::uint32_t(kind_of<TintedDielectric>)));
}
template <class F>
MONTELUX_INLINE Spectrum<F> absorption_within(Uint<F> kind, const BsdfSlots<F>& slots) {
  const Mask<F> absorbs = kind == Uint<F>(std::uint32_t(kind_of<TintedDielectric>));
  const Spectrum<F> nothing = gray(F(0.0f));
  if (!any(absorbs)) return nothing;
  return select(absorbs, BsdfRows<F>{&slots}.spectrum(TintedDielectricSlots::absorption), nothing);
}

// The two queries of one vertex: the value for wi_light, where `light_wanted`, and a sampled direction of the path.
template <class F>
struct ScatterQuery {
  Vec3<F> wo, wi_light;
  Mask<F> light_wanted;
  F u;
  Vec2<F> u2;
};
template <class F>
struct Scattering {
  BsdfValue<F> toward_light;
  BsdfSample<F> next;
};

// All take local directions (see bsdf.h). They never advance context.random: give each vertex a separate stream.
template <class F>
Scattering<F> scatter(const BsdfLanes<F>& lanes, const ScatterQuery<F>& query, const BsdfContext<F>& context);
template <class F>
BsdfValue<F> evaluate(const BsdfLanes<F>& lanes, Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context);
template <class F>
BsdfSample<F> sample(const BsdfLanes<F>& lanes, Vec3<F> wo, const Vec3<F>& u3, const BsdfContext<F>& context);
// The directional albedo: the part of unit light from everywhere that is scattered along wo, or an unbiased estimate of
// little variance, by u2. `drawn` is what sample() drew; the estimate is its weight where the model has no albedo().
// Squared indices of refraction are left out. Black in the other lanes.
template <class F>
Spectrum<F> albedo(const BsdfLanes<F>& lanes, Vec3<F> wo, const BsdfSample<F>& drawn, Vec2<F> u2,
                   const BsdfContext<F>& context);
// Whether the model has an albedo() of its own: elsewhere the estimate is the weight of what was drawn.
template <class F>
MONTELUX_INLINE Mask<F> estimates_albedo(Uint<F> kind) {
  Mask<F> all(false);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto visit = [&]<std::size_t i, class Model>() {
      if constexpr (requires { &Model::albedo; }) all = all | (kind == Uint<F>(std::uint32_t(i)));
    };
    (visit.template operator()<I, std::tuple_element_t<I, BsdfModels<F>>>(), ...);
  }
  (std::make_index_sequence<bsdf_kind_count>());
  return all;
}
// Where a connection to a light is useless: the model consists only of deltas.
template <class F>
Mask<F> is_delta(const BsdfLanes<F>& lanes);

// The name of the model, as scene files have it.
std::string_view name(BsdfKind kind);
// Whether light can pass from one side of the surface to the other.
bool transmits(BsdfKind kind);

extern template Scattering<float> scatter(const BsdfLanes<float>&, const ScatterQuery<float>&,
                                          const BsdfContext<float>&);
extern template BsdfValue<float> evaluate(const BsdfLanes<float>&, Vec3f, Vec3f, const BsdfContext<float>&);
extern template BsdfSample<float> sample(const BsdfLanes<float>&, Vec3f, const Vec3f&, const BsdfContext<float>&);
extern template Spectrum<float> albedo(const BsdfLanes<float>&, Vec3f, const BsdfSample<float>&, Vec2f,
                                       const BsdfContext<float>&);
extern template Mask<float> is_delta(const BsdfLanes<float>&);
extern template Scattering<NativeFloats> scatter(const BsdfLanes<NativeFloats>&, const ScatterQuery<NativeFloats>&,
                                                 const BsdfContext<NativeFloats>&);
extern template BsdfValue<NativeFloats> evaluate(const BsdfLanes<NativeFloats>&, Vec3<NativeFloats>, Vec3<NativeFloats>,
                                                 const BsdfContext<NativeFloats>&);
extern template BsdfSample<NativeFloats> sample(const BsdfLanes<NativeFloats>&, Vec3<NativeFloats>,
                                                const Vec3<NativeFloats>&, const BsdfContext<NativeFloats>&);
extern template Spectrum<NativeFloats> albedo(const BsdfLanes<NativeFloats>&, Vec3<NativeFloats>,
                                              const BsdfSample<NativeFloats>&, Vec2<NativeFloats>,
                                              const BsdfContext<NativeFloats>&);
extern template Mask<NativeFloats> is_delta(const BsdfLanes<NativeFloats>&);

}  // namespace montelux
