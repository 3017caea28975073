// A vertex whose direction is drawn by what path guiding has learned, or by the BSDF.
#pragma once
#include "light/direction_field.h"
#include "transport/vertex.h"

namespace montelux {

// The policy of the path loop without guiding, which costs nothing.
struct NoGuide {
  static constexpr bool guides = false;
};

// With it: directions are drawn from the mixture (1 - share) BSDF + share field, and `density` of everything is that
// of the mixture (one-sample multiple importance sampling; Mueller, Gross and Novak 2017, sec. 4).
struct FieldGuide {
  static constexpr bool guides = true;
  const GuideField& field;
};

// The direction (unit, world space) in which a vertex has scattered, the densities that the two had for it, and the
// share of the guide. Without meaning where the direction is that of a delta.
template <class F>
struct GuidedDirection {
  Vec3<F> wi;
  Density<SolidAngle, F> bsdf, guide;
  F share;
};

template <class F>
MONTELUX_INLINE Density<SolidAngle, F> mixture_density(const F& share, const Density<SolidAngle, F>& bsdf,
                                                       const Density<SolidAngle, F>& guide) {
  return {(F(1.0f) - share) * bsdf.value + share * guide.value};
}

// What draws the direction of each lane, decided by one number, whose rest decides further.
template <class F>
struct GuideChoice {
  const GuideField& field;
  FieldSite<F> site;
  Mask<F> guided;
  F rest;  // in [0, 1)

  MONTELUX_INLINE GuideChoice(const GuideField& by, const Vertex<F>& v, Mask<F> on, F u)
      : field(by), site(by.at(v.x.point.p, v.bsdf.light_normal, on)), guided(u < site.share) {
    const F share = site.share;
    rest = min(select(guided, u / max(share, F(1e-30f)), (u - share) / (F(1.0f) - share)), F(one_minus_epsilon));
  }
  // Makes a density of the BSDF that of the mixture, toward the unit wi (world space).
  MONTELUX_INLINE void mix(const Vec3<F>& wi, Density<SolidAngle, F>& density) const {
    density = mixture_density(site.share, density, field.density(site, wi));
  }
};
// Without guiding the number decides nothing here.
template <class F>
struct NoChoice {
  F rest;
};
template <class F>
MONTELUX_INLINE NoChoice<F> guide_choice(const NoGuide&, const Vertex<F>&, Mask<F>, F u) {
  return {u};
}
template <class F>
MONTELUX_INLINE GuideChoice<F> guide_choice(const FieldGuide& guide, const Vertex<F>& v, Mask<F> on, F u) {
  return GuideChoice<F>(guide.field, v, on & !v.in_medium, u);
}

// Replaces the directions that the BSDF has drawn at those of the lanes `on` whose choice is the guide, and gives all
// of them the weight and the density of the mixture. The densities of the BSDF must be exact. `eta_scale` takes out of
// roulette what the guide has changed of the weight: directions to where much light comes from have small weights, and
// their paths would end.
template <class F, bool in_media>
GuidedDirection<F> guide_scattering(const Scene& scene, const Vertex<F>& v, const GuideChoice<F>& choice,
                                    const Vec2<F>& u2, Mask<F> on, BsdfSample<F>& next) {
  const GuideField& field = choice.field;
  const Mask<F> guided = on & choice.guided;
  const F share = choice.site.share, one = 1.0f;
  Vec3<F> wi = v.bsdf.frame.to_world(next.wi);
  Density<SolidAngle, F> by_guide = field.density(choice.site, wi), by_bsdf = next.density;
  // Those that the BSDF has drawn.
  const F ratio = one / ((one - share) + share * by_guide.value / max(by_bsdf.value, F(1e-30f)));
  next.weight = next.weight * select(next.delta, one / (one - share), ratio);
  if (any(guided)) {
    const FieldDirection<F> drawn = field.sample(choice.site, u2);
    const Vec3<F> local = v.bsdf.frame.to_local(drawn.wi);
    const BsdfValue<F> value = evaluate_at<F, in_media>(scene, v, local, guided);
    const F mixture = mixture_density(share, value.density, drawn.density).value;
    next.wi = select(guided, local, next.wi), wi = select(guided, drawn.wi, wi);
    next.weight = select(guided, value.f_cos / max(mixture, F(1e-30f)), next.weight);
    next.valid = (next.valid & !guided) | (guided & (max_component(value.f_cos) > F(0.0f)));
    next.delta = next.delta & !guided, next.eta_scale = select(guided, one, next.eta_scale);
    by_bsdf = select(guided, value.density, by_bsdf);
    by_guide = select(guided, drawn.density, by_guide);
  }
  next.density = mixture_density(share, by_bsdf, by_guide);
  const F change = select(next.delta, one - share, next.density.value / max(by_bsdf.value, F(1e-30f)));
  const F most = one / max(max_component(next.weight), F(1e-6f));
  next.eta_scale = select(on & (share > F(0.0f)), next.eta_scale * min(change, most), next.eta_scale);
  return {wi, by_bsdf, by_guide, share};
}

}  // namespace montelux
