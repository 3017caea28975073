// Bodies of glass that absorb, around a path: Beer and Lambert's law (KHR_materials_volume of glTF), whatever the path
// meets within them.
#pragma once
#include "geometry/ray.h"
#include "material/material.h"

namespace montelux {

// Absorption, a unit of length, where a path is and around the body in which it is; black where nothing absorbs. Of
// bodies in bodies in bodies the outermost is forgotten; what has the same absorption is the same body.
template <class F>
struct Media {
  Spectrum<F> here, around;

  // What is left of light after a way of that length.
  MONTELUX_INLINE Spectrum<F> left(F distance) const {
    if (!any(max_component(here) > F(0.0f))) return gray(F(1.0f));
    const F way = min(distance, F(ray_infinity));
    return per_component([way](F a) { return select(a > F(0.0f), exp(-a * way), F(1.0f)); }, here);
  }
};

template <class F>
MONTELUX_INLINE Media<F> select_media(Mask<F> m, const Media<F>& a, const Media<F>& b) {
  return {select(m, a.here, b.here), select(m, a.around, b.around)};
}

// A surface, as a boundary of bodies. Which side of it a direction lies on, its geometric normal decides.
template <class F>
class Boundary {
 public:
  MONTELUX_INLINE Boundary(Uint<F> kind, const BsdfSlots<F>& slots, const Vec3<F>& ng, const Frame<F>& frame)
      : bounds_(bounds_body<F>(kind)), is_any_(any(bounds_)) {
    if (!is_any_) return;
    outward_ = face_forward(ng, frame.n);
    within_ = absorption_within<F>(kind, slots);
  }

  // The media around a path that arrives along d. A path that arrives from within a body was in it, even where no
  // boundary was crossed: the camera may stand in water.
  MONTELUX_INLINE Media<F> before(const Media<F>& media, const Vec3<F>& d) const {
    if (!is_any_) return media;
    const Mask<F> unseen = bounds_ & (dot(outward_, d) > F(0.0f)) & !is_black(within_) & !equal(within_, media.here) &
                           !equal(within_, media.around);
    if (!any(unseen)) return media;
    return select_media<F>(unseen, {within_, media.here}, media);
  }
  // The media around a path that continues along wi.
  MONTELUX_INLINE Media<F> behind(const Media<F>& media, const Vec3<F>& d, const Vec3<F>& wi) const {
    if (!is_any_) return media;
    const Mask<F> comes_in = bounds_ & (dot(outward_, d) <= F(0.0f)), goes_in = dot(outward_, wi) < F(0.0f);
    const Mask<F> enters = comes_in & goes_in, leaves = bounds_ & !comes_in & !goes_in;
    const Mask<F> absorbs = !is_black(within_ + media.here + media.around);
    const Mask<F> matters = absorbs & (enters | leaves);
    if (!any(matters)) return media;
    const Spectrum<F> nothing = gray(F(0.0f));
    // Bodies may overlap: it is not always the innermost that a path leaves.
    const Mask<F> innermost = equal(within_, media.here), other = equal(within_, media.around) & !innermost;
    const Media<F> left =
        select_media<F>(innermost, {media.around, nothing}, select_media<F>(other, {media.here, nothing}, media));
    return select_media<F>(matters & enters, {within_, media.here}, select_media<F>(matters & leaves, left, media));
  }

 private:
  static MONTELUX_INLINE Mask<F> equal(const Spectrum<F>& a, const Spectrum<F>& b) {
    Mask<F> all = a.c[0] == b.c[0];
    for (int i = 1; i < spectrum_size; ++i) all = all & (a.c[i] == b.c[i]);
    return all;
  }

  Mask<F> bounds_;
  bool is_any_;  // most packs meet no boundary, and the rest is not set then
  Vec3<F> outward_;
  Spectrum<F> within_;
};

// The media around a vertex, whose path came along d through `media`.
template <class F>
class MediaAt {
 public:
  MONTELUX_INLINE MediaAt(const Media<F>& media, const Boundary<F>& boundary, const Vec3<F>& d)
      : boundary_(boundary), media_(boundary.before(media, d)), d_(d) {}

  const Media<F>& along_wo() const { return media_; }
  MONTELUX_INLINE Media<F> toward(const Vec3<F>& wi) const { return boundary_.behind(media_, d_, wi); }

 private:
  Boundary<F> boundary_;
  Media<F> media_;
  Vec3<F> d_;
};

}  // namespace montelux
