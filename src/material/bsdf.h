// The interface of every scattering model. Local frame: z is the shading normal; wo and wi are unit and point away from
// the surface; wo.z may have either sign. A model is a template over F, constructed from the rows of the points.
#pragma once
#include <array>
#include <concepts>
#include <span>
#include <string_view>

#include "color/spectrum.h"
#include "mc/density.h"
#include "mc/microfacet.h"
#include "mc/random.h"
#include "parameter/slots.h"

namespace montelux {

// The parameters of a BSDF at one point, already looked up; each model defines the meaning of its slots.
inline constexpr int bsdf_row_size = spectrum_size == 3 ? 24 : 28;
template <class F>
struct BsdfSlots {
  F v[bsdf_row_size];
};
struct alignas(32) BsdfRow : BsdfSlots<float> {
  BsdfRow() : BsdfSlots<float>{} {}
};
// Whether parameters, in the order of their slots, take every slot up to `end` once, and a row has that many.
constexpr bool fill_bsdf_row(int end, std::initializer_list<SlotRange> parameters) {
  return fill_slots(0, end, parameters) && end <= bsdf_row_size;
}

// The slots of all lanes. A model that contains another passes it the slots from `first` on.
template <class F>
struct BsdfRows {
  const BsdfSlots<F>* slots;
  int first = 0;
  MONTELUX_INLINE F number(int slot) const { return slots->v[first + slot]; }
  MONTELUX_INLINE Spectrum<F> spectrum(int slot) const {
    Spectrum<F> s;
    for (int i = 0; i < spectrum_size; ++i) s.c[i] = number(slot + i);
    return s;
  }
};

// Radiance flows from the light to the camera: refraction scales it by the squared ratio of the indices. Importance is
// not scaled.
enum class TransportMode { radiance, importance };

// What a model may need besides directions: random numbers of its own (for models with random walks), independent of
// all others. Models read the stream by position and never advance it, so that a lane's numbers do not depend on other
// lanes; a caller that repeats an operation at one vertex forks the stream in between. `on` are the active lanes.
// `densities` states what the density is for.
enum class Densities { for_weights, exact };
template <class F>
struct BsdfContext {
  TransportMode mode = TransportMode::radiance;
  RandomStream<F> random;
  Mask<F> on = Mask<F>(true);
  Densities densities = Densities::for_weights;

  MONTELUX_INLINE BsdfContext in(Mask<F> lanes) const { return {mode, random, lanes, densities}; }
};

// f(wo, wi) |cos wi| and the density with which sample() draws wi; both zero where the model has only deltas there.
// A model whose value is itself an estimate (layers) returns an unbiased one. Its density for weights is a function of
// the two directions that resembles the density of its samples. That suffices for weights that sum to one, as in
// multiple importance sampling, but not for 1 / density, as in resampling: callers that need it request exact
// densities, and get other directions, whose density is known.
template <class F>
struct BsdfValue {
  Spectrum<F> f_cos;
  Density<SolidAngle, F> density;
};

template <class F>
struct BsdfSample {
  Vec3<F> wi;
  Spectrum<F> weight;              // f |cos| / density; for a delta, the weight of the discrete choice
  Density<SolidAngle, F> density;  // of wi, over all ways to sample it; meaningless for a delta
  F eta_scale;    // squared relative index of refraction crossed (radiance mode), else 1: roulette divides by it
  Mask<F> valid;  // false: absorbed
  Mask<F> delta;  // sampled from a delta distribution
};

// The facets of a surface in a row: the slots of their roughness along u and v, whose power is GGX's alpha.
struct FacetSlots {
  int u, v;
  float power = 1;
  bool is_covered = false;  // by a coat: where these facets are smooth, the surface need not be
};
inline constexpr std::array<FacetSlots, 0> no_facets{};

// One event at a perfect mirror or at smooth glass that is given rather than sampled: for paths whose events are chosen
// before their directions are known.
template <class F>
struct SpecularLobe {
  // The factor of the light (TransportMode::radiance): reflectance or transmittance, tint, and the squared ratio of the
  // indices. Black where there is no such event.
  Spectrum<F> weight = gray(F(0.0f));
  F relative_eta = F(1.0f);  // of refraction: index on the side of wi over that on the side of wo; 1: straight on
};

// Besides these two functions, models define:
//   static constexpr std::string_view name;
//   static constexpr bool has_reflection, has_transmission;
//   static constexpr int slot_count: how many slots of the row it reads, starting with the first;
//   static constexpr std::array<FacetSlots, N> facet_slots;
//   using Stated: what a scene states of it, as parts.h describes;
//   explicit Model(const BsdfRows<F>&);
//   Mask<F> is_delta(): where the model consists only of deltas, so that connecting it to a light is useless.
// Some also define:
//   SpecularLobe<F> specular_lobe(F cos_o, bool reflects): where facets are smooth, the model has one delta for each of
//     reflection and transmission, and nothing else, so that connections through specular chains may pass it. `cos_o`
//     is of wo with the shading normal, negative below;
//   Roughness<F> specular_facets(): the roughness where they are not: each GGX facet has the events of specular_lobe(),
//     with the cosine of wo with the facet, and Smith's masking with correlated heights;
//   static bool has_grain(const BsdfRows<float>&): whether u and v differ otherwise than by the slots of facets;
//   Spectrum<F> albedo(Vec3<F> wo, const BsdfSample<F>& drawn, Vec2<F> u2, const BsdfContext<F>&): of a model that
//     mixes lobes an estimate of the directional albedo of less variance than the weight of `drawn`, which sample()
//     drew: one that chooses no lobe.
template <class Model, class F>
concept HasSpecularLobe = requires(const Model& model, F cos_o) {
  { model.specular_lobe(cos_o, true) } -> std::same_as<SpecularLobe<F>>;
};
template <class Model, class F>
concept HasSpecularFacets = HasSpecularLobe<Model, F> && requires(const Model& model) {
  { model.specular_facets() } -> std::same_as<Roughness<F>>;
};
template <class Model>
concept HasGrain = requires(const BsdfRows<float>& rows) {
  { Model::has_grain(rows) } -> std::same_as<bool>;
};
template <class Model, class F>
concept BsdfModel = requires(const Model& model, Vec3<F> w, F u, Vec2<F> u2, const BsdfContext<F>& context) {
  requires std::constructible_from < Model, const BsdfRows<F>
  & > ;
  { Model::name } -> std::convertible_to<std::string_view>;
  { Model::has_reflection } -> std::convertible_to<bool>;
  { Model::has_transmission } -> std::convertible_to<bool>;
  { Model::slot_count } -> std::convertible_to<int>;
  requires Model::slot_count <= bsdf_row_size;
  typename Model::Stated;
  { std::span(Model::facet_slots) } -> std::convertible_to<std::span<const FacetSlots>>;
  { model.is_delta() } -> std::same_as<Mask<F>>;
  { model.evaluate(w, w, context) } -> std::same_as<BsdfValue<F>>;
  { model.sample(w, u, u2, context) } -> std::same_as<BsdfSample<F>>;
};

}  // namespace montelux
