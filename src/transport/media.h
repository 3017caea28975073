// The media along a path: bodies of glass that absorb (KHR_materials_volume of glTF), and participating media whose
// boundaries state what is on either side.
#pragma once
#include "geometry/ray.h"
#include "material/material.h"
#include "medium/medium.h"
#include "scene/materials.h"
#include "scene/surface.h"

namespace montelux {

// Extinction per unit of length at the path, and of the body around the body that the path is in; black where nothing
// absorbs or scatters. With three nested bodies the outermost is forgotten; equal absorption means the same body.
template <class F>
struct Media {
  Spectrum<F> here, around;
  Uint<F> medium;  // number in the scene's MediumSet; 0: empty space, or a body of glass whose material absorbs

  // Transmittance along a segment of this length (Beer and Lambert's law).
  MONTELUX_INLINE Spectrum<F> left(F distance) const {
    if (!any(max_component(here) > F(0.0f))) return gray(F(1.0f));
    const F way = min(distance, F(ray_infinity));
    return per_component([way](F a) { return select(a > F(0.0f), attenuation(a * way), F(1.0f)); }, here);
  }
};

template <class F>
MONTELUX_INLINE Media<F> select_media(Mask<F> m, const Media<F>& a, const Media<F>& b) {
  return {select(m, a.here, b.here), select(m, a.around, b.around), select(m, a.medium, b.medium)};
}

// Empty space in all lanes.
template <class F>
MONTELUX_INLINE Media<F> no_media() {
  return {gray(F(0.0f)), gray(F(0.0f)), Uint<F>(empty_space)};
}
// A participating medium.
template <class F>
MONTELUX_INLINE Media<F> media_of(const MediumSet& media, Uint<F> medium) {
  return {media.extinction<F>(medium), gray(F(0.0f)), medium};
}

// The numbers of the media on the sides of a surface, in one word; 0 where it bounds none.
template <class F>
MONTELUX_INLINE Uint<F> packed_sides(const SurfaceHit<F>& x) {
  return select(x.bounds_media, (x.inside << 16) | x.outside, Uint<F>(0u));
}

// A surface as a boundary of media. Its geometric normal decides which side a direction lies on.
template <class F>
class Boundary {
 public:
  // Also of participating media, where the surface bounds any.
  MONTELUX_INLINE Boundary(const MediumSet& media, const SurfaceHit<F>& x, const SurfaceScattering<F>& bsdf)
      : Boundary(bsdf.kind, bsdf.slots, x.point.ng, bsdf.frame) {
    if (media.empty() || !any(x.bounds_media)) return;
    media_ = &media, sides_ = x.bounds_media, inside_ = x.inside, outside_ = x.outside;
    outward_ = face_forward(x.point.ng, bsdf.frame.n);
  }
  // The same of a surface that was stored; `sides` are as packed_sides() gives them.
  MONTELUX_INLINE Boundary(const MediumSet& media, Uint<F> sides, Uint<F> kind, const BsdfSlots<F>& slots,
                           const Vec3<F>& ng, const LocalFrame<F>& frame)
      : Boundary(kind, slots, ng, frame) {
    sides_ = sides != Uint<F>(0u);
    if (!any(sides_)) return;
    media_ = &media, inside_ = sides >> 16, outside_ = sides & Uint<F>(0xffffu);
    outward_ = face_forward(ng, frame.n);
  }
  // Of bodies of glass alone.
  MONTELUX_INLINE Boundary(Uint<F> kind, const BsdfSlots<F>& slots, const Vec3<F>& ng, const LocalFrame<F>& frame)
      : bounds_(bounds_body<F>(kind)), is_any_(any(bounds_)) {
    if (!is_any_) return;
    outward_ = face_forward(ng, frame.n);
    within_ = absorption_within<F>(kind, slots);
  }

  // The media around a path that arrives along d. A path that arrives from within a body was in it, even where no
  // boundary was crossed: the camera may be in water.
  MONTELUX_INLINE Media<F> before(const Media<F>& media, const Vec3<F>& d) const {
    if (!is_any_) return media;
    const Mask<F> unseen = bounds_ & (dot(outward_, d) > F(0.0f)) & !is_black(within_) & !equal(within_, media.here) &
                           !equal(within_, media.around);
    if (!any(unseen)) return media;
    return select_media<F>(unseen, {within_, media.here, media.medium}, media);
  }
  // The media around a path that continues along wi.
  MONTELUX_INLINE Media<F> behind(const Media<F>& media, const Vec3<F>& d, const Vec3<F>& wi) const {
    const Media<F> beyond = behind_glass(media, d, wi);
    if (!media_) return beyond;
    return select_media<F>(sides_, media_of<F>(*media_, select(dot(outward_, wi) < F(0.0f), inside_, outside_)),
                           beyond);
  }

 private:
  MONTELUX_INLINE Media<F> behind_glass(const Media<F>& media, const Vec3<F>& d, const Vec3<F>& wi) const {
    if (!is_any_) return media;
    const Mask<F> comes_in = bounds_ & (dot(outward_, d) <= F(0.0f)), goes_in = dot(outward_, wi) < F(0.0f);
    const Mask<F> enters = comes_in & goes_in, leaves = bounds_ & !comes_in & !goes_in;
    const Mask<F> absorbs = !is_black(within_ + media.here + media.around);
    // A participating medium ends where a surface says so, and not at any glass.
    const Mask<F> matters = absorbs & (enters | leaves) & (media.medium == Uint<F>(empty_space));
    if (!any(matters)) return media;
    const Spectrum<F> nothing = gray(F(0.0f));
    // Bodies may overlap: it is not always the innermost that a path leaves.
    const Mask<F> innermost = equal(within_, media.here), other = equal(within_, media.around) & !innermost;
    const Media<F> left = select_media<F>(innermost, {media.around, nothing, media.medium},
                                          select_media<F>(other, {media.here, nothing, media.medium}, media));
    return select_media<F>(matters & enters, {within_, media.here, media.medium},
                           select_media<F>(matters & leaves, left, media));
  }

  static MONTELUX_INLINE Mask<F> equal(const Spectrum<F>& a, const Spectrum<F>& b) {
    Mask<F> all = a.c[0] == b.c[0];
    for (int i = 1; i < spectrum_size; ++i) all = all & (a.c[i] == b.c[i]);
    return all;
  }

  Mask<F> bounds_;
  bool is_any_;  // most packs meet no boundary, and the rest is not set then
  Vec3<F> outward_;
  Spectrum<F> within_;
  const MediumSet* media_ = nullptr;  // null: no lane bounds a participating medium, and the rest is not set
  Mask<F> sides_;
  Uint<F> inside_, outside_;
};

// The media around a vertex, whose path came along d through `media`.
template <class F>
class MediaAt {
 public:
  // The last arguments are those of the boundary.
  template <class... Args>
  MONTELUX_INLINE MediaAt(const Media<F>& media, const Vec3<F>& d, const Args&... boundary)
      : boundary_(boundary...), media_(boundary_.before(media, d)), d_(d) {}

  const Media<F>& along_wo() const { return media_; }
  MONTELUX_INLINE Media<F> toward(const Vec3<F>& wi) const { return boundary_.behind(media_, d_, wi); }

 private:
  Boundary<F> boundary_;
  Media<F> media_;
  Vec3<F> d_;
};

}  // namespace montelux
