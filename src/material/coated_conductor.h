// Metal under a clear coat: car paint, tinted foil.
#pragma once
#include "material/conductor.h"
#include "material/layered.h"

namespace montelux {

struct CoatedConductorSlots : LayeredSlots {
  static constexpr int conductor_alpha_x = base + ConductorSlots::alpha_x,
                       conductor_alpha_y = base + ConductorSlots::alpha_y, conductor_eta = base + ConductorSlots::eta,
                       conductor_k = base + ConductorSlots::k, end = base + ConductorSlots::end;
  static_assert(fill_bsdf_row(end, {{0, base}, {base, ConductorSlots::end}}));
};

// One reflection by the metal, seen through a plane coat, plus a constant cosine lobe. The facets are widened by the
// deflection of a rough coat: a facet of slope a deflects by (1 - 1/eta) a on the way in and on the way out, a facet of
// the metal by twice its slope.
template <class F>
class MetalUnderCoat {
 public:
  static constexpr float walks = 4;

  explicit MetalUnderCoat(const BsdfRows<F>& rows)
      : eta_(rows.number(CoatedConductorSlots::eta)),
        facets_(widened(rows, CoatedConductorSlots::conductor_alpha_x, CoatedConductorSlots::alpha_x),
                widened(rows, CoatedConductorSlots::conductor_alpha_y, CoatedConductorSlots::alpha_y)) {}

  Vec3<F> sample(Vec3<F> wo, F u, Vec2<F> u2) const {
    const Direction in = inside(wo);
    const Direction out = outside(reflect(in.w, facets_.sample(in.w, u2)));
    const Vec3<F> none{F(0.0f), F(0.0f), F(-1.0f)};
    return select(u < F(floor_share), sample_cosine_hemisphere(u2), select(in.exists & out.exists, out.w, none));
  }
  F density(Vec3<F> wo, Vec3<F> wi) const {
    const Direction o = inside(wo), i = inside(wi);
    const Vec3<F> m = normalize(o.w + i.w);
    const F reflected = facets_.seen(o.w, m) * 0.25f / max(abs_dot(o.w, m), F(1e-10f));
    // Snell's law compresses solid angles: d w inside / d w outside.
    const F squeeze = wi.z / max(square(eta_) * i.w.z, F(1e-10f));
    const F metal = select(o.exists & i.exists, reflected * squeeze, F(0.0f));
    return lerp(F(floor_share), metal, cosine_density(wi));
  }

 private:
  static constexpr float floor_share = 0.25f;

  struct Direction {
    Vec3<F> w;
    Mask<F> exists;
  };
  // The direction above the metal that refraction at a plane maps to the direction above the coat, and vice versa.
  Direction inside(Vec3<F> w) const { return refracted(w, F(1.0f) / eta_); }
  Direction outside(Vec3<F> w) const {
    const Direction d = refracted(w, eta_);
    return {d.w, Mask<F>(d.exists & (w.z > F(0.0f)))};
  }
  static Direction refracted(Vec3<F> w, F ratio) {
    const F x = w.x * ratio, y = w.y * ratio, z2 = F(1.0f) - x * x - y * y;
    return {{x, y, sqrt(max(z2, F(1e-12f)))}, z2 > F(1e-12f)};
  }
  static F widened(const BsdfRows<F>& rows, int metal, int coat) {
    const F bent = (F(1.0f) - F(1.0f) / rows.number(CoatedConductorSlots::eta)) * rows.number(coat);
    return max(sqrt(square(rows.number(metal)) + 0.5f * square(bent)), F(0.02f));
  }

  F eta_;
  GgxFacets<F> facets_;
};

// A metal under a dielectric coat.
struct CoatedConductorDesc {
  MetalDesc metal{};
  FacetsDesc metal_facets{};
  IndexInput coat_eta = 1.5f;
  FacetsDesc coat_facets{};
  bool maps_roughness = true;  // of both
  LayerDesc layer{};

  static constexpr std::string_view meaning = "a metal under a rough dielectric coat";
  static Fields<CoatedConductorDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const CoatedConductorDesc&) const = default;
};

template <class F>
class CoatedConductor : public Layered<F, Conductor<F>, MetalUnderCoat<F>> {
 public:
  static constexpr std::string_view name = "coatedconductor";
  static constexpr int slot_count = CoatedConductorSlots::end;
  using Stated = CoatedConductorDesc;
  static constexpr std::array<FacetSlots, 2> facet_slots{
      {{LayeredSlots::alpha_x, LayeredSlots::alpha_y},
       {CoatedConductorSlots::conductor_alpha_x, CoatedConductorSlots::conductor_alpha_y, 1, true}}};
  using Layered<F, Conductor<F>, MetalUnderCoat<F>>::Layered;
};

}  // namespace montelux
