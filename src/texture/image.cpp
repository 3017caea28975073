#include "texture/image.h"

#include "parameter/fields.h"
#include "texture/maker.h"

namespace montelux {

namespace {

template <std::size_t axis>
void fold(Fields<ImageTextureDesc>& fields, std::string_view name, const char* meaning) {
  using T = ImageTextureDesc;
  fields
      .choice<Fold>(name, [](T& image) -> Fold& { return image.folds[axis]; }, meaning,
                    {{"repeat", Fold::none}, {"clamp", Fold::clamp}, {"mirror", Fold::mirror}})
      .only_if([](const T& image) { return image.folds[axis] != Fold::none || image.wrap == Wrap::repeat; });
}

// Between the centres of the outermost texels nothing beyond the edge is looked up.
template <class F>
MONTELUX_INLINE F folded(F s, Fold fold, int size) {
  if (fold == Fold::none) return s;
  if (fold == Fold::mirror) s = F(1.0f) - abs(s - 2.0f * floor(s * 0.5f) - F(1.0f));
  const float half = 0.5f / float(size);
  return clamp(s, half, 1 - half);
}

}  // namespace

Fields<ImageTextureDesc> ImageTextureDesc::rows() {
  using T = ImageTextureDesc;
  Fields<T> fields;
  fields.words("filename", &T::file, "the image");
  fields.choice<Wrap>("wrap", &T::wrap, "outside the image",
                      {{"repeat", Wrap::repeat},
                       {"black", Wrap::black},
                       {"clamp", Wrap::clamp},
                       {"octahedralsphere", Wrap::octahedral}});
  fold<0>(fields, "uwrap", "along u, where it is not repeat instead of wrap (Montelux alone)");
  fold<1>(fields, "vwrap", "along v, where it is not repeat instead of wrap (Montelux alone)");
  fields.optional_choice<ImageChannel>(
      "channel", &T::channel, "for numbers; default alpha, or the mean if there is none (Montelux alone)",
      {{"r", ImageChannel::r}, {"g", ImageChannel::g}, {"b", ImageChannel::b}, {"a", ImageChannel::a}});
  fields.spectrum("tint", &T::tint, "factor of spectra (Montelux alone)", 0, any_magnitude);
  fields.number("scale", &T::scale, "factor of the values", -any_magnitude, any_magnitude);
  fields.flag("invert", &T::invert, "1 - value");
  fields.choice<TextureFilter>("filter", &T::filter, "interpolation",
                               {{"point", TextureFilter::point},
                                {"bilinear", TextureFilter::bilinear},
                                {"trilinear", TextureFilter::trilinear},
                                {"ewa", TextureFilter::ewa}});
  ParameterSpec anisotropy{"maxanisotropy", {ParameterType::number}, "for ewa; default 8", 0, any_magnitude};
  anisotropy.later = true;
  fields.other(anisotropy);
  fields.text(
      "encoding", "of integers: sRGB, linear or 'gamma x'; default sRGB; images of floats are linear",
      [](const std::string& text, T& image) -> Status {
        // The checks have reported any other text.
        image.encoding = parse_encoding(text);
        return Done{};
      },
      {}, {}, [](const T& image) { return image.encoding ? to_string(*image.encoding) : std::string(); });
  fields.part(&T::mapping, rows_of_mapping());
  return fields;
}

template <class V>
TextureId<V> ImageTexture<V>::make(const Stated& stated, const TextureMaker<V>& maker) {
  const bool prefiltered = stated.filter == TextureFilter::trilinear || stated.filter == TextureFilter::ewa;
  if (prefiltered) {
    const std::string name = stated.filter == TextureFilter::ewa ? "ewa" : "trilinear";
    maker.note_once("texture filter", "the texture filter " + name + " is replaced by bilinear at full resolution",
                    "the samples of a pixel average the texture without the bias of a prefilter");
  }
  if (stated.file.empty()) {
    maker.error("an image texture needs the file of an image");
    return maker.constant(0);
  }
  ImageTexture made;
  made.image = maker.image(stated.file, stated.encoding);
  if (!made.image) return maker.constant(0);
  made.mapping = maker.mapping(stated.mapping);
  made.wrap = stated.wrap, made.nearest = stated.filter == TextureFilter::point;
  made.scale = stated.scale, made.invert = stated.invert;
  if (stated.channel) made.channel = int(*stated.channel);
  if (!(stated.tint == gray_value(1))) made.tint = maker.rgb(stated.tint);
  made.folds = stated.folds;
  return maker.add(std::move(made));
}

// The position on the image, which t increases upwards.
template <class V>
template <class F>
MONTELUX_INLINE Vec2<F> ImageTexture<V>::on_image(Vec2<F> st) const {
  st.y = 1.0f - st.y;
  if (folds[0] == Fold::none && folds[1] == Fold::none) return st;
  return {folded(st.x, folds[0], image->width()), folded(st.y, folds[1], image->height())};
}

template <class V>
float ImageTexture<V>::number_at(Vec2f st) const {
  if (channel)
    return nearest ? image->nearest_channel(st, wrap, *channel) : image->bilinear_channel(st, wrap, *channel);
  return nearest ? image->nearest_number(st, wrap) : image->bilinear_number(st, wrap);
}

template <class V>
V ImageTexture<V>::at(const TextureSet&, const TexturePoint& point) const {
  const Vec2f st = on_image(apply(mapping, point));
  if constexpr (std::is_same_v<V, float>) {
    const float x = scale * number_at(st);
    return invert ? max(1 - x, 0.0f) : x;
  } else {
    Rgb x = (nearest ? image->nearest(st, wrap) : image->bilinear(st, wrap)) * scale;
    x = per_component([&](float c) { return max(invert ? 1 - c : c, 0.0f); }, x);
    return tint ? x * *tint : x;
  }
}
template <class V>
PackOf<V> ImageTexture<V>::at(const TextureSet& set, const TexturePack& points, TextureMask on) const {
  if constexpr (std::is_same_v<V, Rgb>) {
    using F = NativeFloats;
    if (!nearest) {
      const RgbOf<F> x = image->bilinear(on_image(apply(mapping, points, on)), wrap, on) * F(scale);
      const RgbOf<F> y = per_component([&](F c) { return max(invert ? 1.0f - c : c, 0.0f); }, x);
      return tint ? y * splat<F>(*tint) : y;
    }
  }
  return point_by_point<V>(*this, set, points, on);
}

template struct ImageTexture<float>;
template struct ImageTexture<Rgb>;

}  // namespace montelux
