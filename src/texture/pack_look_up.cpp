// Textures over the lanes of a pack: one texture, many points. Textures without a lane form are looked up per lane.
#include "texture/texture_set.h"

namespace montelux {

namespace {

using F = NativeFloats;
using Points = TexturePoints<F>;

TexturePoint point_of(const Points& points, int k) {
  return {lane(points.uv, k), lane(points.p, k), lane(points.n, k)};
}

Vec2<F> map_points(const Mapping& mapping, const Points& at, Mask<F> on) {
  if (const auto* uv = std::get_if<UvMapping>(&mapping)) return uv->map(at.uv);
  if (const auto* affine = std::get_if<AffineUvMapping>(&mapping)) return affine->map(at.uv);
  if (const auto* plane = std::get_if<PlanarMapping>(&mapping)) return plane->map(at.p);
  Vec2<F> st{F(0.0f), F(0.0f)};
  for_each_lane(on, [&](int k) {
    const TexturePoint point = point_of(at, k);
    set_lane(st, k, apply(mapping, point));
  });
  return st;
}

Mask<F> is_even(F whole) { return whole * 0.5f == floor(whole * 0.5f); }

// The type of V, float or Rgb, for a pack.
template <class V>
struct InPack;
template <>
struct InPack<float> {
  using Type = F;
  static F splat(float x) { return F(x); }
};
template <>
struct InPack<Rgb> {
  using Type = RgbOf<F>;
  static RgbOf<F> splat(const Rgb& x) { return montelux::splat<F>(x); }
};

F value(const TextureSet& set, NumberTextureId id, const Points& at, Mask<F> on) { return set.number(id, at, on); }
RgbOf<F> value(const TextureSet& set, SpectrumTextureId id, const Points& at, Mask<F> on) {
  return set.color(id, at, on);
}

template <class V>
struct PackLookUp {
  using Pack = typename InPack<V>::Type;
  const TextureSet& set;
  TextureId<V> id;
  const Points& at;
  Mask<F> on;

  Pack operator()(const ConstantTexture<V>& t) const { return InPack<V>::splat(t.value); }
  Pack operator()(const ScaleTexture<V>& t) const {
    return value(set, t.texture, at, on) * set.number(t.factor, at, on);
  }
  Pack operator()(const MixTexture<V>& t) const { return blend(t.first, t.second, set.number(t.amount, at, on)); }
  Pack operator()(const DirectionMixTexture<V>& t) const {
    return blend(t.across, t.along, abs_dot(at.n, splat<F>(t.direction)));
  }
  Pack operator()(const CheckerboardTexture<V>& t) const {
    F cell;
    if (t.flat) {
      const Vec2<F> st = map_points(*t.flat, at, on);
      cell = floor(st.x) + floor(st.y);
    } else {
      const Vec3<F> p = t.world_to_texture.point(at.p);
      cell = floor(p.x) + floor(p.y) + floor(p.z);
    }
    const Mask<F> even = is_even(cell);
    const Mask<F> in_even = on & even, in_odd = on & !even;
    if (!any(in_odd)) return value(set, t.even, at, in_even);
    const Pack odd = value(set, t.odd, at, in_odd);
    return any(in_even) ? select(in_even, value(set, t.even, at, in_even), odd) : odd;
  }
  Pack operator()(const ThresholdTexture& t) const {
    return select(set.number(t.texture, at, on) >= F(t.edge), F(1.0f), F(0.0f));
  }
  Pack operator()(const BilerpTexture<V>& t) const {
    const Vec2<F> st = map_points(t.mapping, at, on);
    const F sx = 1.0f - st.x, sy = 1.0f - st.y;
    const auto v = [](const V& x) { return InPack<V>::splat(x); };
    return (v(t.v00) * sx + v(t.v10) * st.x) * sy + (v(t.v01) * sx + v(t.v11) * st.x) * st.y;
  }
  Pack operator()(const ImageTexture& t) const {
    if constexpr (std::is_same_v<V, Rgb>) {
      if (!t.nearest) {
        Vec2<F> st = map_points(t.mapping, at, on);
        st.y = 1.0f - st.y;
        st = t.folded(st);
        const RgbOf<F> x = t.image->bilinear(st, t.wrap, on) * F(t.scale);
        const RgbOf<F> y = per_component([&](F c) { return max(t.invert ? 1.0f - c : c, 0.0f); }, x);
        return t.tint ? y * splat<F>(*t.tint) : y;
      }
    }
    return point_by_point();
  }
  template <class Other>
  Pack operator()(const Other&) const {
    return point_by_point();
  }

 private:
  Pack blend(TextureId<V> a, TextureId<V> b, F t) const {
    return value(set, a, at, on) * F(1.0f - t) + value(set, b, at, on) * t;
  }
  Pack point_by_point() const {
    Pack r = InPack<V>::splat(V{});
    for_each_lane(on, [&](int k) { set_lane(r, k, set.value(id, point_of(at, k))); });
    return r;
  }
};

}  // namespace

NativeFloats TextureSet::number(NumberTextureId id, const TexturePoints<NativeFloats>& points,
                                Mask<NativeFloats> on) const {
  return std::visit(PackLookUp<float>{*this, id, points, on}, numbers_[std::size_t(id)]);
}
RgbOf<NativeFloats> TextureSet::color(SpectrumTextureId id, const TexturePoints<NativeFloats>& points,
                                      Mask<NativeFloats> on) const {
  return std::visit(PackLookUp<Rgb>{*this, id, points, on}, spectra_[std::size_t(id)]);
}

}  // namespace montelux
