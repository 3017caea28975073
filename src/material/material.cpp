#include "material/material.h"

namespace montelux {
namespace {

template <class F>
BsdfValue<F> no_value() {
  return {gray(F(0.0f)), {F(0.0f)}};
}
template <class F>
BsdfSample<F> no_sample() {
  F zero = F(0.0f);
  return {{zero, zero, F(1.0f)}, gray(zero), {zero}, F(1.0f), Mask<F>(false), Mask<F>(false)};
}

// Copies the lanes of `mask`.
template <class F>
MONTELUX_INLINE void merge(BsdfValue<F>& all, const BsdfValue<F>& part, Mask<F> mask) {
  all.f_cos = select(mask, part.f_cos, all.f_cos);
  all.density = select(mask, part.density, all.density);
}
template <class F>
MONTELUX_INLINE void merge(BsdfSample<F>& all, const BsdfSample<F>& part, Mask<F> mask) {
  all.wi = select(mask, part.wi, all.wi);
  all.weight = select(mask, part.weight, all.weight);
  all.density = select(mask, part.density, all.density);
  all.eta_scale = select(mask, part.eta_scale, all.eta_scale);
  all.valid = (part.valid & mask) | (all.valid & !mask);
  all.delta = (part.delta & mask) | (all.delta & !mask);
}

// One function per model, so that each is compiled separately.
template <class Model, class F>
__attribute__((noinline)) void scatter_model(const BsdfLanes<F>& lanes, const ScatterQuery<F>& query,
                                             BsdfContext<F> context, Scattering<F>& all) {
  Mask<F> mask = context.on;
  Model model(BsdfRows<F>{lanes.slots});
  merge(all.next, model.sample(query.wo, query.u, query.u2, context), mask);
  context.on = mask & query.light_wanted;
  if (any(context.on)) merge(all.toward_light, model.evaluate(query.wo, query.wi_light, context), context.on);
}

}  // namespace

template <class F>
Scattering<F> scatter(const BsdfLanes<F>& lanes, const ScatterQuery<F>& query, const BsdfContext<F>& context) {
  Scattering<F> all{no_value<F>(), no_sample<F>()};
  for_each_present_model<F>(lanes.kind, lanes.on, [&]<class Model>(Mask<F> mask) {
    scatter_model<Model, F>(lanes, query, context.in(mask), all);
  });
  return all;
}

template <class F>
BsdfValue<F> evaluate(const BsdfLanes<F>& lanes, Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) {
  BsdfValue<F> all = no_value<F>();
  for_each_present_model<F>(lanes.kind, lanes.on, [&]<class Model>(Mask<F> mask) {
    merge(all, Model(BsdfRows<F>{lanes.slots}).evaluate(wo, wi, context.in(mask)), mask);
  });
  return all;
}

template <class F>
BsdfSample<F> sample(const BsdfLanes<F>& lanes, Vec3<F> wo, const Vec3<F>& u3, const BsdfContext<F>& context) {
  BsdfSample<F> all = no_sample<F>();
  for_each_present_model<F>(lanes.kind, lanes.on, [&]<class Model>(Mask<F> mask) {
    merge(all, Model(BsdfRows<F>{lanes.slots}).sample(wo, u3.x, Vec2<F>{u3.y, u3.z}, context.in(mask)), mask);
  });
  return all;
}

template <class F>
Spectrum<F> albedo(const BsdfLanes<F>& lanes, Vec3<F> wo, const BsdfSample<F>& drawn, Vec2<F> u2,
                   const BsdfContext<F>& context) {
  Spectrum<F> all = select(lanes.on & drawn.valid, drawn.weight * drawn.eta_scale, gray(F(0.0f)));
  for_each_present_model<F>(lanes.kind, lanes.on, [&]<class Model>(Mask<F> mask) {
    if constexpr (requires(const Model& model) { model.albedo(wo, drawn, u2, context); })
      all = select(mask, Model(BsdfRows<F>{lanes.slots}).albedo(wo, drawn, u2, context.in(mask)), all);
  });
  return all;
}

template <class F>
Mask<F> is_delta(const BsdfLanes<F>& lanes) {
  Mask<F> all = Mask<F>(false);
  for_each_present_model<F>(lanes.kind, lanes.on, [&]<class Model>(Mask<F> mask) {
    Mask<F> delta = Model(BsdfRows<F>{lanes.slots}).is_delta();
    all = all | (mask & delta);
  });
  return all;
}

std::string_view name(BsdfKind kind) {
  std::string_view result;
  for_each_present_model<float>(std::uint32_t(kind), true, [&]<class Model>(bool) { result = Model::name; });
  return result;
}

bool transmits(BsdfKind kind) {
  bool result = false;
  for_each_present_model<float>(std::uint32_t(kind), true,
                                [&]<class Model>(bool) { result = Model::has_transmission; });
  return result;
}

template Scattering<float> scatter(const BsdfLanes<float>&, const ScatterQuery<float>&, const BsdfContext<float>&);
template BsdfValue<float> evaluate(const BsdfLanes<float>&, Vec3f, Vec3f, const BsdfContext<float>&);
template BsdfSample<float> sample(const BsdfLanes<float>&, Vec3f, const Vec3f&, const BsdfContext<float>&);
template Spectrum<float> albedo(const BsdfLanes<float>&, Vec3f, const BsdfSample<float>&, Vec2f,
                                const BsdfContext<float>&);
template Mask<float> is_delta(const BsdfLanes<float>&);
template Scattering<NativeFloats> scatter(const BsdfLanes<NativeFloats>&, const ScatterQuery<NativeFloats>&,
                                          const BsdfContext<NativeFloats>&);
template BsdfValue<NativeFloats> evaluate(const BsdfLanes<NativeFloats>&, Vec3<NativeFloats>, Vec3<NativeFloats>,
                                          const BsdfContext<NativeFloats>&);
template BsdfSample<NativeFloats> sample(const BsdfLanes<NativeFloats>&, Vec3<NativeFloats>, const Vec3<NativeFloats>&,
                                         const BsdfContext<NativeFloats>&);
template Spectrum<NativeFloats> albedo(const BsdfLanes<NativeFloats>&, Vec3<NativeFloats>,
                                       const BsdfSample<NativeFloats>&, Vec2<NativeFloats>,
                                       const BsdfContext<NativeFloats>&);
template Mask<NativeFloats> is_delta(const BsdfLanes<NativeFloats>&);

}  // namespace montelux
